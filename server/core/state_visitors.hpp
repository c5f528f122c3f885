// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <type_traits>
#include <vector>

#include "server/core/hash.hpp"
#include "server/core/pose.hpp"
#include "server/core/snapshot.hpp"

/// Visitors that `visit_state` calls for each number of a state, so that hash, save and restore cover the same numbers.
/// `unusual` is for numbers that are hashed only if they differ from their usual value.
namespace cohort {

/// Adds each number of a state to the hash.
struct StateHasher {
  StateHash& hash;
  void operator()(const double& number) const { hash.add(number); }
  void operator()(const bool& flag) const { hash.add(static_cast<std::uint64_t>(flag)); }
  template <class Choice>
  void unusual(const Choice& choice, Choice usual) const {
    if (choice == usual) return;
    if constexpr (std::is_floating_point_v<Choice>)
      hash.add(choice);
    else
      hash.add(static_cast<std::uint64_t>(choice));
  }
};
/// Writes each number.
struct StateSaver {
  SnapshotWriter& writer;
  template <class Number>
  void operator()(const Number& number) const {
    writer.add(number);
  }
  template <class Choice>
  void unusual(const Choice& choice, Choice) const {
    writer.add(choice);
  }
};
/// Reads each number. Throws SnapshotError for a number that `numbers` does not allow.
struct StateRestorer {
  enum class Numbers {
    finite,
    limits,  ///< may be infinite
    broken,  ///< numbers of a body that was quarantined because they were not finite
  };
  SnapshotReader& reader;
  Numbers numbers = Numbers::finite;
  template <class Number>
  void operator()(Number& number) const {
    reader.read(number);
    if constexpr (std::is_floating_point_v<Number>) {
      const bool fits = numbers == Numbers::finite ? std::isfinite(number) : !std::isnan(number);
      if (!fits && numbers != Numbers::broken) throw SnapshotError("snapshot: a number is out of range");
    }
  }
  template <class Choice>
  void unusual(Choice& choice, Choice) const {
    (*this)(choice);
  }
};

template <class PoseType, class Visit>
void visit_pose(PoseType& pose, Visit&& visit) {
  for (int i = 0; i < 3; ++i) visit(pose.position[i]);
  for (int i = 0; i < 4; ++i) visit(pose.orientation.coeffs()[i]);
}

/// Validates the position and orientation of an object; throws SnapshotError.
inline void expect_placed(const Pose& pose) {
  constexpr double furthest = 1e7;  // [m]; moving bodies are kept much nearer
  constexpr double roundings = 1e-6;
  const double norm = pose.orientation.norm();
  if (!(pose.position.cwiseAbs().maxCoeff() <= furthest) || !(std::abs(norm - 1.0) <= roundings))
    throw SnapshotError("snapshot: invalid position or orientation");
}

/// Reads a pose; throws SnapshotError if it is invalid.
inline void restore_pose(SnapshotReader& reader, Pose& pose) {
  visit_pose(pose, StateRestorer{reader});
  expect_placed(pose);
}

}  // namespace cohort
