#pragma once

#include <memory>
#include <optional>

#include "server/description/devices.hpp"
#include "tools/bench/scenes/sensing_scene.hpp"

namespace cohort::bench {

/// The sensors of robots that stand still, by one way to measure.
class SensingRun {
 public:
  SensingRun() = default;
  SensingRun(const SensingRun&) = delete;
  SensingRun& operator=(const SensingRun&) = delete;
  virtual ~SensingRun() = default;

  /// All sensors of all robots, once.
  virtual void sense() = 0;
  /// Of the last frame: the mean reading of proximity sensors, or the share of sources that robots see.
  virtual std::optional<double> answer() const = 0;
};

enum class Perceived { light, sound, both };

/// Sensors alone, as they are between two steps.
std::unique_ptr<SensingRun> make_cohort_proximity(const SensingScene& scene, description::ProximityTechnique technique);
std::unique_ptr<SensingRun> make_cohort_sources(const SensingScene& scene, Perceived perceived);
/// Whole ticks of a simulation: physics too, which does not know that nobody moves.
std::unique_ptr<SensingRun> make_cohort_proximity_ticks(const SensingScene& scene,
                                                        description::ProximityTechnique technique);
std::unique_ptr<SensingRun> make_cohort_sources_ticks(const SensingScene& scene, Perceived perceived);

/// Of each proximity sensor one of ODE's rays against all around; nothing else is done.
std::unique_ptr<SensingRun> make_ode_proximity(const SensingScene& scene);
/// Of each robot and source a ray that meets nothing or something.
std::unique_ptr<SensingRun> make_ode_visibility(const SensingScene& scene);

}  // namespace cohort::bench
