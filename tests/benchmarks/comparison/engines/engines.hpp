// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "server/description/world.hpp"
#include "tests/benchmarks/comparison/engines/engine.hpp"

/// Functions of the engines' source files; engine_kinds.cpp selects those that are part of this build.
namespace cohort::bench {

std::unique_ptr<Engine> make_cohort_engine(const Scene& scene, unsigned threads,
                                           description::Dynamics dynamics = description::Dynamics::bullet);
std::unique_ptr<MechanismRun> make_cohort_mechanism(const Mechanism& mechanism, description::Dynamics dynamics);

std::unique_ptr<Engine> make_bullet_engine(const Scene& scene);
std::unique_ptr<MechanismRun> make_bullet_mechanism(const Mechanism& mechanism);
std::optional<std::string> bullet_limitation(const Scene& scene);
std::string bullet_version();

enum class OdeStepper { world_step, quick_step };
std::unique_ptr<Engine> make_ode_engine(const Scene& scene, OdeStepper stepper);

std::unique_ptr<Engine> make_mujoco_engine(const Scene& scene);
std::unique_ptr<MechanismRun> make_mujoco_mechanism(const Mechanism& mechanism);
std::optional<std::string> mujoco_limitation(const Scene& scene);
std::string mujoco_version();

std::unique_ptr<Engine> make_enki_engine(const Scene& scene);

}  // namespace cohort::bench
