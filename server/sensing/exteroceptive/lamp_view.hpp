#pragma once

#include <cstdint>
#include <vector>

#include "server/emission/emitters.hpp"
#include "server/geometry/visibility/sight_lines.hpp"
#include "server/physics/world/physics_world.hpp"
#include "server/sensing/shared_view.hpp"

namespace cohort::sensing {

/// Which rings of light sensors see which lamps. Many rings are served lamp by lamp, before the robots sense, with what
/// stands around the lamp sorted once for all of them; few rings by a ray for each question. The answers are the same,
/// bit for bit: a lamp is seen if the segment from it to the middle of the ring meets nothing but the two bodies that
/// carry them.
class LampView final : public SharedView {
 public:
  /// Keeps references to both.
  LampView(const physics::World& world, const emission::Emitters& emitters) : world_(world), emitters_(emitters) {}

  /// A ring whose middle is at p_LS of a link. Returns its number: they count from 0.
  std::uint32_t add_ring(BodyId body, LinkId link, const Eigen::Vector3d& p_LS);
  std::uint32_t ring_count() const { return static_cast<std::uint32_t>(rings_.size()); }

  /// The ring will be asked for after the next update.
  void ask(std::uint32_t ring) { asking_.push_back(ring); }
  /// Looks from all lamps that are on, for the rings that have asked.
  void update(WorkerPool& workers) override;

  /// `lamp`: place in `Emitters::lit_lamps()`, of one that is neither directional nor on the ring's own body. From any
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
  std::vector<std::uint32_t> asking_;        // rings
  std::vector<Answer> answers_;              // by lamp, then by ring
  std::vector<geometry::SightLines> lines_;  // of each worker
};

}  // namespace cohort::sensing
