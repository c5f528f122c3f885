#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/description/world.hpp"
#include "server/physics/world/corrections.hpp"

namespace cohort::physics {

/// What two surfaces do to each other.
struct SurfacePair {
  /// From here on a contact is rigid: it would give less than is ever seen [N/m].
  static constexpr double rigid = 1e9;

  double friction = 0.0;
  double restitution = 0.0;
  double rolling_resistance = 0.0;   ///< [m]
  double spinning_resistance = 0.0;  ///< [m]
  double second_friction = 0.0;      ///< across the direction of friction
  enum class Directed : std::uint8_t { neither, by_first, by_second } directed = Directed::neither;
  double stiffness = rigid;                ///< of each point [N/m]
  double damping = 0.0;                    ///< of each that is not rigid [N s/m]
  double bounce_threshold = least_bounce;  ///< [m/s]
};

/// Combines surfaces, with the world's pairs of materials before the rule for the rest.
class SurfacePairs {
 public:
  explicit SurfacePairs(const description::World& world);
  SurfacePair of(const description::Surface& a, const description::Surface& b) const;

 private:
  std::size_t materials_;
  std::vector<std::optional<description::MaterialPair>> pairs_;  // materials_ x materials_
};

/// Tracks are made of what the first wheel that they stand for is made of or, if they name none, their link: the first
/// collision of it says so.
description::Surface surface_of_tracks(const description::Model& model, const description::TrackPair& drive);

}  // namespace cohort::physics
