// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/benchmarks/comparison/engines/engine.hpp"

namespace cohort::bench {

/// An engine that the benchmark supports, whether it is part of this build or not.
struct EngineKind {
  std::string name;
  std::string package;  ///< Debian package of the engine; empty for Cohort
  /// Creates the engine; empty if its package was missing in the build. `threads`: for Cohort; the others use one.
  std::function<std::unique_ptr<Engine>(const Scene&, unsigned threads)> make;
  /// Creates a mechanism; also empty if the accuracy of the engine is not compared.
  std::function<std::unique_ptr<MechanismRun>(const Mechanism&)> make_mechanism;
  /// Returns why the engine cannot simulate a scene, or nothing.
  std::function<std::optional<std::string>(const Scene&)> limitation;
  std::string version{};  ///< version that the engine reports; empty if it reports none
};

const std::vector<EngineKind>& engine_kinds();

/// The engine to which the others are compared.
inline constexpr const char* reference_engine = "ode-quickstep";

}  // namespace cohort::bench
