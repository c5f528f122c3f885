#pragma once

#include "server/physics/contact/contact_point.hpp"
#include "server/physics/multibody/rows.hpp"
#include "server/physics/world/anchors.hpp"
#include "server/physics/world/running_surface.hpp"
#include "server/physics/world/surface_pairs.hpp"

namespace cohort::physics {

/// What a point did to the first of its two bodies over the last step, at its position [N s, N m s].
struct ContactImpulse {
  Eigen::Vector3d linear_W;
  Eigen::Vector3d angular_W;
};
ContactImpulse impulse_of(const ContactPoints& contact, const ContactPoint& point);

/// How the surfaces of a pair run.
struct RunningSurfaces {
  RunningSurface a;
  RunningSurface b;

  bool has_belt() const { return a.is_belt() || b.is_belt(); }
  /// That of b against that of a, where they touch with `normal_W`, from b towards a.
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& normal_W) const {
    return b.velocity_at(normal_W) - a.velocity_at(-normal_W);
  }
};

/// Adds the rows of the points between `a`, a body, and `b`: for each along the normal, soft if the surfaces are; two
/// along the surface, with friction in a disc or, if it has a direction, by itself along and across it; two against
/// rolling and one against spinning, where there is resistance to that. Friction seeks to let each body go as the
/// surface of the other one runs. `contact.friction_direction_W` is that of `surfaces` or, if they have none, the axis
/// of a belt.
void add_contact_rows(Problem& problem, Anchor a, Anchor b, ContactPoints& contact, const SurfacePair& surfaces,
                      const RunningSurfaces& running, double step);

}  // namespace cohort::physics
