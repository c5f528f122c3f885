// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/view/source.hpp"

namespace cohort::view {

/// Robots and values whose history a viewer wants.
struct HistoryRequest {
  static constexpr std::size_t most_robots = 16;
  static constexpr std::size_t most_names = 32;
  static constexpr std::size_t most_series = 128;     ///< robots times names
  static constexpr std::size_t longest_name = 256;    ///< [bytes]
  static constexpr std::size_t most_points = 16'000;  ///< in all series: an answer has less than 1 MiB

  std::vector<std::uint32_t> robots{};  ///< ids
  std::vector<std::string> names{};     ///< names of values
  std::chrono::nanoseconds from{0};
  std::chrono::nanoseconds to{0};
  std::size_t points = 0;  ///< limit for each series
  std::uint64_t visitor = 0;
};

/// Converts a request. Throws std::invalid_argument, with a message to the user, if it exceeds a limit.
HistoryRequest history_request_of(const ViewRequest& asked);

/// The place of a value among the values of a robot.
struct ValuePlace {
  bool is_commanded = false;
  std::size_t index = 0;
  std::string unit;
};

/// The name of a commanded value begins with this.
inline constexpr std::string_view commanded_prefix = "→ ";

/// Returns the index of a value within its channel, or nothing if it belongs to another channel. A value has the name
/// of its channel if that has one value, and `CHANNEL[i]` otherwise.
std::optional<std::size_t> index_in_channel(std::string_view value, std::string_view channel, std::size_t size);

/// Returns the place of a value among the values of channels, which have a `name`, a `unit` and a `size`.
template <class Channels>
std::optional<ValuePlace> find_value(const Channels& observation, const Channels& command, std::string_view name) {
  const bool is_commanded = name.starts_with(commanded_prefix);
  if (is_commanded) name.remove_prefix(commanded_prefix.size());
  std::size_t first = 0;
  for (const auto& channel : is_commanded ? command : observation) {
    if (const auto index = index_in_channel(name, channel.name, channel.size))
      return ValuePlace{is_commanded, first + *index, channel.unit};
    first += channel.size;
  }
  return std::nullopt;
}

}  // namespace cohort::view
