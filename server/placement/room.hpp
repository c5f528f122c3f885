#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "server/description/population.hpp"
#include "server/placement/layouts.hpp"
#include "server/placement/occupancy.hpp"

namespace cohort::placement {

/// The room that an instance takes.
struct Extent {
  double radius = 0.0;   ///< of the circle about the model's origin that holds it whatever its heading [m]
  double lowest = 0.0;   ///< z of what stands on the ground [m]
  double highest = 0.0;  ///< z [m]
};
Extent extent_of(const Model& model);

/// The part of a search for places of one population that does not depend on the seed: all that stands still.
class StaticRoom {
 public:
  /// `fixed`, which must outlive this, has what stands where the file says; `moving` is the approximate number of other
  /// things.
  StaticRoom(const Population& population, const Extent& extent, const Occupancy& fixed, std::size_t moving);

 private:
  friend class Room;
  const Occupancy& fixed_;
  Extent extent_;
  double clearance_;  // from the origin of an instance to all that is in its way [m]
  double level_;
  Cells cells_;
  ThingsInCells things_;
};

/// A search for places of one population: the obstacles to an instance, and the ground under it.
class Room {
 public:
  /// `room` and `earlier`, which has what earlier populations have put there, must outlive this; at most `count`
  /// instances are added.
  Room(const StaticRoom& room, const Occupancy& earlier, std::size_t count);

  /// Returns where the ground is under an instance at a point; nothing if it has no room there.
  std::optional<double> find(const Eigen::Vector2d& point) const;
  /// Adds an instance.
  void occupy(const Eigen::Vector2d& point);

 private:
  double highest_under(const Eigen::Vector2d& point, std::size_t cell) const;
  bool is_free(const Eigen::Vector2d& point, std::size_t cell, double ground) const;
  template <class Visit>
  bool for_each_in(std::size_t cell, const Visit& visit) const {
    return room_.things_.for_each_in(cell, visit) && things_.for_each_in(cell, visit);
  }

  const StaticRoom& room_;
  const Occupancy& earlier_;
  ThingsInCells things_;                   // of earlier populations, and of this one
  std::vector<Occupancy::Thing> circles_;  // of this one; they stay where they are
};

}  // namespace cohort::placement
