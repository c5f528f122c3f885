// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "server/physics/dynamics/equations.hpp"
#include "server/physics/mechanism/lanes.hpp"
#include "server/physics/world/anchors.hpp"

namespace cohort::physics {

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// One scalar constraint: an impulse within limits drives the velocity along the row towards `target`.
struct Row {
  /// The kind of limits. `friction`: ± the smaller of `cap` and `friction` times the sum of the impulses of the rows
  /// [load_begin, load_end). `cone`: this row and the next, which is `coned`, share such a limit as the radius of a
  /// disc. `soft`: fixed limits, and the target velocity is reduced by `softness` times the impulse.
  enum class Limits : std::uint8_t { fixed, friction, cone, coned, soft };

  double target = 0.0;   ///< [m/s] or [rad/s]
  double inverse = 0.0;  ///< effective mass: 1 / velocity change by a unit impulse; 0: none
  double lower = -unlimited;
  double upper = unlimited;
  double impulse = 0.0;  ///< [N s] or [N m s]
  double friction = 0.0;
  double cap = unlimited;
  double cone_inverse = 0.0;    ///< cone: 1 / the greatest velocity by a unit impulse in its plane; 0: none
  double softness = 0.0;        ///< for a soft row [m/s / N s] or [rad/s / N m s]
  double restitution = 0.0;     ///< share of the approach speed that is left after an impact at a contact
  double least_approach = 0.0;  ///< a slower approach is no impact [m/s]
  double closing = 0.0;         ///< speed that closes the gap within the step [m/s]
  int load_begin = 0;
  int load_end = 0;
  Limits limits = Limits::fixed;
  bool is_of_force = false;  ///< along a force at a point, not a torque or a joint's degree of freedom
  bool is_hold = false;      ///< its limits are the strength of a connection, seldom reached

  int body_a = -1;  ///< in the problem
  int body_b = -1;  ///< -1: only one body
  double* velocity_a = nullptr;
  double* velocity_b = nullptr;  ///< null: only one body
  std::ptrdiff_t stride_a = 0;
  std::ptrdiff_t stride_b = 0;
  std::size_t numbers = 0;  ///< start of Jacobian and response of a, then of b, in the problem's numbers
  double* kept = nullptr;   ///< storage of the impulse for warm starting

  void set_limits(double least, double most) {
    lower = least;
    upper = most;
  }
  /// Returns whether bodies rebound at this contact. `before`: velocity along the row before the step; the bodies must
  /// approach each other. `after`: velocity after the step without the contact; it must close the gap within the step.
  bool is_impact(double before, double after) const {
    return restitution > 0.0 && -before > least_approach && -after > closing;
  }
  bool has_fixed_limits() const { return limits == Limits::fixed || limits == Limits::soft; }
  /// Makes the row soft; call it at most once.
  void soften(double its_softness) {
    limits = Limits::soft;
    softness = its_softness;
    if (inverse > 0.0) inverse = 1.0 / (1.0 / inverse + softness);
  }
};

/// The equations of the bodies of one island.
class IslandBodies {
 public:
  /// Makes room for `count` new bodies and reuses the memory. Each body must be set up before its first row.
  void reset(std::size_t count);
  int count() const { return count_; }
  Equations& operator[](int body) { return equations_[static_cast<std::size_t>(body)]; }
  const Equations& operator[](int body) const { return equations_[static_cast<std::size_t>(body)]; }

 private:
  std::vector<Equations> equations_;
  int count_ = 0;
};

/// The constraints of one island, or of one of its parts, over one step: rows that couple its bodies. Rows are solved
/// in the order in which they were added.
class Problem {
 public:
  /// The bodies must outlive this.
  explicit Problem(IslandBodies& bodies) : bodies_(&bodies) {}

  /// Removes all rows and keeps the memory.
  void clear();

  int body_count() const { return bodies_->count(); }
  Equations& equations(int body) { return (*bodies_)[body]; }
  const Equations& equations(int body) const { return (*bodies_)[body]; }
  std::vector<Row>& rows() { return rows_; }
  const std::vector<Row>& rows() const { return rows_; }
  int row_count() const { return static_cast<int>(rows_.size()); }
  const double* numbers() const { return numbers_.data(); }

  /// Adds the row of a force at `point_W` along `direction_W` on `a`, a body, and its reaction on `b`. `kept` holds the
  /// impulse of the last step, from which the solver starts, and receives the new one. The reference is valid until the
  /// next row is added.
  Row& add_force_row(Anchor a, Anchor b, const Eigen::Vector3d& point_W, const Eigen::Vector3d& direction_W,
                     double* kept);
  /// Adds the row of a torque on `a` and its reaction on `b`.
  Row& add_torque_row(Anchor a, Anchor b, const Eigen::Vector3d& direction_W, double* kept);
  /// Adds the row of the force or torque along one dof of a joint.
  Row& add_dof_row(int body, int dof, double* kept);
  /// Adds the row of a force or torque along one dof and, scaled by `share`, along another dof of the same body.
  Row& add_dofs_row(int body, int dof, int other, double share, double* kept);

  /// Joins the last two rows, whose directions must be perpendicular, to a friction cone.
  void join_to_cone();

  /// Returns the velocity along the row at the present velocities of the bodies.
  double velocity(const Row& row) const;
  /// Returns the velocity along the row at the velocities before this step.
  double velocity_before(const Row& row) const;
  /// Returns the rate at which the error along a row grows because the bodies turn, in addition to the velocity along
  /// the row [m/s] or [rad/s]. `off`: the present error [m] or [rad]; `ahead`: the error after a step with the present
  /// velocities. At speed v on a circle of radius r, the rate is h v^2 / 2r, where h is the step.
  double velocity_by_turning(const Row& row, double off, double ahead, double step) const {
    return (ahead - off) / step - velocity_before(row);
  }

 private:
  Row& begin_row(Anchor a, Anchor b, double* kept);
  Row& finish_row(Row& row, Anchor a, Anchor b);

  IslandBodies* bodies_;
  std::vector<Row> rows_;
  std::vector<double> numbers_;
};

}  // namespace cohort::physics
