#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/engines/engine.hpp"

namespace cohort::bench {

/// An engine that the benchmark knows, whether it is in this build or not.
struct EngineKind {
  std::string name;
  std::string package;  ///< Debian's, which the engine comes with; empty for Cohort
  /// Empty if the package was not there when this was built. `threads`: for Cohort; the others have one.
  std::function<std::unique_ptr<Engine>(const Scene&, unsigned threads)> make;
  /// Empty also if the engine is not compared by its accuracy.
  std::function<std::unique_ptr<MechanismRun>(const Mechanism&)> make_mechanism;
  /// Why the engine cannot do this scene, or nothing.
  std::function<std::optional<std::string>(const Scene&)> limitation;
  std::string version{};  ///< as the engine itself says; empty if it does not
};

const std::vector<EngineKind>& engine_kinds();

/// Others are compared to this one.
inline constexpr const char* reference_engine = "ode-quickstep";

}  // namespace cohort::bench
