// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/run_watch.hpp"

#include "client_sdk/src/this_process.hpp"

namespace cohort {

bool RunWatch::is_over() const {
  const std::lock_guard lock(mutex_);
  return ended_ || (away_since_ && NetworkClock::now() - *away_since_ > server_may_be_away);
}

void RunWatch::note_end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
}

void RunWatch::note_server(bool there) {
  const std::lock_guard lock(mutex_);
  if (there)
    away_since_.reset();
  else if (!away_since_)
    away_since_ = NetworkClock::now();
}

}  // namespace cohort
