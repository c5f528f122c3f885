#include <algorithm>

#include "client_sdk/src/client.hpp"
#include "client_sdk/src/this_process.hpp"

namespace cohort {

bool RunWatch::is_over() const {
  const std::lock_guard lock(mutex_);
  return ended_ || (away_since_ && std::chrono::steady_clock::now() - *away_since_ > server_may_be_away);
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
    away_since_ = std::chrono::steady_clock::now();
}

std::vector<std::string> split_selectors(std::string_view list) {
  std::vector<std::string> parts;
  while (!list.empty()) {
    const std::string_view part = list.substr(0, list.find(','));
    if (!part.empty()) parts.emplace_back(part);
    list.remove_prefix(std::min(list.size(), part.size() + 1));
  }
  return parts;
}

}  // namespace cohort
