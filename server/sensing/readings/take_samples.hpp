// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "server/description/samples.hpp"
#include "server/description/world.hpp"

namespace cohort::sensing {

/// An upright cylinder, and its positions around a ring of sensors.
struct SampleGrid {
  double radius = 0.058;       ///< radius of the cylinder [m]; by default an s-bot's
  double height = 0.5;         ///< height of the cylinder [m], whose middle is in the plane of the ring
  std::size_t distances = 21;  ///< evenly from `ring_radius` to `range` beyond it, at least 2
  std::size_t angles = 72;     ///< evenly spaced over the circle, from the ring's x axis counter-clockwise
};

/// Returns the readings of a ring of proximity sensors for a cylinder around the robot, which is alone at the origin.
/// The readings use the ring's technique, without errors; for random rays, they are the mean of 256 ticks. `device`:
/// index in `model` of a proximity ring.
description::Samples take_samples(const description::Model& model, std::size_t device, const SampleGrid& grid);

}  // namespace cohort::sensing
