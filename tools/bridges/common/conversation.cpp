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
  if (!std::exchange(is_connected_, true)) callbacks_.tell("the " + who_ + " has connected from " + link_->peer());
  return true;
}

std::optional<std::vector<std::uint8_t>> Conversation::receive(const Framing& framing, const Patience& patience) {
  const bool waits = patience.silence == Silence::wait;
  std::optional<Clock::time_point> deadline;
  for (;;) {
    if (!connect()) {
      if (!waits) return std::nullopt;
      wait_for(POLLIN, Clock::time_point::max());
      continue;
    }
    if (!waits && patience.at_most && !deadline) deadline = Clock::now() + *patience.at_most;
    if (auto message = take(framing)) return message;
    if (!is_connected_) {
      if (!waits) return std::nullopt;
      continue;
    }
    if (read_more()) continue;
    if (deadline && Clock::now() >= *deadline) return std::nullopt;
    if (is_connected_) wait_for(POLLIN, deadline.value_or(Clock::time_point::max()));
  }
}

// False if there was nothing.
bool Conversation::read_more() {
  std::array<std::uint8_t, 4096> bytes{};
  try {
    const std::size_t count = link_->read(bytes);
    received_.insert(received_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    return count > 0;
  } catch (const LinkLost& lost) {
    std::string part;
    if (!received_.empty()) {
      part = " in the middle of a message, after " + std::to_string(received_.size());
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
      throw std::runtime_error("its message has more than " + std::to_string(largest_message) + " bytes");
  } catch (const std::runtime_error& mistake) {
    hang_up(std::string("is cut off: ") + mistake.what());
    return std::nullopt;
  }
  expected_size_ = size;
  if (size == 0 || size > received_.size()) return std::nullopt;
  const auto end = received_.begin() + static_cast<std::ptrdiff_t>(size);
  std::vector<std::uint8_t> message(received_.begin(), end);
  received_.erase(received_.begin(), end);
  return message;
}

void Conversation::send(std::span<const std::uint8_t> message) {
  while (is_connected_ && !message.empty()) {
    try {
      const std::size_t count = link_->write(message);
      message = message.subspan(count);
      if (count == 0) wait_for(POLLOUT, Clock::time_point::max());
    } catch (const LinkLost& lost) {
      hang_up(lost.what());
    }
  }
}

void Conversation::hang_up(const std::string& why) {
  link_->hang_up();
  is_connected_ = link_->is_connectionless();
  received_.clear();
  expected_size_ = 0;
  callbacks_.tell("the " + who_ + " " + why);
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
