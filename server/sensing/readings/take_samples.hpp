#pragma once

#include <cstddef>

#include "server/description/samples.hpp"
#include "server/description/world.hpp"

namespace cohort::sensing {

/// An upright cylinder, and where it is put around a ring of sensors.
struct SampleGrid {
  double radius = 0.058;       ///< of the cylinder: by default an s-bot's [m]
  double height = 0.5;         ///< of the cylinder, whose middle is in the plane of the ring [m]
  std::size_t distances = 21;  ///< evenly from `ring_radius` to `range` beyond it, of its nearest point; at least 2
  std::size_t angles = 72;     ///< evenly all round, from the ring's x axis counter-clockwise
};

/// What a ring of proximity sensors reads, with the technique that it has and without errors, of a cylinder around the
/// robot, which stands alone at the origin; of random rays the mean of 256 ticks. `device`: index in `model`, of a
/// proximity ring.
description::Samples take_samples(const description::Model& model, std::size_t device, const SampleGrid& grid);

}  // namespace cohort::sensing
