// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/common/conversation.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace cohort::bridges {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds given_up_is_asked_every{100};

}  // namespace

Conversation::Conversation(std::unique_ptr<Link> link, std::string who, Callbacks callbacks)
    : link_(std::move(link)),
      who_(std::move(who)),
      callbacks_(std::move(callbacks)),
      is_connected_(link_->is_connectionless()) {}

bool Conversation::connect() {
  if (!link_->connect()) return false;
  if (!std::exchange(is_connected_, true)) {
    ++connections_;
    tell("has connected from " + link_->peer());
  }
  return true;
}

bool Conversation::wait_for_connection(const Patience& patience) {
  if (is_in_virtual_time()) {
    do {
      program_->settle();
      if (connect()) return true;
    } while (program_->go_on());
    if (program_->runs()) return false;
  }
  while (!connect()) {
    if (patience.silence != Silence::wait) return false;
    wait_for(POLLIN, Clock::time_point::max());
  }
  return true;
}

std::optional<std::vector<std::uint8_t>> Conversation::receive(const Framing& framing, const Patience& patience) {
  const bool waits = patience.silence == Silence::wait;
  std::optional<Clock::time_point> deadline;
  if (callbacks_.given_up()) throw GaveUp{};
  if (is_in_virtual_time()) {
    if (auto message = receive_in_virtual_time(framing)) return message;
    if (program_->runs()) return std::nullopt;
  }
  for (;;) {
    if (connect()) {
      if (!waits && patience.at_most && !deadline) deadline = Clock::now() + *patience.at_most;
      if (auto message = take(framing)) return message;
      if (is_connected_ && read_more() && is_connected_) continue;
    }
    // The next firmware is not heard here: its message would be taken for an answer of the one that has left.
    if (!waits && (!is_connected_ || (deadline && Clock::now() >= *deadline))) return std::nullopt;
    wait_for(POLLIN, deadline.value_or(Clock::time_point::max()));
  }
}

// The link is looked at while the program is at rest only: what is there then does not depend on how fast it computes.
std::optional<std::vector<std::uint8_t>> Conversation::receive_in_virtual_time(const Framing& framing) {
  do {
    program_->settle();
    if (!connect() || !has_sent_all()) continue;
    do {
      if (auto message = take(framing)) return message;
    } while (is_connected_ && read_more());
  } while (program_->go_on());
  return std::nullopt;
}

// False if there was nothing.
bool Conversation::read_more() {
  std::array<std::uint8_t, 4096> bytes{};
  try {
    const std::string peer = link_->is_connectionless() ? link_->peer() : "";
    const std::size_t count = link_->read(bytes);
    if (link_->is_connectionless() && count > 0 && link_->peer() != peer) tell("now sends from " + link_->peer());
    received_.insert(received_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    return count > 0;
  } catch (const LinkLost& lost) {
    std::string part;
    if (!received_.empty()) {
      part = " inside a message, after " + std::to_string(received_.size());
      if (expected_size_ > 0) part += " of " + std::to_string(expected_size_);
      part += " bytes";
    }
    hang_up(lost.what() + part);
    return true;
  }
}

std::optional<std::vector<std::uint8_t>> Conversation::take(const Framing& framing) {
  if (received_.empty()) return std::nullopt;
  std::size_t size = 0;
  try {
    size = framing(received_);
    if (size == 0 && received_.size() >= largest_message)
      throw std::runtime_error("a message has more than " + std::to_string(largest_message) + " bytes");
  } catch (const std::runtime_error& mistake) {
    hang_up(std::string("is disconnected: ") + mistake.what());
    return std::nullopt;
  }
  expected_size_ = size;
  if (size == 0 || size > received_.size()) return std::nullopt;
  const auto end = received_.begin() + static_cast<std::ptrdiff_t>(size);
  std::vector<std::uint8_t> message(received_.begin(), end);
  received_.erase(received_.begin(), end);
  return message;
}

void Conversation::drop_received() {
  while (is_connected_ && read_more()) {
  }
  received_.clear();
  expected_size_ = 0;
}

void Conversation::send(std::span<const std::uint8_t> message) {
  if (is_in_virtual_time()) return send_in_virtual_time(message);
  while (!write(message)) wait_for(POLLOUT, Clock::time_point::max());
}

void Conversation::send_in_virtual_time(std::span<const std::uint8_t> message) {
  if (has_sent_all() && write(message)) return;
  if (unsent_.size() >= most_unsent) return hang_up("is disconnected: it does not read what is sent to it");
  unsent_.emplace_back(message.begin(), message.end());
}

bool Conversation::has_sent_all() {
  while (!unsent_.empty()) {
    std::vector<std::uint8_t> message = std::move(unsent_.front());
    unsent_.pop_front();
    std::span<const std::uint8_t> left = message;
    if (write(left)) continue;
    unsent_.emplace_front(left.begin(), left.end());
    return false;
  }
  return true;
}

// Writes as much as can be taken now. Returns false if something is left, which `message` then is.
bool Conversation::write(std::span<const std::uint8_t>& message) {
  while (is_connected_ && !message.empty()) {
    try {
      const std::size_t count = link_->write(message);
      if (count == 0) return false;
      message = message.subspan(count);
    } catch (const LinkLost& lost) {
      hang_up(lost.what());
    }
  }
  return true;
}

void Conversation::hang_up(const std::string& why) {
  link_->hang_up();
  is_connected_ = link_->is_connectionless();
  received_.clear();
  unsent_.clear();
  expected_size_ = 0;
  tell(why);
}

void Conversation::wait_for(short event, Clock::time_point until) const {
  if (callbacks_.given_up()) throw GaveUp{};
  const auto now = Clock::now();
  const auto left =
      until <= now ? Clock::duration::zero() : std::min<Clock::duration>(until - now, given_up_is_asked_every);
  pollfd waited{link_->descriptor(), event, 0};
  ::poll(&waited, 1, static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(left).count()));
}

}  // namespace cohort::bridges
