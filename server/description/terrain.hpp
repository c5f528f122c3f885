#pragma once

#include <cstdint>
#include <string>

#include "server/description/shape.hpp"

namespace cohort::description {

/// Ground that is described by a few numbers instead of an image. All heights are from 0 to size.z.
struct Terrain {
  std::string kind;                                ///< sine, ramp, steps, hills or rough
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< of the rectangle, and its greatest height [m]
  double spacing = 0.05;                           ///< between neighbouring heights, at the most [m]
  double wavelength = 1.0;                         ///< of waves; length of a step; distance between hills [m]
  std::uint64_t seed = 0;                          ///< of hills and rough ground
};

/// The most heights that a terrain may have along x or y.
inline constexpr double most_terrain_heights = 4097;

/// The same heights on every machine. Throws std::runtime_error if there are more than `most_terrain_heights` along a
/// side.
HeightGrid terrain_heights(const Terrain& terrain);

}  // namespace cohort::description
