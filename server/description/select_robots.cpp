// SPDX-License-Identifier: Apache-2.0
#include "server/description/select_robots.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>

#include "server/core/text.hpp"

namespace cohort::description {
namespace {

std::vector<std::uint32_t> ids(std::uint64_t first, std::uint64_t last) {
  std::vector<std::uint32_t> range(last - first + 1);
  std::iota(range.begin(), range.end(), static_cast<std::uint32_t>(first));
  return range;
}

std::string robots_of(const World& world) {
  const std::size_t count = world.robots.size();
  if (count == 0) return "the world has no robots";
  return "the robots of this world are 0.." + std::to_string(count - 1);
}

// Returns the names with '*' in place of the number at their end, each once, such as `explorers/sbot_*`.
std::vector<std::string> patterns_of(const std::vector<std::string>& names) {
  std::set<std::string> patterns;
  for (const std::string& name : names) {
    const std::size_t last = name.find_last_not_of("0123456789");
    const std::size_t end = last == std::string::npos ? 0 : last + 1;
    patterns.insert(end == name.size() ? name : name.substr(0, end) + "*");
  }
  return {patterns.begin(), patterns.end()};
}

}  // namespace

// Greedy matching that backtracks to the last star is sufficient for patterns with stars only.
bool matches(std::string_view name, std::string_view pattern) {
  std::size_t n = 0;
  std::size_t p = 0;
  std::size_t after_star = std::string_view::npos;
  std::size_t resume = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      after_star = ++p;
      resume = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++p;
      ++n;
    } else if (after_star != std::string_view::npos) {
      p = after_star;
      n = ++resume;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

std::vector<std::uint32_t> select_robots(const World& world, const std::string& selector) {
  const std::string_view text = trimmed(selector);
  const std::string quoted = "'" + std::string(text) + "'";
  const std::size_t count = world.robots.size();
  if (text.empty()) throw std::invalid_argument("expected a robot: a name with '*', an id, a range 0..7, or all");
  if (text == "all") {
    if (count == 0) throw std::invalid_argument("the world has no robots");
    return ids(0, count - 1);
  }

  const std::size_t dots = text.find("..");
  const std::optional<std::uint64_t> first = parse_whole(text.substr(0, dots));
  const std::optional<std::uint64_t> last = dots == std::string_view::npos ? first : parse_whole(text.substr(dots + 2));
  if (first && last) {
    if (*first > *last) throw std::invalid_argument("the range " + quoted + " ends before it starts");
    if (*last >= count) throw std::invalid_argument(quoted + " extends beyond the last robot; " + robots_of(world));
    return ids(*first, *last);
  }

  std::vector<std::uint32_t> found;
  for (std::uint32_t id = 0; id < count; ++id)
    if (matches(world.robot(id).name, text)) found.push_back(id);
  if (!found.empty()) return found;
  std::vector<std::string> names;
  for (std::uint32_t id = 0; id < count; ++id) names.push_back(world.robot(id).name);
  std::string hint = count == 0 ? "; the world has no robots" : suggestion(text, names);
  if (hint.empty()) hint = suggestion(text, patterns_of(names));
  throw std::invalid_argument("there is no robot " + quoted + hint);
}

std::vector<std::uint32_t> select_robots(const World& world, std::span<const std::string> selectors) {
  std::set<std::uint32_t> robots;
  for (const std::string& selector : selectors) {
    const auto selected = select_robots(world, selector);
    robots.insert(selected.begin(), selected.end());
  }
  return {robots.begin(), robots.end()};
}

std::vector<std::size_t> select_objects(const World& world, const std::string& selector) {
  const std::string_view text = trimmed(selector);
  std::vector<std::size_t> found;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < world.instances.size(); ++i) {
    if (matches(world.instances[i].name, text)) found.push_back(i);
    names.push_back(world.instances[i].name);
  }
  if (found.empty())
    throw std::invalid_argument("there is no object '" + std::string(text) + "'" + suggestion(text, names));
  return found;
}

std::vector<std::uint32_t> select_robots_of_any(const World& world, std::span<const std::string> selectors) {
  std::set<std::uint32_t> robots;
  for (const std::string& selector : selectors) {
    try {
      const auto selected = select_robots(world, selector);
      robots.insert(selected.begin(), selected.end());
    } catch (const std::invalid_argument&) {
      continue;
    }
  }
  return {robots.begin(), robots.end()};
}

}  // namespace cohort::description
