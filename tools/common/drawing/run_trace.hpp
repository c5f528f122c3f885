// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <compare>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "server/description/world.hpp"
#include "server/geometry/shapes/shapes.hpp"
#include "server/simulation/simulation.hpp"
#include "tools/common/drawing/viewpoint.hpp"

/// The data of a run for a plot, in the viewer's frame V.
namespace cohort::tool {

struct TracedSolid {
  enum class Kind {
    floor,     ///< static, and not higher than the lowest point of any robot
    obstacle,  ///< static
    object,    ///< moves, and belongs to no robot; in its final pose
    robot,     ///< part of a robot, or a box for its tracks
  };
  Kind kind;
  geometry::Shape shape;
  Pose X_VC;
};

/// The path of a robot in the plane of V.
struct RobotTrace {
  std::string name;
  std::uint32_t team = 0;               ///< index of RunTrace::teams
  double radius = 0.0;                  ///< about the root link's origin, around all of its collisions at tick 0 [m]
  std::vector<Eigen::Vector2d> path_V;  ///< [m], first the start, last the end
  double end_heading = 0.0;             ///< angle of the root link's x axis from the x axis of V [rad]
  std::vector<TracedSolid> at_start;    ///< filled for the side view only
  std::vector<TracedSolid> at_end;      ///< the same
};

/// Contacts of robots. A robot has at most one mark of each kind within a square of `contact_spacing`.
struct ContactMark {
  enum class Kind { obstacle, robot };
  Kind kind;
  Eigen::Vector2d position_V;
};

/// The final state of a lamp that belongs to no robot.
struct TracedLamp {
  Eigen::Vector2d position_V;
  bool is_on = false;
};

struct RunTrace {
  Viewpoint viewpoint = Viewpoint::above;
  std::vector<TracedSolid> solids;  ///< the farthest first; without planes and height maps
  std::vector<RobotTrace> robots;   ///< by id
  std::vector<std::string> teams;   ///< the experiment's
  std::vector<ContactMark> contacts;
  std::vector<TracedLamp> lamps;  ///< without directional ones, which have no position
};

/// Records the trace of a run. It only reads from the simulation, so the run's state hash does not change. Uses 160
/// bytes for each robot and simulated second.
class TraceRecorder {
 public:
  static constexpr std::chrono::milliseconds sample_interval{100};  ///< simulated
  static constexpr double contact_spacing = 0.05;                   ///< [m]

  /// `simulation` must be at tick 0. World and simulation must outlive this.
  TraceRecorder(const description::World& world, const Simulation& simulation, Viewpoint viewpoint = Viewpoint::above);

  /// Records the state; called at each tick boundary.
  void boundary();

  /// Returns the trace; called once, at the end. It ends at the present boundary, or at the last sample for a robot
  /// whose state is no longer finite.
  RunTrace finish();

 private:
  struct ContactCell {
    std::uint32_t robot;
    ContactMark::Kind kind;
    std::int64_t x, y;
    // NOLINTNEXTLINE(modernize-use-nullptr): the 0 in it is the compiler's (LLVM's issue 53961).
    auto operator<=>(const ContactCell&) const = default;
  };

  void sample();
  void note_contacts();
  std::uint32_t robot_of(BodyId body) const;
  bool is_floor(BodyId body) const;
  Eigen::Vector2d seen(const Eigen::Vector3d& p_W) const { return (R_VW_ * p_W).head<2>(); }
  Pose pose_seen(const Pose& X_W) const { return {R_VW_ * X_W.position, R_VW_ * X_W.orientation}; }
  void note_robots(std::vector<TracedSolid> RobotTrace::*solids);

  const description::World& world_;
  const Simulation& simulation_;
  Eigen::Quaterniond R_VW_;
  std::uint64_t sample_ticks_;
  std::uint64_t next_sample_;
  std::vector<std::uint32_t> robot_of_body_;
  std::vector<char> is_floor_;  // by body: whether it never obstructs a robot
  std::set<ContactCell> touched_;
  RunTrace trace_;
};

}  // namespace cohort::tool
