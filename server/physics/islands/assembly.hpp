// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "server/physics/contact/collision.hpp"
#include "server/physics/fluid/fluid_body.hpp"
#include "server/physics/islands/force_record.hpp"
#include "server/physics/multibody/connections.hpp"
#include "server/physics/multibody/contact_rows.hpp"
#include "server/physics/multibody/multibody.hpp"
#include "server/physics/multibody/rows.hpp"
#include "server/physics/world/anchors.hpp"
#include "server/physics/world/pushes.hpp"

namespace cohort::physics {

/// A solid of a moving body.
struct Part {
  std::uint32_t solid = 0;
  int segment = 0;
  Pose X_SC;
};

/// A link without gravity: a force equal to its weight pushes it up.
struct WeightlessLink {
  std::size_t link = 0;
  int segment = 0;
  double mass = 0.0;         ///< [kg]
  Eigen::Vector3d centre_S;  ///< centre of mass
};

/// A moving body.
struct Member {
  BodyId body;
  std::unique_ptr<Multibody> multibody;
  std::vector<Part> parts;  ///< ascending solids
  double reach = 0.0;       ///< greatest distance of a part's centre from a joint that moves it [m]
  double furthest_unseen = std::numeric_limits<double>::infinity();  ///< minimum over its parts [m]
  bool is_fast = false;                                              ///< one of its parts is fast in this step
  bool is_active = true;
  std::uint32_t still_steps = 0;  ///< consecutive, at most as many as it takes to fall asleep
  bool is_asleep = false;
  std::uint32_t next_asleep = 0;          ///< index of the next member in the ring of all that fell asleep together
  bool is_finite = true;                  ///< its velocities were finite in the last step
  bool is_inside = true;                  ///< it was inside the world after the last step
  std::unique_ptr<ForceRecord> record{};  ///< null: not requested
  std::unique_ptr<FluidBody> fluid{};     ///< null: neither air nor water acts on it
  std::vector<WeightlessLink> weightless{};

  bool is_awake() const { return is_active && !is_asleep; }
  /// Returns whether its velocities and poses are finite, and its rotations are rotations. For assertions.
  bool is_valid() const;
};

/// The data from which the solids of a model are created, for each collision in the order of the links.
struct ModelParts {
  std::vector<geometry::SolidKindPtr> kinds;
  std::vector<std::shared_ptr<const BulletShape>> shapes;
};

/// The moving bodies of a world and everything that couples them to each other and to static solids: the source of the
/// rows of an island. Threads may work on different members, unless a function says otherwise.
struct Assembly {
  explicit Assembly(const description::World& world);
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

  double step;                            ///< [s]
  Eigen::Vector3d gravity;                ///< [m/s^2]
  description::PhysicsSettings settings;  ///< with the present default of `lowest` filled in
  SurfacePairs surfaces;
  geometry::Scene scene;
  Anchors anchors;
  Collision collision;
  std::vector<Member> members;
  std::uint64_t revision = 0;  ///< changes when a member is added, removed, falls asleep or wakes
  Connections connections;
  Pushes pushes;
  Media media;
  bool has_records = false;  ///< any member has one
  bool has_belts = false;    ///< any member has one
  std::map<const Mechanism*, std::shared_ptr<const FluidModel>> fluid_models;

  /// Reserves memory for exactly this many solids.
  void reserve(std::size_t solids);
  /// Adds a static body; its solids follow the order of the model's collisions. One thread only.
  void add_static(BodyId body, const description::Model& model, const Pose& X_WM, const ModelParts& parts);
  /// Adds a moving body and returns its member index. One thread only.
  std::uint32_t add_member(std::unique_ptr<Multibody> multibody, const ModelParts& parts);
  /// Adds a static body like `add_static`. It gets the solids, from `first_solid` on, of a removed body of the same
  /// model; the scene must be built afterwards. One thread only.
  void renew_static(BodyId body, const description::Model& model, const Pose& X_WM, std::uint32_t first_solid);
  /// Adds a moving body like `add_member`, in place of one of the same model that was taken out. One thread only.
  void renew_member(std::uint32_t index, std::unique_ptr<Multibody> multibody);
  /// Removes a member; nothing touches it from then on. One thread only.
  void take_out(std::uint32_t member);
  /// Puts a member back as it was, but at rest if its state broke or it had left the world. One thread only.
  void put_back(std::uint32_t index);
  /// Places a member at X_WM, at rest, with its joints unchanged. One thread only.
  void place(std::uint32_t index, const Pose& X_WM);
  void place_solids_of(const Member& member);
  /// Puts a member to sleep or wakes it. One thread only.
  void set_asleep(std::uint32_t index, bool asleep);
  /// Records the forces through the member's joints from the next step on. One thread only.
  void record(std::uint32_t index);
  /// Adds the external forces of this step to the records. Call it after the step, before anything is released or
  /// removed. One thread only.
  void record_outside();
  /// Adds the loads of this step to the belts; call it like `record_outside`.
  void load_belts();
  /// Returns X_WS of the segment that an end is on; the identity for the world.
  Pose pose_of(const Connection::End& end) const {
    return end.member == Anchors::nobody ? Pose{} : members[end.member].multibody->motion().segment_pose(end.segment);
  }
  /// Returns the X_WS of that segment after a step with the present velocities.
  Pose pose_ahead_of(const Connection::End& end) const {
    return end.member == Anchors::nobody ? Pose{}
                                         : pose_ahead(members[end.member].multibody->motion(), end.segment, step);
  }

  /// Determines which parts of the member are fast. Returns the greatest displacement of these parts in the step [m],
  /// or 0 if there are none.
  double look_ahead(Member& member);
  /// Finds the contacts of the member and the ground under its tracks. `furthest`: greatest displacement of any part of
  /// any member. The vectors are scratch memory.
  void look_around(const Member& member, double furthest, std::vector<std::uint32_t>& near,
                   std::vector<std::uint32_t>& candidates);

  /// Calls `visit(other)` for every member that this one is coupled to by its own pairs, its connections or the ground
  /// under its tracks. May visit a member more than once.
  template <class Visit>
  void for_each_coupled(std::uint32_t member, Visit&& visit) {
    for_each_pair(member, [&](const SolidPair& pair) {
      if (anchors.moves(pair.b)) visit(anchors.member(pair.b));
    });
    connections.for_each_of(member, [&](const Connection& connection) {
      if (connection.b().member != Anchors::nobody) visit(connection.b().member);
    });
    for_each_ground(member, visit);
  }
  /// Calls `visit(pair)` for the pairs with contact points that the member reports.
  template <class Visit>
  void for_each_pair(std::uint32_t member, Visit&& visit) {
    for (const Part& part : members[member].parts)
      for (SolidPair& pair : collision.pairs_of(part.solid))
        if (pair.contact.count > 0) visit(pair);
  }
  template <class Visit>
  void for_each_pair(std::uint32_t member, Visit&& visit) const {
    for (const Part& part : members[member].parts)
      for (const SolidPair& pair : collision.pairs_of(part.solid))
        if (pair.contact.count > 0) visit(pair);
  }
  /// Calls `visit(other)` for the members under the tracks of this one.
  template <class Visit>
  void for_each_ground(std::uint32_t member, Visit&& visit) const {
    for (const TrackRows& treel : members[member].multibody->treels())
      treel.for_each_ground([&](std::uint32_t solid) {
        if (anchors.moves(solid)) visit(anchors.member(solid));
      });
  }

  // The following functions add rows to a problem. All bodies that a row couples must be set up first.
  void set_up(std::uint32_t member, IslandBodies& bodies);
  void add_own_rows(std::uint32_t member, Problem& problem);
  void add_connection_rows(Connection& connection, Problem& problem);
  void add_contact_rows(SolidPair& pair, Problem& problem, FrictionStart start) const;

  /// Returns whether the member's velocities allow the step to go on, and stores this in the member.
  bool check(std::uint32_t member, const IslandBodies& bodies);
  /// Validates a restored member; throws SnapshotError if no body in the world can have this state.
  void expect_sound(const Member& member) const;
  /// Returns whether only internal forces, gravity and applied forces act on the member.
  bool is_in_flight(std::uint32_t index);
  /// Returns whether a member that is alone in its island touches something, or is attached to it other than by a joint
  /// of its tree.
  bool is_held(std::uint32_t index);
  /// Moves the body with the solved velocities. `problem`: the one with the body's own rows.
  void integrate(std::uint32_t index, const Problem& problem);

 private:
  /// Adds the solid of the collision `index` of the model.
  void add_solid(BodyId body, const ModelParts& parts, std::size_t index, const Pose& X_WC, Anchors::Part part);
  /// Returns the velocity of a solid's surface (of a belt).
  RunningSurface surface_of(std::uint32_t solid) const;
  /// Returns the direction of friction of the solid's surface in W.
  Eigen::Vector3d friction_direction_of(std::uint32_t solid) const;
  /// Returns whether the solid belongs to a kinematic root, which no force moves.
  bool is_immovable(std::uint32_t solid) const;
  void keep_from_passing_through(Member& member) const;
  bool may_touch(std::uint32_t solid, std::uint32_t other) const;
  ForceRecord* record_of(std::uint32_t member) const {
    return member == Anchors::nobody ? nullptr : members[member].record.get();
  }
  void record_pair(const SolidPair& pair) const;
  void load_belt(std::uint32_t solid, const Eigen::Vector3d& outward_W, const Eigen::Vector3d& impulse_W);
  void record_connection(const Connection& connection) const;
};

}  // namespace cohort::physics
