// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

/// Words for the values of enums, in the order of the values.
namespace cohort::parsing {

inline constexpr std::string_view fidelities[] = {"articulated", "treel", "planar"};
inline constexpr std::string_view dynamics_kinds[] = {"bullet", "cohort"};
inline constexpr std::string_view solvers[] = {"iterative", "convex", "direct", "hybrid"};
inline constexpr std::string_view headings[] = {"random", "fixed", "towards", "away", "along"};
inline constexpr std::string_view late_policies[] = {"wait", "hold", "zero", "detach", "stop"};
inline constexpr std::string_view quantities[] = {"position", "pose",        "heading",     "velocity",
                                                  "count",    "quarantined", "joint_force", "joint_torque"};

inline constexpr std::string_view ros_syncs[] = {"free", "command", "idle"};
inline constexpr std::string_view ros_silences[] = {"wait", "hold", "stand"};
inline constexpr std::string_view ros_odometries[] = {"encoders", "truth"};

/// Returns the value for a word that is one of `words`.
template <class Enum>
Enum choice_of(std::span<const std::string_view> words, std::string_view word) {
  const auto found = std::ranges::find(words, word);
  if (found == words.end()) throw std::logic_error("no meaning for the choice " + std::string(word));
  return static_cast<Enum>(found - words.begin());
}

template <class Enum>
std::string word_for(std::span<const std::string_view> words, Enum value) {
  return std::string(words[static_cast<std::size_t>(value)]);
}

}  // namespace cohort::parsing
