#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "idl/dds/transport.hpp"
#include "server/viewing/scene_maker.hpp"

namespace cohort::session {

/// Shows a run to viewers: docs/protocol.md, "Scenes". Does nothing while nobody looks, is never waited for, and takes
/// no more than a twentieth of the time. The thread that steps.
class SceneBroadcast {
 public:
  SceneBroadcast(wire::Participant& participant, const std::string& partition);

  struct Shown {
    const Simulation& simulation;
    std::uint32_t run;  ///< another one for each simulation
  };
  enum class When {
    due,            ///< if it is time for another picture
    at_once,        ///< something may have changed that would not be shown otherwise
    for_newcomers,  ///< if somebody has come since the last one
  };
  /// At a boundary whose frames are out.
  void publish(const Shown& shown, When when);
  /// There will be no further run, and the last one ended so: a word, and maybe a sentence.
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
