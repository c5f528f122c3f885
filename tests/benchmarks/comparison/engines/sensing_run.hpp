// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "server/description/devices.hpp"
#include "tests/benchmarks/comparison/scenes/sensing_scene.hpp"

namespace cohort::bench {

/// One method of measuring the sensors of robots at rest.
class SensingRun {
 public:
  SensingRun() = default;
  SensingRun(const SensingRun&) = delete;
  SensingRun& operator=(const SensingRun&) = delete;
  virtual ~SensingRun() = default;

  /// Measures all sensors of all robots once.
  virtual void sense() = 0;
  /// Returns, for the last frame, the mean reading of proximity sensors, or the fraction of sources that robots see.
  virtual std::optional<double> answer() const = 0;
};

enum class Perceived { light, sound, both };

/// Sensors only, as between two steps.
std::unique_ptr<SensingRun> make_cohort_proximity(const SensingScene& scene, description::ProximityTechnique technique);
std::unique_ptr<SensingRun> make_cohort_sources(const SensingScene& scene, Perceived perceived);
/// Whole ticks of a simulation, including physics, which is not told that all robots are at rest.
std::unique_ptr<SensingRun> make_cohort_proximity_ticks(const SensingScene& scene,
                                                        description::ProximityTechnique technique);
std::unique_ptr<SensingRun> make_cohort_sources_ticks(const SensingScene& scene, Perceived perceived);

/// Casts one ray of ODE for each proximity sensor against all solids nearby, and nothing else.
std::unique_ptr<SensingRun> make_ode_proximity(const SensingScene& scene);
/// Casts a ray from each robot to each source, and only tests whether it hits a solid.
std::unique_ptr<SensingRun> make_ode_visibility(const SensingScene& scene);

}  // namespace cohort::bench
