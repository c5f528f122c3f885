// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "idl/dds/transport.hpp"
#include "server/viewing/scene_maker.hpp"

namespace cohort::session {

/// Publishes a run to viewers: docs/protocol.md, "Scenes". Does nothing without viewers, never blocks the run, and
/// takes at most a twentieth of its time. For the thread that steps.
class SceneBroadcast {
 public:
  SceneBroadcast(wire::Participant& participant, const std::string& partition);

  struct Shown {
    const Simulation& simulation;
    std::uint32_t run;  ///< changes with each simulation
  };
  enum class When {
    due,            ///< if the next frame is due
    at_once,        ///< something may have changed that would otherwise not be shown
    for_newcomers,  ///< if a viewer has connected since the last frame, or that frame is a second old
  };
  /// Publishes a boundary whose frames were sent.
  void publish(const Shown& shown, When when);
  /// Publishes the end of the last run: a keyword such as `finished`, and an optional sentence.
  void end(const std::string& how, const std::string& why);

 private:
  using Clock = std::chrono::steady_clock;

  bool is_watched(Clock::time_point now);
  void describe(const Shown& shown);
  void update(const Shown& shown);

  wire::Writer<wire::SceneDescription> descriptions_;
  wire::Writer<wire::SceneUpdate> updates_;
  std::uint32_t revision_ = 0;
  std::uint32_t run_ = 0;
  std::optional<viewing::SceneMaker> maker_;
  Clock::time_point watchers_counted_at_{};
  std::uint32_t watchers_ = 0;
  bool has_newcomers_ = false;
  Clock::time_point next_{};
};

}  // namespace cohort::session
