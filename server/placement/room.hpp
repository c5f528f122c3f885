// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "server/description/population.hpp"
#include "server/placement/layouts.hpp"
#include "server/placement/occupancy.hpp"

namespace cohort::placement {

/// The space that an instance occupies.
struct Extent {
  double radius = 0.0;   ///< radius of the circle around the origin of the model that contains it at any heading [m]
  double lowest = 0.0;   ///< z of the part that touches the ground [m]
  double highest = 0.0;  ///< z [m]
};
Extent extent_of(const Model& model);

/// The part of a search for positions of one population that does not depend on the seed: everything static.
class StaticRoom {
 public:
  /// `fixed`, which must outlive this object, has the objects with a pose in the file; `moving` is the approximate
  /// number of other objects.
  StaticRoom(const Population& population, const Extent& extent, const Occupancy& fixed, std::size_t moving);

 private:
  friend class Room;
  const Occupancy& fixed_;
  Extent extent_;
  double clearance_;  // minimum distance from the origin of an instance to any obstacle [m]
  double level_;
  Cells cells_;
  ThingsInCells things_;
};

/// A search for positions of one population: the obstacles to an instance, and the ground under it.
class Room {
 public:
  /// `room` and `earlier`, which has the instances of earlier populations, must outlive this object; at most `count`
  /// instances are added.
  Room(const StaticRoom& room, const Occupancy& earlier, std::size_t count);

  /// Returns the height of the ground under an instance at a point; nothing if there is no room for it.
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
  ThingsInCells things_;                   // earlier populations and this one
  std::vector<Occupancy::Thing> circles_;  // this population; their addresses do not change
};

}  // namespace cohort::placement
