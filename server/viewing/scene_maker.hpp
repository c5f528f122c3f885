// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "idl/messages/scene_messages.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort::viewing {

/// Describes a simulation to viewers. It changes nothing, so the run's hash does not depend on it. Use it between
/// steps, on the thread that steps.
class SceneMaker {
 public:
  /// `simulation` must outlive this object. `revision`: unique among the makers of a source.
  SceneMaker(const Simulation& simulation, std::uint32_t revision);

  /// Returns true if there are objects that are not in the scene; then a new maker is needed.
  bool is_outdated() const;
  messages::Scene scene() const;
  messages::SceneFrame frame(std::uint32_t run, std::uint64_t state_hash) const;
  messages::SceneSignals signals() const;
  messages::SceneContacts contacts() const;
  /// `robot`: id in the simulation.
  messages::SceneRobot robot(std::uint32_t robot) const;

 private:
  struct PlacedLink {
    BodyId body;
    LinkId link;
  };
  std::uint32_t place_of(const emission::Mount& mount) const {
    return first_of_link_[simulation_.world().model_of(mount.body)][mount.link.value] +
           place_in_model_[mount.body.value];
  }
  messages::SceneEmitter emitter(const emission::Mount& mount) const;
  void add_entities(messages::Scene& scene) const;
  void add_emitters(messages::Scene& scene) const;
  void choose_lamps();

  const Simulation& simulation_;
  std::uint32_t revision_;
  std::uint32_t objects_;
  std::vector<PlacedLink> links_;                          // in the order of a frame
  std::vector<std::uint32_t> place_in_model_;              // by object
  std::vector<std::vector<std::uint32_t>> first_of_link_;  // by model and link: index in links_
  std::vector<std::uint32_t> lamps_;                       // lamps that are not LEDs
};

}  // namespace cohort::viewing
