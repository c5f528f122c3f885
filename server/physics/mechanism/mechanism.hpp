// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "server/description/world.hpp"
#include "server/physics/mechanism/device_outputs.hpp"
#include "server/physics/mechanism/lanes.hpp"
#include "server/physics/mechanism/segment.hpp"
#include "server/physics/mechanism/spatial_inertia.hpp"

namespace cohort::physics {

/// One degree of freedom of a joint, or one of the six of a free root (which has no damping, spring or limit).
struct Dof {
  int coordinate = -1;  ///< for a revolute or prismatic joint
  description::JointAxis axis;
  double rotor_inertia = 0.0;  ///< rotor inertia reflected to the joint [kg m^2] or [kg]

  bool has_spring() const { return axis.spring_stiffness != 0.0 && coordinate >= 0; }
};

/// A model as the dynamics sees it: a tree of segments. Immutable; shared by all bodies of the model.
///
/// The velocity vector starts with the six dofs of a free root in world axes: its angular velocity, then the linear
/// velocity of its centre of mass. The joints follow in the order of the segments. A ball joint has the angular
/// velocity in axes of its segment. Only joints have coordinates: an angle, a displacement, or the quaternion x y z w
/// of a ball joint.
class Mechanism {
 public:
  /// Creates it from a model; throws std::invalid_argument for tracks that are not on the root link.
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
  /// A coupling that makes the coordinate of one dof follow that of another.
  struct Follower {
    int dof = 0;
    int leader = 0;
    double multiplier = 1.0;
    double offset = 0.0;
  };
  const std::vector<Follower>& followers() const { return followers_; }
  /// Returns what the devices drive other than joints.
  const DeviceOutputs& outputs() const { return outputs_; }

  const std::vector<Segment>& segments() const { return segments_; }
  const std::vector<Dof>& dofs() const { return dofs_; }
  /// Returns, by segment, the inertia of the fluid around it, about the origin of S in its axes; empty if no link has
  /// added mass.
  const std::vector<SpatialMatrix>& added_masses() const { return added_masses_; }
  const LinkPlace& link(std::size_t index) const { return links_[index]; }
  const JointPlace& joint(std::size_t index) const { return joints_[index]; }
  /// Returns all coordinates with every joint at zero.
  const std::vector<double>& zero_coordinates() const { return zero_coordinates_; }
  /// Returns whether it is a single rigid body that is free to move.
  bool is_free_body() const { return segments_.size() == 1 && segments_[0].motion == Motion::free; }
  /// Returns whether it is a free body that keeps its angular momentum: the fluid around it takes none.
  bool turns_freely() const { return is_free_body() && added_masses_.empty(); }
  bool has_free_root() const { return segments_[0].motion == Motion::free; }
  /// Returns whether the root is free and keeps its velocity under any force: the solver gives it a mass of 1e15 kg.
  bool has_kinematic_root() const { return has_free_root() && model_->links[0].is_kinematic; }
  /// Returns whether it has several degrees of freedom, of which no motor, friction, coupling or loop holds any.
  bool swings_freely() const { return swings_freely_; }
  /// Returns whether wheels are simulated; the motors of their joints then drive the robot.
  bool has_wheels() const { return has_wheels_; }

  /// Returns the mass of everything that forces can move [kg].
  double moving_mass() const { return moving_mass_; }
  /// Returns the mass that moves with a dof [kg].
  double mass_beyond(int dof) const { return mass_beyond_[static_cast<std::size_t>(dof)]; }

  int dof_count() const { return static_cast<int>(dofs_.size()); }
  /// Returns the length of a velocity vector in the solver, padded with zeros. A mechanism welded to the world has such
  /// a vector too.
  std::ptrdiff_t stride() const { return (std::max(dof_count(), 1) + lanes - 1) / lanes * lanes; }
  /// Returns, by dof, the next dof towards the root, or -1 if there is none.
  const std::vector<int>& parents() const { return parents_; }
  /// Returns whether the parent of each dof is the next lower dof, down to 0.
  bool is_chain() const { return is_chain_; }

 private:
  void add_link(std::size_t link, const std::vector<char>& welded);
  int add_segment(int parent, Motion motion, const Pose& X_PS, const Eigen::Vector3d& axis_S,
                  const description::JointAxis* axis);
  void turn_to_principal_axes();
  void find_followers();
  void find_outputs();
  bool is_held_by_rows() const;
  void sum_masses();
  void make_root_immovable();
  void add_mass(int index, const description::Inertial& inertial, const Pose& X_SL);
  void sum_added_masses();

  const description::Model* model_;
  std::vector<Segment> segments_;
  std::vector<Dof> dofs_;
  std::vector<SpatialMatrix> added_masses_;
  std::vector<LinkPlace> links_;
  std::vector<JointPlace> joints_;
  std::vector<Follower> followers_;
  DeviceOutputs outputs_;
  std::vector<double> zero_coordinates_;
  std::vector<int> parents_;
  std::vector<double> mass_beyond_;  // by dof
  double moving_mass_ = 0.0;
  bool is_chain_ = true;
  bool has_wheels_ = false;
  bool swings_freely_ = false;
};

}  // namespace cohort::physics
