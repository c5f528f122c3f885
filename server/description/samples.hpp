#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace cohort::description {

/// Readings of a real sensor, taken for one object at a grid of places around the robot (thesis, section 2.3.2: indexed
/// by the distance between robot and object, by the angle between the robot's front and the object, and by the single
/// sensor).
struct Samples {
  std::vector<double> distances;   ///< [m], >= 0, ascending
  std::vector<double> angles;      ///< [rad], ascending, over less than a full turn
  std::vector<std::string> units;  ///< of each reading
  std::vector<double> readings;    ///< by distance, then by angle, then by reading
  std::filesystem::path file{};    ///< where they came from, if anywhere

  std::size_t count() const { return units.size(); }  ///< of readings at each place
};

}  // namespace cohort::description
