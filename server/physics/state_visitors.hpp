#pragma once

#include "server/core/hash.hpp"
#include "server/core/pose.hpp"
#include "server/core/snapshot.hpp"

/// What a `visit_state` calls for each number of a state, so that hash, snapshot and restoring see the same ones.
namespace cohort::physics {

/// Adds whatever number a state holds.
struct StateHasher {
  StateHash& hash;
  void operator()(const double& number) const { hash.add(number); }
  void operator()(const bool& flag) const { hash.add(static_cast<std::uint64_t>(flag)); }
};
/// Writes it.
struct StateSaver {
  SnapshotWriter& writer;
  template <class Number>
  void operator()(const Number& number) const {
    writer.add(number);
  }
};
/// Reads it back.
struct StateRestorer {
  SnapshotReader& reader;
  template <class Number>
  void operator()(Number& number) const {
    reader.read(number);
  }
};

template <class PoseType, class Visit>
void visit_pose(PoseType& pose, Visit&& visit) {
  for (int i = 0; i < 3; ++i) visit(pose.position[i]);
  for (int i = 0; i < 4; ++i) visit(pose.orientation.coeffs()[i]);
}

template <class End, class Visit>
void visit_end(End& end, Visit&& visit) {
  visit(end.member);
  visit(end.segment);
  visit_pose(end.X_SP, visit);
}

}  // namespace cohort::physics
