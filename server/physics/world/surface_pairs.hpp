// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/description/world.hpp"
#include "server/physics/world/corrections.hpp"

namespace cohort::physics {

/// The contact parameters of two surfaces.
struct SurfacePair {
  /// A contact at least this stiff is rigid: its deflection would be invisible [N/m].
  static constexpr double rigid = 1e9;

  double friction = 0.0;
  double restitution = 0.0;
  double rolling_resistance = 0.0;   ///< [m]
  double spinning_resistance = 0.0;  ///< [m]
  double second_friction = 0.0;      ///< across the direction of friction
  enum class Directed : std::uint8_t { neither, by_first, by_second } directed = Directed::neither;
  double stiffness = rigid;                ///< per contact point [N/m]
  double damping = 0.0;                    ///< per contact point that is not rigid [N s/m]
  double bounce_threshold = least_bounce;  ///< [m/s]
};

/// Combines surfaces: a material pair of the world takes precedence over the general rule.
class SurfacePairs {
 public:
  explicit SurfacePairs(const description::World& world);
  SurfacePair of(const description::Surface& a, const description::Surface& b) const;

 private:
  std::size_t materials_;
  std::vector<std::optional<description::MaterialPair>> pairs_;  // materials_ x materials_
};

/// Returns the surface of tracks: the friction of the drive, and the material of the first wheel that they replace or,
/// without wheels, of their link. The first collision of a link gives its material.
description::Surface surface_of_tracks(const description::Model& model, const description::TrackPair& drive);

}  // namespace cohort::physics
