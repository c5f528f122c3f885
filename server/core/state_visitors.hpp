#pragma once

#include <cmath>
#include <type_traits>
#include <vector>

#include "server/core/hash.hpp"
#include "server/core/pose.hpp"
#include "server/core/snapshot.hpp"

/// What a `visit_state` calls for each number of a state, so that hash, snapshot and restoring see the same ones;
/// `unusual` for what counts only where it is not as usual.
namespace cohort {

/// Adds whatever number a state holds.
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
/// Writes it.
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
/// Reads it back. Throws SnapshotError for a number that such a state cannot have.
struct StateRestorer {
  enum class Numbers {
    finite,
    limits,  ///< maybe infinite
    broken,  ///< of a body that was taken out of the world because they were no numbers
  };
  SnapshotReader& reader;
  Numbers numbers = Numbers::finite;
  template <class Number>
  void operator()(Number& number) const {
    reader.read(number);
    if constexpr (std::is_floating_point_v<Number>) {
      const bool fits = numbers == Numbers::finite ? std::isfinite(number) : !std::isnan(number);
      if (!fits && numbers != Numbers::broken) throw SnapshotError("the snapshot has a number that cannot be");
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

/// Where something may be: throws SnapshotError for what no world holds.
inline void expect_placed(const Pose& pose) {
  constexpr double furthest = 1e7;  // [m]; bodies that move are kept much nearer
  constexpr double roundings = 1e-6;
  const double norm = pose.orientation.norm();
  if (!(pose.position.cwiseAbs().maxCoeff() <= furthest) || !(std::abs(norm - 1.0) <= roundings))
    throw SnapshotError("the snapshot has something at a place that cannot be");
}

/// Throws SnapshotError, too, for what no world holds.
inline void restore_pose(SnapshotReader& reader, Pose& pose) {
  visit_pose(pose, StateRestorer{reader});
  expect_placed(pose);
}

}  // namespace cohort
