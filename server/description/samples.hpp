// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace cohort::description {

/// Readings of a real sensor, sampled for one object at a grid of positions around the robot. They are indexed by the
/// distance between robot and object, the angle between the front of the robot and the object, and the individual
/// sensor (thesis, section 2.3.2).
struct Samples {
  std::vector<double> distances;   ///< [m], >= 0, ascending
  std::vector<double> angles;      ///< [rad], ascending, over less than a full turn
  std::vector<std::string> units;  ///< for each reading
  std::vector<double> readings;    ///< by distance, then by angle, then by reading
  std::filesystem::path file{};    ///< source file, if any

  std::size_t count() const { return units.size(); }  ///< number of readings at each position
};

}  // namespace cohort::description
