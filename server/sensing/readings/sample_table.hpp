// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "server/description/samples.hpp"

namespace cohort::sensing {

/// Sampled readings of a real sensor by the position of an object (thesis, section 2.3.2), interpolated between the
/// sampled positions. With several objects, proximity uses the greatest reading of each sensor, light and sound their
/// sum (sections 3.2.1, 3.2.3 and 3.2.4). All functions are const, and for any thread.
class SampleTable {
 public:
  /// Throws std::invalid_argument if the samples are not a full grid as specified by `Samples`.
  explicit SampleTable(std::shared_ptr<const description::Samples> samples);

  /// Returns the distance beyond which all readings are 0 [m].
  double range() const { return samples_->distances.back(); }
  std::size_t count() const { return samples_->count(); }  ///< readings at each position

  /// Returns reading number `index` of an object at this distance [m] and angle [rad] from the robot's front, by
  /// bilinear interpolation of the four surrounding samples. Angles may have any number of turns. Below the first
  /// distance the reading is that at the first one; beyond the last one it is 0. Both arguments must be finite.
  double reading(double distance, double angle, std::size_t index) const;

  /// Sets each of `count()` values to the greater of itself and the object's reading.
  void keep_greatest(double distance, double angle, std::span<double> values) const;
  /// Adds the object's readings, times `factor`, to `count()` values.
  void add(double distance, double angle, double factor, std::span<double> values) const;

 private:
  /// Surrounding samples, and the weights of the second and of the farther ones.
  struct Cell {
    std::size_t near_row = 0, far_row = 0;
    std::size_t first = 0, second = 0;  // angles
    double far_share = 0.0;
    double second_share = 0.0;
  };
  Cell cell_of(double distance, double angle) const;
  double interpolate(const Cell& cell, std::size_t index) const;
  bool is_beyond(double distance) const { return distance > range(); }

  std::shared_ptr<const description::Samples> samples_;
};

}  // namespace cohort::sensing
