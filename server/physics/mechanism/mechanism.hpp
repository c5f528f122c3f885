#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "server/description/world.hpp"
#include "server/physics/mechanism/device_outputs.hpp"
#include "server/physics/mechanism/lanes.hpp"

namespace cohort::physics {

/// How a segment moves against its parent. `free`: not tied to anything; `anchored`: tied to the world.
enum class Motion { free, anchored, revolute, prismatic, ball };

/// Links welded together, which move as one. Frame S: where the joint above is, or the root link, turned to the
/// principal axes of its mass.
struct Segment {
  int parent = -1;  ///< -1: none; `X_PS` is then in the model's frame
  Motion motion = Motion::free;
  Pose X_PS;  ///< where all coordinates are zero
  /// From the joint above, or the root link, to S.
  Eigen::Quaterniond principal_axes = Eigen::Quaterniond::Identity();
  Eigen::Vector3d axis_S;  ///< of a revolute or prismatic joint
  int first_dof = 0;
  int dofs = 0;
  int first_coordinate = 0;
  int last_dof = -1;  ///< of its own or, having none, of the segments above; -1: nothing can move it

  double mass = 0.0;                                    ///< may be zero: the middle of a universal joint
  Eigen::Vector3d centre_S = Eigen::Vector3d::Zero();   ///< of mass
  Eigen::Matrix3d inertia_S = Eigen::Matrix3d::Zero();  ///< about the centre of mass, diagonal
};

/// Where a segment that a joint holds is: `X_WS` with its coordinates at zero, `coordinates` its own.
Pose moved_by_joint(const Segment& segment, const Pose& X_WS, const double* coordinates);

/// One degree of freedom of a joint, or one of the six of a free root (which has no damping, spring or limit).
struct Dof {
  int coordinate = -1;  ///< of a revolute or prismatic joint
  description::JointAxis axis;
  double rotor_inertia = 0.0;  ///< of its motor, as the joint feels it [kg m^2] or [kg]
};

/// A model as the dynamics sees it: a tree of segments. Constant; shared by all bodies of the model.
///
/// Velocities have the six of a free root first, angular before linear (of the root segment's centre of mass), in world
/// axes; then each joint's, in the order of the segments: a ball joint's angular velocity in axes of its segment.
/// Coordinates are those of the joints alone: an angle, a way, or the quaternion x y z w of a ball joint.
class Mechanism {
 public:
  /// Throws std::invalid_argument for tracks that are not on the root link.
  Mechanism(const description::Model& model, description::Fidelity fidelity);

  struct LinkPlace {
    int segment = 0;
    Pose X_SL;
    bool collides = true;
  };
  struct JointPlace {
    int segment = 0;  ///< the child's
    int first_dof = 0;
    int dofs = 0;  ///< 0: welded
    int first_coordinate = 0;
  };

  const description::Model& model() const { return *model_; }
  /// Lets the coordinate of a dof follow that of another one.
  struct Follower {
    int dof = 0;
    int leader = 0;
    double multiplier = 1.0;
    double offset = 0.0;
  };
  const std::vector<Follower>& followers() const { return followers_; }
  /// What devices drive beside joints.
  const DeviceOutputs& outputs() const { return outputs_; }

  const std::vector<Segment>& segments() const { return segments_; }
  const std::vector<Dof>& dofs() const { return dofs_; }
  const LinkPlace& link(std::size_t index) const { return links_[index]; }
  const JointPlace& joint(std::size_t index) const { return joints_[index]; }
  /// All coordinates where every joint is at zero.
  const std::vector<double>& zero_coordinates() const { return zero_coordinates_; }
  /// A single rigid body, free to move.
  bool is_free_body() const { return segments_.size() == 1 && segments_[0].motion == Motion::free; }
  bool has_free_root() const { return segments_[0].motion == Motion::free; }
  /// The root is free, and keeps its velocity whatever pushes it: to the solver it is as heavy as 1e15 kg.
  bool has_kinematic_root() const { return has_free_root() && model_->links[0].is_kinematic; }
  /// Wheels are simulated: what drives is their joints' motors.
  bool has_wheels() const { return has_wheels_; }

  /// Whether a segment with all that hangs on it has less than a quarter of the whole mass: what holds on there
  /// moves it easily and the rest hardly.
  bool is_light(int segment) const { return is_light_[static_cast<std::size_t>(segment)] != 0; }

  int dof_count() const { return static_cast<int>(dofs_.size()); }
  /// Doubles that a vector of velocities takes in the solver, padded with zeros; also what is welded to the world has
  /// some.
  std::ptrdiff_t stride() const { return (std::max(dof_count(), 1) + lanes - 1) / lanes * lanes; }
  /// By dof: the next one on the way to the root, -1: none.
  const std::vector<int>& parents() const { return parents_; }
  /// Whether the way from each dof to the root is the next lower dof, and so on down to 0.
  bool is_chain() const { return is_chain_; }

 private:
  void add_link(std::size_t link, const std::vector<char>& welded);
  int add_segment(int parent, Motion motion, const Pose& X_PS, const Eigen::Vector3d& axis_S,
                  const description::JointAxis* axis);
  void turn_to_principal_axes();
  void find_outputs();
  void find_light_segments();
  void make_root_immovable();
  void add_mass(int index, const description::Inertial& inertial, const Pose& X_SL);

  const description::Model* model_;
  std::vector<Segment> segments_;
  std::vector<Dof> dofs_;
  std::vector<LinkPlace> links_;
  std::vector<JointPlace> joints_;
  std::vector<Follower> followers_;
  DeviceOutputs outputs_;
  std::vector<double> zero_coordinates_;
  std::vector<int> parents_;
  std::vector<char> is_light_;  // by segment
  bool is_chain_ = true;
  bool has_wheels_ = false;
};

}  // namespace cohort::physics
