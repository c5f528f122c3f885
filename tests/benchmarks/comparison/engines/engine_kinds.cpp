// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/engines/engine_kinds.hpp"

#include <fmt/format.h>

#include "tests/benchmarks/comparison/engines/engines.hpp"

namespace cohort::bench {
namespace {

using Limitation = std::optional<std::string>;

constexpr std::size_t most_connected_in_world_step = 32;

Limitation none(const Scene&) { return std::nullopt; }

Limitation matrix_limitation(const Scene& scene) {
  if (scene.planar) return "planar bodies have no mass matrix";
  return std::nullopt;
}

Limitation world_step_limitation(const Scene& scene) {
  if (scene.connected && scene.robots.size() > most_connected_in_world_step)
    return fmt::format("more than {} connected robots take seconds per step", most_connected_in_world_step);
  return std::nullopt;
}

Limitation enki_limitation(const Scene& scene) {
  if (scene.connected) return "it does not support joints";
  return std::nullopt;
}

std::vector<EngineKind> known_engines() {
  const auto ours = [](const char* name, description::Dynamics dynamics, Limitation (*limitation)(const Scene&)) {
    return EngineKind{
        name, "", [=](const Scene& scene, unsigned threads) { return make_cohort_engine(scene, threads, dynamics); },
        [=](const Mechanism& mechanism) { return make_cohort_mechanism(mechanism, dynamics); }, limitation};
  };
  std::vector<EngineKind> kinds = {
      ours("cohort", description::Dynamics::bullet, none),
      ours("cohort-matrix", description::Dynamics::cohort, matrix_limitation),
      {"bullet", "libbullet-dev", [](const Scene& scene, unsigned) { return make_bullet_engine(scene); },
       make_bullet_mechanism, bullet_limitation, bullet_version()},
      {"ode-worldstep", "libode-dev", {}, {}, world_step_limitation},
      {"ode-quickstep", "libode-dev", {}, {}, none},
      {"mujoco", "libmujoco-dev", {}, {}, none},
      {"enki", "libenki-dev", {}, {}, enki_limitation}};
  // The build defines each macro as true or false, and links an engine's sources only if it is true.
  if constexpr (COHORT_BENCH_ODE) {
    kinds[3].make = [](const Scene& scene, unsigned) { return make_ode_engine(scene, OdeStepper::world_step); };
    kinds[4].make = [](const Scene& scene, unsigned) { return make_ode_engine(scene, OdeStepper::quick_step); };
  }
  if constexpr (COHORT_BENCH_MUJOCO) {
    kinds[5].make = [](const Scene& scene, unsigned) { return make_mujoco_engine(scene); };
    kinds[5].make_mechanism = make_mujoco_mechanism;
    kinds[5].limitation = mujoco_limitation;
    kinds[5].version = mujoco_version();
  }
  if constexpr (COHORT_BENCH_ENKI) kinds[6].make = [](const Scene& scene, unsigned) { return make_enki_engine(scene); };
  return kinds;
}

}  // namespace

const std::vector<EngineKind>& engine_kinds() {
  static const std::vector<EngineKind> kinds = known_engines();
  return kinds;
}

}  // namespace cohort::bench
