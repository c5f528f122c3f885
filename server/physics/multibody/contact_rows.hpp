// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/physics/contact/contact_point.hpp"
#include "server/physics/multibody/rows.hpp"
#include "server/physics/world/anchors.hpp"
#include "server/physics/world/running_surface.hpp"
#include "server/physics/world/surface_pairs.hpp"

namespace cohort::physics {

/// The impulse of a contact point on the first of its two bodies over the last step, at its position [N s, N m s].
struct ContactImpulse {
  Eigen::Vector3d linear_W;
  Eigen::Vector3d angular_W;
};
ContactImpulse impulse_of(const ContactPoints& contact, const ContactPoint& point);

/// The surface velocities of a pair.
struct RunningSurfaces {
  RunningSurface a;
  RunningSurface b;

  bool has_belt() const { return a.is_belt() || b.is_belt(); }
  /// Returns the surface velocity of b relative to that of a at a contact with `normal_W`, from b towards a.
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& normal_W) const {
    return b.velocity_at(normal_W) - a.velocity_at(-normal_W);
  }
};

/// The warm start of friction. `last`: the impulses of the last step at each point, for a solver that converges.
/// `shared`: their sum over the points of a contact with a static body, distributed in proportion to load; zero between
/// two moving bodies.
enum class FrictionStart : std::uint8_t { last, shared };

/// Adds the rows of the points between `a`, a body, and `b`. Each point has one row along the normal, which is soft if
/// the surfaces are, and two along the surface. Friction acts in a disc or, if it has a direction, separately along and
/// across it. Two more rows against rolling and one against spinning follow if the surfaces resist these. Friction
/// drives each body towards the surface velocity of the other. `contact.friction_direction_W` is that of `surfaces` or,
/// if they have none, the axis of a belt.
void add_contact_rows(Problem& problem, Anchor a, Anchor b, ContactPoints& contact, const SurfacePair& surfaces,
                      const RunningSurfaces& running, double step, FrictionStart start);

}  // namespace cohort::physics
