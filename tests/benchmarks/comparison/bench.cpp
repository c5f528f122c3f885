// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "tests/benchmarks/comparison/measuring/report.hpp"

namespace cohort::bench {
namespace {

struct StepScene {
  const char* name;
  std::vector<std::uint32_t> robots;
  Scene (*make)(std::uint32_t robots, std::uint64_t seed);
};

const std::vector<StepScene>& step_scenes() {
  static const std::vector<StepScene> scenes = {
      {"crowd", {128, 1000}, crowd},
      {"free", {128, 1000}, spread},
      {"crowd_wheels",
       {128},
       [](std::uint32_t robots, std::uint64_t seed) {
         Scene scene = crowd(robots, seed);
         scene.drive = Drive::wheels;
         return scene;
       }},
      {"crowd_planar",
       {128, 1000},
       [](std::uint32_t robots, std::uint64_t seed) {
         Scene scene = crowd(robots, seed);
         scene.planar = true;
         return scene;
       }},
      {"chain", {25, 128}, [](std::uint32_t robots, std::uint64_t) { return chain(robots); }},
  };
  return scenes;
}

constexpr const char* rays_scene = "rays";
constexpr const char* build_scene = "build";
constexpr const char* accuracy_scene = "accuracy";
constexpr std::uint32_t robots_of_others = 10'000;

bool is_wanted(const std::vector<std::string>& wanted, const std::string& name) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

std::vector<EngineKind> chosen_engines(const Options& options) {
  std::vector<EngineKind> chosen;
  for (const EngineKind& kind : engine_kinds())
    if (kind.make && is_wanted(options.engines, kind.name)) chosen.push_back(kind);
  return chosen;
}

nlohmann::ordered_json versions_of(const std::vector<EngineKind>& engines) {
  nlohmann::ordered_json versions = nlohmann::ordered_json::object();
  for (const EngineKind& kind : engines)
    if (!kind.version.empty()) versions[kind.name] = kind.version;
  return versions;
}

std::string line_of(const nlohmann::ordered_json& versions) {
  std::string line;
  for (const auto& [engine, version] : versions.items())
    line += fmt::format("{}{} {}", line.empty() ? "" : ", ", engine, version.get<std::string>());
  return line + '\n';
}

nlohmann::ordered_json heading(const Options& options, const std::vector<EngineKind>& engines) {
  nlohmann::ordered_json missing = nlohmann::ordered_json::array();
  for (const EngineKind& kind : engine_kinds())
    if (!kind.make) missing.push_back({{"engine", kind.name}, {"package", kind.package}});
  return {{"seed", options.seed},
          {"seconds", options.seconds},
          {"repetitions", options.repetitions},
          {"cores", std::thread::hardware_concurrency()},
          {"engine_versions", versions_of(engines)},
          {"missing_engines", missing},
          {"results", nlohmann::ordered_json::array()}};
}

}  // namespace

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const StepScene& scene : step_scenes()) names.emplace_back(scene.name);
  names.insert(names.end(), {rays_scene, build_scene, accuracy_scene});
  return names;
}

std::vector<std::string> engine_names() {
  std::vector<std::string> names;
  for (const EngineKind& kind : engine_kinds()) names.push_back(kind.name);
  return names;
}

void check_engines(const Options& options) {
  for (const EngineKind& kind : engine_kinds())
    if (!options.engines.empty() && is_wanted(options.engines, kind.name) && !kind.make)
      throw std::invalid_argument(
          fmt::format("{} is not part of this build: install the Debian package {}, configure and build again",
                      kind.name, kind.package));
}

std::string missing_engines() {
  std::string lines;
  for (const EngineKind& kind : engine_kinds())
    if (!kind.make) lines += fmt::format("not part of this build: {} (Debian package {})\n", kind.name, kind.package);
  return lines;
}

nlohmann::ordered_json measure_all(const Options& options, const Surroundings& surroundings,
                                   const std::function<void(const std::string&)>& print) {
  const std::vector<EngineKind> engines = chosen_engines(options);
  nlohmann::ordered_json all = heading(options, engines);
  if (!all["engine_versions"].empty()) print(line_of(all["engine_versions"]));
  const auto take = [&](const auto& result) {
    print(table(result));
    all["results"].push_back(to_json(result));
  };
  const auto numbers = [&](const std::vector<std::uint32_t>& of_scene) {
    return options.robots.empty() ? of_scene : options.robots;
  };
  if (is_wanted(options.scenes, build_scene))  // must come first
    for (const std::uint32_t robots : numbers({robots_of_others}))
      take(measure_build(build_scene, robots, engines, options, surroundings));
  for (const StepScene& scene : step_scenes())
    if (is_wanted(options.scenes, scene.name))
      for (const std::uint32_t robots : numbers(scene.robots))
        take(measure_steps(scene.name, scene.make(robots, options.seed), engines, options, surroundings));
  if (is_wanted(options.scenes, rays_scene))
    for (const std::uint32_t robots : numbers({robots_of_others}))
      take(measure_rays(rays_scene, robots, options, surroundings));
  if (is_wanted(options.scenes, accuracy_scene)) take(measure_accuracy(accuracy_scene, engines, surroundings));
  return all;
}

}  // namespace cohort::bench
