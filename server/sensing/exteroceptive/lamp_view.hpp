// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "server/emission/emitters.hpp"
#include "server/geometry/visibility/sight_lines.hpp"
#include "server/physics/world/physics_world.hpp"
#include "server/sensing/shared_view.hpp"

namespace cohort::sensing {

/// Visibility of lamps from rings of light sensors. For many rings, it is computed lamp by lamp before the robots
/// sense, and the solids around a lamp are sorted once for all rings. For few rings, each query casts a ray. The
/// results are the same, bit for bit. A lamp is visible if the segment from it to the middle of the ring hits nothing
/// but the bodies that carry the lamp and the ring.
class LampView final : public SharedView {
 public:
  /// Keeps references to both.
  LampView(const physics::World& world, const emission::Emitters& emitters) : world_(world), emitters_(emitters) {}

  /// Adds a ring whose middle is at p_LS of a link. Returns its index, starting at 0.
  std::uint32_t add_ring(BodyId body, LinkId link, const Eigen::Vector3d& p_LS);
  std::uint32_t ring_count() const { return static_cast<std::uint32_t>(rings_.size()); }

  /// Requests the visibility for a ring from the next update.
  void ask(std::uint32_t ring) { asking_.push_back(ring); }
  /// Computes the visibility of all active lamps for the requested rings.
  void update(WorkerPool& workers) override;

  /// `lamp`: index in `Emitters::lit_lamps()` of a lamp that is neither directional nor on the ring's own body. For any
  /// thread between two updates.
  bool is_in_sight(std::uint32_t lamp, std::uint32_t ring) const;

 private:
  struct Ring {
    BodyId body;
    LinkId link;
    Eigen::Vector3d p_LS;
    Eigen::Vector3d p_WS = Eigen::Vector3d::Zero();
  };
  enum Answer : char { unknown, hidden, seen };

  Eigen::Vector3d middle_of(const Ring& ring) const { return world_.link_pose(ring.body, ring.link) * ring.p_LS; }
  void look_from_all(WorkerPool& workers);
  void look_from(std::uint32_t lamp, const geometry::Outlines& outlines, const geometry::SightLines::Heights& heights,
                 geometry::SightLines& lines);

  const physics::World& world_;
  const emission::Emitters& emitters_;
  std::vector<Ring> rings_;
  std::vector<std::uint32_t> asking_;        // requested rings
  std::vector<Answer> answers_;              // by lamp, then by ring
  std::vector<geometry::SightLines> lines_;  // by worker
};

}  // namespace cohort::sensing
