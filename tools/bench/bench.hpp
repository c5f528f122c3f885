#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/bench/measuring/measure.hpp"

namespace cohort::bench {

std::vector<std::string> scene_names();
std::vector<std::string> engine_names();

/// Throws std::invalid_argument if an engine that was asked for is not in this build.
void check_engines(const Options& options);

/// Which engines the machine's build lacks and which Debian packages bring them, a line each; or nothing.
std::string missing_engines();

/// Measures scene by scene; `print` gets each table as soon as it is there. Returns all results. Throws Interrupted.
nlohmann::ordered_json measure_all(const Options& options, const Surroundings& surroundings,
                                   const std::function<void(const std::string&)>& print);

}  // namespace cohort::bench
