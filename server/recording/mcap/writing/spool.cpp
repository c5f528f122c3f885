// SPDX-License-Identifier: Apache-2.0
#include "server/recording/mcap/writing/spool.hpp"

#include <algorithm>

#include "server/recording/mcap/format/mcap_error.hpp"

namespace cohort::recording {

void Spool::write(ByteView bytes) {
  std::unique_lock lock(mutex_);
  has_room_.wait(lock, [this] { return bytes_.size() < capacity_ || is_abandoned_; });
  if (is_abandoned_) throw FileError("the client no longer fetches the recording");
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

void Spool::cut_off(std::uint64_t /*size*/) {}

void Spool::finish() {
  const std::lock_guard lock(mutex_);
  is_finished_ = true;
}

std::optional<Spool::Part> Spool::fetch(std::uint64_t offset, std::size_t most) {
  const std::lock_guard lock(mutex_);
  if (offset < start_ || offset - start_ > bytes_.size()) return std::nullopt;
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(offset - start_));
  start_ = offset;
  has_room_.notify_one();
  Part part;
  part.bytes.assign(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(std::min(most, bytes_.size())));
  if (is_finished_) part.size = start_ + bytes_.size();
  return part;
}

std::size_t Spool::size() const {
  const std::lock_guard lock(mutex_);
  return bytes_.size();
}

bool Spool::is_done() const {
  const std::lock_guard lock(mutex_);
  return is_abandoned_ || (is_finished_ && bytes_.empty());
}

void Spool::abandon() {
  const std::lock_guard lock(mutex_);
  is_abandoned_ = true;
  bytes_.clear();
  has_room_.notify_one();
}

}  // namespace cohort::recording
