#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "server/physics/dynamics/equations.hpp"
#include "server/physics/mechanism/lanes.hpp"
#include "server/physics/world/anchors.hpp"

namespace cohort::physics {

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// One scalar constraint: the velocity along the row seeks `target` by an impulse within limits.
struct Row {
  /// How the limits come about. `friction`: ± the smaller of `cap` and `friction` times the sum of the impulses of the
  /// rows [load_begin, load_end). `cone`: this row and the next, which is `coned`, share such a limit as the radius of
  /// a disc.
  /// `soft`: fixed, and the velocity sought is less by `softness` times the impulse.
  enum class Limits : std::uint8_t { fixed, friction, cone, coned, soft };

  double target = 0.0;   ///< [m/s] or [rad/s]
  double inverse = 0.0;  ///< 1 / velocity that a unit impulse gives; 0: none
  double lower = -unlimited;
  double upper = unlimited;
  double impulse = 0.0;  ///< [N s] or [N m s]
  double friction = 0.0;
  double cap = unlimited;
  double cone_inverse = 0.0;  ///< of a cone: 1 / the greatest velocity that a unit impulse in its plane gives; 0: none
  double softness = 0.0;      ///< of a soft row [m/s / N s] or [rad/s / N m s]
  int load_begin = 0;
  int load_end = 0;
  Limits limits = Limits::fixed;

  int body_a = -1;  ///< in the problem
  int body_b = -1;  ///< -1: only one body
  double* velocity_a = nullptr;
  double* velocity_b = nullptr;  ///< null: only one body
  std::ptrdiff_t stride_a = 0;
  std::ptrdiff_t stride_b = 0;
  std::size_t numbers = 0;  ///< where Jacobian and response of a, then of b, begin in the problem's numbers
  double* kept = nullptr;   ///< where the impulse stays for the next step's start

  void set_limits(double least, double most) {
    lower = least;
    upper = most;
  }
  bool has_fixed_limits() const { return limits == Limits::fixed || limits == Limits::soft; }
  /// Makes it soft; once.
  void soften(double its_softness) {
    limits = Limits::soft;
    softness = its_softness;
    if (inverse > 0.0) inverse = 1.0 / (1.0 / inverse + softness);
  }
};

/// The equations of the bodies of one island.
class IslandBodies {
 public:
  /// Forgets the bodies, keeps the memory, and makes room for `count` others, each to be set up before its first row.
  void reset(std::size_t count);
  int count() const { return count_; }
  Equations& operator[](int body) { return equations_[static_cast<std::size_t>(body)]; }
  const Equations& operator[](int body) const { return equations_[static_cast<std::size_t>(body)]; }

 private:
  std::vector<Equations> equations_;
  int count_ = 0;
};

/// Constraints of one island over one step: the rows that couple its bodies, all of them or those of a part. Rows are
/// solved in the order in which they were added.
class Problem {
 public:
  /// The bodies must outlive this.
  explicit Problem(IslandBodies& bodies) : bodies_(&bodies) {}

  /// Forgets the rows, keeps the memory.
  void clear();

  int body_count() const { return bodies_->count(); }
  const Equations& equations(int body) const { return (*bodies_)[body]; }
  std::vector<Row>& rows() { return rows_; }
  const std::vector<Row>& rows() const { return rows_; }
  int row_count() const { return static_cast<int>(rows_.size()); }
  const double* numbers() const { return numbers_.data(); }

  /// Adds the row of a force at `point_W` along `direction_W` on `a`, a body, and its reaction on `b`. `kept`: the
  /// impulse of the last step, from which the solver starts, and where it leaves the new one. The reference holds until
  /// the next row.
  Row& add_force_row(Anchor a, Anchor b, const Eigen::Vector3d& point_W, const Eigen::Vector3d& direction_W,
                     double* kept);
  /// The same of a torque.
  Row& add_torque_row(Anchor a, Anchor b, const Eigen::Vector3d& direction_W, double* kept);
  /// Adds the row of the force or torque along one dof of a joint.
  Row& add_dof_row(int body, int dof, double* kept);
  /// The same along one dof and, `share` times as much, along another one of the body.
  Row& add_dofs_row(int body, int dof, int other, double share, double* kept);

  /// Makes a cone of the last two rows, whose directions are at right angles.
  void join_to_cone();

  /// Along the row, with the bodies' present velocities.
  double velocity(const Row& row) const;
  /// Along the row of `a` and `b`, with the velocities that the bodies had before this step.
  double velocity_before(const Row& row, Anchor a, Anchor b) const;

 private:
  Row& begin_row(Anchor a, Anchor b, double* kept);
  Row& finish_row(Row& row, Anchor a, Anchor b);

  IslandBodies* bodies_;
  std::vector<Row> rows_;
  std::vector<double> numbers_;
};

}  // namespace cohort::physics
