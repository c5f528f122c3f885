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

/// A solid of a body that moves.
struct Part {
  std::uint32_t solid = 0;
  int segment = 0;
  Pose X_SC;
};

/// A link that gravity does not act on: it is pushed up by its weight.
struct WeightlessLink {
  std::size_t link = 0;
  int segment = 0;
  double mass = 0.0;         ///< [kg]
  Eigen::Vector3d centre_S;  ///< of mass
};

/// A body that moves.
struct Member {
  BodyId body;
  std::unique_ptr<Multibody> multibody;
  std::vector<Part> parts;  ///< ascending solids
  double reach = 0.0;       ///< no part's centre is further from a joint that moves it [m]
  double furthest_unseen = std::numeric_limits<double>::infinity();  ///< the least of its parts [m]
  bool is_fast = false;                                              ///< one of its parts is, in this step
  bool is_active = true;
  std::uint32_t still_steps = 0;  ///< in a row, and no more than it takes to fall asleep
  bool is_asleep = false;
  std::uint32_t next_asleep = 0;          ///< round all that fell asleep together, this one too
  bool is_finite = true;                  ///< of the last step: its velocities were
  bool is_inside = true;                  ///< of the last step: it is still in the world
  std::unique_ptr<ForceRecord> record{};  ///< null: nobody asked for it
  std::unique_ptr<FluidBody> fluid{};     ///< null: neither air nor water acts on it
  std::vector<WeightlessLink> weightless{};

  bool is_awake() const { return is_active && !is_asleep; }
};

/// What the solids of a model are made from: of each collision, links in their order.
struct ModelParts {
  std::vector<geometry::SolidKindPtr> kinds;
  std::vector<std::shared_ptr<const BulletShape>> shapes;
};

/// The bodies of a world that move, and all that couples them to each other and to what stands still: what the rows of
/// an island are made from. Of different members from different threads, unless a function says otherwise.
struct Assembly {
  explicit Assembly(const description::World& world);
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

  double step;                            ///< [s]
  Eigen::Vector3d gravity;                ///< [m/s^2]
  description::PhysicsSettings settings;  ///< with the lowest point that is meant if the world does not say
  SurfacePairs surfaces;
  geometry::Scene scene;
  Anchors anchors;
  Collision collision;
  std::vector<Member> members;
  std::uint64_t revision = 0;  ///< changes when a member comes, goes, falls asleep or wakes
  Connections connections;
  Pushes pushes;
  Media media;
  bool has_records = false;  ///< of any member
  bool has_belts = false;    ///< the same
  std::map<const Mechanism*, std::shared_ptr<const FluidModel>> fluid_models;

  /// Takes memory for as many solids, so that there is none to spare after they were added.
  void reserve(std::size_t solids);
  /// One thread alone. Its solids come in the order of the model's collisions.
  void add_static(BodyId body, const description::Model& model, const Pose& X_WM, const ModelParts& parts);
  /// One thread alone. Returns the index of the member.
  std::uint32_t add_member(std::unique_ptr<Multibody> multibody, const ModelParts& parts);
  /// From then on nothing touches it. One thread alone.
  void take_out(std::uint32_t member);
  /// In the world again, as it was, but at rest if it broke or had left the world. One thread alone.
  void put_back(std::uint32_t index);
  /// At rest at X_WM, with its joints as they are. One thread alone.
  void place(std::uint32_t index, const Pose& X_WM);
  void place_solids_of(const Member& member);
  /// One thread alone.
  void set_asleep(std::uint32_t index, bool asleep);
  /// From the next step on keeps what goes through the member's joints. One thread alone.
  void record(std::uint32_t index);
  /// Tells the records what acted on their bodies in this step; after it, before anything is released or taken out. One
  /// thread alone.
  void record_outside();
  /// Tells belts what they bore in this step; as `record_outside`.
  void load_belts();
  /// Whether an end is on a light part of its body.
  bool is_light(const Connection::End& end) const {
    return end.member != Anchors::nobody && members[end.member].multibody->mechanism().is_light(end.segment);
  }
  /// X_WS of the segment that an end is on; of the world's none.
  Pose pose_of(const Connection::End& end) const {
    return end.member == Anchors::nobody ? Pose{} : members[end.member].multibody->motion().segment_pose(end.segment);
  }

  /// Finds which parts of the member are fast. Returns how far the furthest of them goes in the step [m], 0 if none is.
  double look_ahead(Member& member);
  /// Finds what the member touches and stands on. `furthest`: that any part of any member goes. The vectors are scratch
  /// memory.
  void look_around(const Member& member, double furthest, std::vector<std::uint32_t>& near,
                   std::vector<std::uint32_t>& candidates);

  /// Calls `visit(other)` for every member that this one is coupled to by what it reports: its pairs, its connections
  /// and what its tracks stand on. Some more than once.
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
  /// The pairs with contact points that the member reports.
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
  /// The members that the tracks of this one stand on.
  template <class Visit>
  void for_each_ground(std::uint32_t member, Visit&& visit) const {
    for (const TrackRows& treel : members[member].multibody->treels())
      treel.for_each_ground([&](std::uint32_t solid) {
        if (anchors.moves(solid)) visit(anchors.member(solid));
      });
  }

  // Rows, of what is in the problem. What a row couples must be set up.
  void set_up(std::uint32_t member, IslandBodies& bodies);
  void add_own_rows(std::uint32_t member, Problem& problem);
  void add_connection_rows(Connection& connection, Problem& problem);
  void add_contact_rows(SolidPair& pair, Problem& problem) const;

  /// Whether its velocities are such that the step may go on; the member is told.
  bool check(std::uint32_t member, const IslandBodies& bodies);
  /// Of one that a snapshot has: throws SnapshotError if no body that is in the world can be so.
  void expect_sound(const Member& member) const;
  /// Whether nothing but itself, gravity and pushes acts on the member.
  bool is_in_flight(std::uint32_t index);
  /// Whether what is alone in its island touches something or hangs on it, other than by a joint of its tree.
  bool is_held(std::uint32_t index);
  /// Moves the body by the velocities found. `problem`: the one that has its own rows.
  void integrate(std::uint32_t index, const Problem& problem);

 private:
  /// Adds the solid of the collision `index` of the model.
  void add_solid(BodyId body, const ModelParts& parts, std::size_t index, const Pose& X_WC, Anchors::Part part);
  /// Of a solid: how its surface runs.
  RunningSurface surface_of(std::uint32_t solid) const;
  /// Whether it is of a root that nothing pushes.
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
