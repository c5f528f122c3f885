// SPDX-License-Identifier: Apache-2.0
#include "tools/view/history/history_request.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "tools/view/history/reduction.hpp"

namespace cohort::view {
namespace {

constexpr double longest_history = 9e9;  // [s]; beyond, nanoseconds are no 64 bits

std::chrono::nanoseconds time_in_history(double seconds) {
  return std::chrono::round<std::chrono::nanoseconds>(
      std::chrono::duration<double>(std::clamp(seconds, -longest_history, longest_history)));
}

}  // namespace

HistoryRequest history_request_of(const ViewRequest& asked) {
  const auto is_id = [](double number) { return number >= 0.0 && number < 4294967295.0; };
  if (asked.numbers.empty() || asked.numbers.size() > HistoryRequest::most_robots ||
      !std::ranges::all_of(asked.numbers, is_id))
    throw std::invalid_argument("'history' expects 1 to 16 robots in 'numbers', by their ids");
  const auto is_short = [](const std::string& name) { return name.size() <= HistoryRequest::longest_name; };
  if (asked.names.empty() || asked.names.size() > HistoryRequest::most_names ||
      !std::ranges::all_of(asked.names, is_short))
    throw std::invalid_argument("'history' expects 1 to 32 channels in 'names', of at most 256 bytes each");
  const std::size_t series = asked.numbers.size() * asked.names.size();
  if (series > HistoryRequest::most_series)
    throw std::invalid_argument("'history' expects at most 128 series: robots times channels");
  const double from = asked.from.value_or(0.0);
  const double to = asked.to.value_or(longest_history);
  if (!(from <= to)) throw std::invalid_argument("'history' expects a time 'from' that is not after 'to'");
  if (!(asked.number >= static_cast<double>(Reduction::least) || asked.number == 0.0))
    throw std::invalid_argument("'history' expects a 'number' of points of at least 4, or 0 for as many as possible");

  HistoryRequest request{.names = asked.names, .visitor = asked.visitor};
  request.robots.resize(asked.numbers.size());
  std::ranges::transform(asked.numbers, request.robots.begin(),
                         [](double number) { return static_cast<std::uint32_t>(number); });
  request.from = time_in_history(from);
  request.to = time_in_history(to);
  const std::size_t most = HistoryRequest::most_points / series;
  request.points =
      asked.number == 0.0 || asked.number >= static_cast<double>(most) ? most : static_cast<std::size_t>(asked.number);
  return request;
}

std::optional<std::size_t> index_in_channel(std::string_view value, std::string_view channel, std::size_t size) {
  if (size == 1) return value == channel ? std::optional<std::size_t>(0) : std::nullopt;
  if (!value.starts_with(channel)) return std::nullopt;
  value.remove_prefix(channel.size());
  if (value.size() < 3 || value.front() != '[' || value.back() != ']') return std::nullopt;
  value = value.substr(1, value.size() - 2);
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), index);
  if (error != std::errc{} || end != value.data() + value.size() || index >= size) return std::nullopt;
  return index;
}

}  // namespace cohort::view
