// SPDX-License-Identifier: Apache-2.0
#include "server/physics/multibody/contact_rows.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "server/core/is_unit.hpp"
#include "server/physics/world/corrections.hpp"

namespace cohort::physics {
namespace {

struct Tangents {
  Eigen::Vector3d first;
  Eigen::Vector3d second;
  bool are_along = false;  // the first is along the direction of friction
};

// A friction direction within this angle of the normal is ignored [rad].
constexpr double upright = 1e-3;

Tangents tangents_of(const ContactPoints& contact, const Eigen::Vector3d& normal) {
  assert(is_unit(normal));
  const Eigen::Vector3d& direction = contact.friction_direction_W;
  if (!direction.isZero(0.0)) {
    const Eigen::Vector3d along = direction - normal.dot(direction) * normal;
    const double length = along.norm();
    if (length > upright) return {along / length, normal.cross(along / length), true};
  }
  const Eigen::Vector3d across =
      std::abs(normal.z()) > 0.7 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d first = (across - normal.dot(across) * normal).normalized();
  return {first, normal.cross(first)};
}

}  // namespace

namespace {

// Shares the sum of the impulses of friction among the points by load, or sets them to zero. Otherwise points could
// strain against each other without any effect, and this strain would grow from step to step.
void share_friction(ContactPoints& contact, bool is_kept) {
  double load = 0.0;
  Eigen::Vector3d sum_W = Eigen::Vector3d::Zero();
  for (const ContactPoint& point : contact) {
    const Tangents tangents = tangents_of(contact, point.normal_W);
    load += point.impulse[0];
    sum_W += point.impulse[1] * tangents.first + point.impulse[2] * tangents.second;
  }
  for (ContactPoint& point : contact) {
    const double share = is_kept && load > 0.0 ? point.impulse[0] / load : 0.0;
    const Tangents tangents = tangents_of(contact, point.normal_W);
    point.impulse[1] = share * tangents.first.dot(sum_W);
    point.impulse[2] = share * tangents.second.dot(sum_W);
  }
}

// A spring with a damper, as in Connection::add_yielding_rows. If there is a gap, it starts when the gap is closed.
void soften(Row& push, double gap, const SurfacePair& surfaces, double step) {
  const double resistance = step * surfaces.stiffness + surfaces.damping;
  assert(resistance > 0.0);
  push.target = gap > 0.0 ? -gap / step : -surfaces.stiffness * gap / resistance;
  push.soften(1.0 / (step * resistance));
}

// Compliance of points under belts, as a share of the compliance without any load: deeper points carry more. For a
// rigid track any distribution of the load would be valid, and a turning vehicle would drift with the one that the
// solver finds.
constexpr double give_of_belts = 0.05;

void add_point_rows(Problem& problem, Anchor a, Anchor b, const Tangents& tangents, ContactPoint& point,
                    const SurfacePair& surfaces, const RunningSurfaces& running, double step) {
  const int normal = problem.row_count();
  Row& push = problem.add_force_row(a, b, point.position_W, point.normal_W, point.impulse.data());
  push.target = separating_velocity(point.gap, step);
  push.set_limits(0.0, unlimited);
  push.restitution = surfaces.restitution;
  push.least_approach = surfaces.bounce_threshold;
  push.closing = point.gap / step;
  if (surfaces.stiffness < SurfacePair::rigid && !push.is_impact(problem.velocity_before(push), problem.velocity(push)))
    soften(push, point.gap, surfaces, step);
  else if (running.has_belt() && push.inverse > 0.0)
    push.soften(give_of_belts / push.inverse);

  const auto limit_by_load = [&](Row& row, double coefficient) {
    row.limits = Row::Limits::friction;
    row.friction = coefficient;
    row.load_begin = normal;
    row.load_end = normal + 1;
  };
  const bool is_directed = surfaces.directed != SurfacePair::Directed::neither;
  const double friction =
      is_directed ? std::min(surfaces.friction, surfaces.second_friction) : surfaces.friction;  // radius of the disc
  const Eigen::Vector3d running_W = running.velocity_at(point.normal_W);
  const auto rub = [&](const Eigen::Vector3d& tangent, double coefficient, double* kept) {
    Row& row = problem.add_force_row(a, b, point.position_W, tangent, kept);
    row.target = tangent.dot(running_W);
    limit_by_load(row, coefficient);
  };
  if (is_directed && tangents.are_along) {
    rub(tangents.first, surfaces.friction, &point.impulse[1]);
    rub(tangents.second, surfaces.second_friction, &point.impulse[2]);
  } else if (friction > 0.0) {
    rub(tangents.first, friction, &point.impulse[1]);
    rub(tangents.second, friction, &point.impulse[2]);
    problem.join_to_cone();
  } else {
    point.impulse[1] = point.impulse[2] = 0.0;
  }
  if (surfaces.rolling_resistance > 0.0) {
    limit_by_load(problem.add_torque_row(a, b, tangents.first, point.rolling_impulse.data()),
                  surfaces.rolling_resistance);
    limit_by_load(problem.add_torque_row(a, b, tangents.second, &point.rolling_impulse[1]),
                  surfaces.rolling_resistance);
  } else {
    point.rolling_impulse = {};
  }
  if (surfaces.spinning_resistance > 0.0)
    limit_by_load(problem.add_torque_row(a, b, point.normal_W, &point.spinning_impulse), surfaces.spinning_resistance);
}

}  // namespace

ContactImpulse impulse_of(const ContactPoints& contact, const ContactPoint& point) {
  const Tangents tangents = tangents_of(contact, point.normal_W);
  return {point.impulse[0] * point.normal_W + point.impulse[1] * tangents.first + point.impulse[2] * tangents.second,
          point.rolling_impulse[0] * tangents.first + point.rolling_impulse[1] * tangents.second +
              point.spinning_impulse * point.normal_W};
}

void add_contact_rows(Problem& problem, Anchor a, Anchor b, ContactPoints& contact, const SurfacePair& surfaces,
                      const RunningSurfaces& running, double step, FrictionStart start) {
  if (start != FrictionStart::last) share_friction(contact, b.body < 0);
  for (ContactPoint& point : contact)
    add_point_rows(problem, a, b, tangents_of(contact, point.normal_W), point, surfaces, running, step);
}

}  // namespace cohort::physics
