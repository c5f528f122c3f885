#pragma once

#include <vector>

#include "server/description/world.hpp"
#include "server/physics/contact/contact_point.hpp"
#include "server/physics/multibody/rows.hpp"
#include "server/physics/world/anchors.hpp"

namespace cohort::physics {

/// What two surfaces do to each other.
struct SurfacePair {
  double friction = 0.0;
  double restitution = 0.0;
  double rolling_resistance = 0.0;  ///< [m]
};

/// Combines surfaces, with the world's pairs of materials before the rule for the rest.
class SurfacePairs {
 public:
  explicit SurfacePairs(const description::World& world);
  SurfacePair of(const description::Surface& a, const description::Surface& b) const;

 private:
  std::size_t materials_;
  std::vector<SurfacePair> pairs_;  // materials_ x materials_
  std::vector<char> is_given_;
};

/// What a point did to the first of its two bodies over the last step, at its position [N s, N m s].
struct ContactImpulse {
  Eigen::Vector3d linear_W;
  Eigen::Vector3d angular_W;
};
ContactImpulse impulse_of(const ContactPoint& point);

/// Adds the rows of the points between `a`, a body, and `b`: for each along the normal, two along the surface with
/// friction in a disc, and two against rolling where there is rolling resistance.
void add_contact_rows(Problem& problem, Anchor a, Anchor b, ContactPoints& contact, const SurfacePair& surfaces,
                      double step);

}  // namespace cohort::physics
