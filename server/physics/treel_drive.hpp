#pragma once

#include <array>

#include "server/description/model.hpp"
#include "server/geometry/scene.hpp"
#include "server/physics/one_body_row.hpp"
#include "server/physics/world.hpp"

namespace cohort::physics {

/// Both tracks of a robot as one constraint on its root link: up to four ground points that push, one drive row for
/// each side and one row against sliding sideways, 7 rows in all. Traction is limited by the motor and by friction
/// under the normal impulses of the same iteration. Against wheels with contacts it needs a quarter of the rows, and a
/// robot told to stand still stands still.
class TreelDrive final : public OneBodyConstraint {
 public:
  static constexpr int type = MAX_MULTIBODY_CONSTRAINT_TYPE + 1;

  /// `X_BL`: the drive's link in the multibody's base frame. The scene must outlive this.
  TreelDrive(btMultiBody* body, std::uint32_t body_index, const description::TreelDrive& drive, const Pose& X_BL,
             const geometry::Scene& scene);

  void set_target(Side side, double velocity) { side_of(side).target = velocity; }
  double target(Side side) const { return side_of(side).target; }
  const TrackState& track(Side side) const { return side_of(side).state; }

  /// Sets the limits of the drive and lateral rows from the normal impulses so far. Before each iteration of the
  /// solver.
  void limit_traction(btMultiBodyConstraintArray& rows) const;
  /// Takes the tracks' motion from the solved velocities. After the step's velocities are final.
  void advance_tracks(double step);

  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  struct Track {
    double target = 0.0;
    TrackState state;
    // Of the current step:
    int row = -1;  // its drive row, -1 while no ground point of this side touches
    std::array<int, 2> normal_rows{-1, -1};
    double friction = 0.0;  // the least under this side
    btVector3 point_W;
  };
  Track& side_of(Side side) { return tracks_[static_cast<std::size_t>(side)]; }
  const Track& side_of(Side side) const { return tracks_[static_cast<std::size_t>(side)]; }

  void add_normal_rows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data, double step);

  std::uint32_t body_index_;
  description::TreelDrive drive_;
  Pose X_BL_;
  const geometry::Scene* scene_;
  std::array<Track, 2> tracks_;
  // Of the current step:
  btVector3 forward_W_;
  btVector3 normal_W_;        // mean over the ground points that touch; zero if none does
  double motor_limit_ = 0.0;  // [N s] a side
  int lateral_row_ = -1;
};

/// Sequential impulses that ask every TreelDrive for its traction limits before each iteration. One object for each
/// worker.
class TreelSolver final : public btMultiBodyConstraintSolver {
 public:
  TreelSolver();

  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count, btTypedConstraint** constraints,
                                int constraint_count, const btContactSolverInfo& info, btIDebugDraw* draw) override;
};

}  // namespace cohort::physics
