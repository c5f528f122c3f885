// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/world/physics_settings.hpp"

#include <algorithm>
#include <cmath>

#include "server/parsing/keys/choices.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"
#include "server/parsing/yaml/yaml_values.hpp"

namespace cohort::parsing {

PhysicsSettings with_values(PhysicsSettings settings, const KeyValues& values) {
  if (values.has("fidelity")) settings.fidelity = choice_of<Fidelity>(fidelities, values.text("fidelity"));
  if (values.has("dynamics")) settings.dynamics = choice_of<Dynamics>(dynamics_kinds, values.text("dynamics"));
  if (values.has("solver")) settings.solver = choice_of<Solver>(solvers, values.text("solver"));
  if (values.has("iterations")) settings.iterations = static_cast<std::uint32_t>(values.whole("iterations"));
  if (values.has("direct_bodies")) settings.direct_bodies = static_cast<std::uint32_t>(values.whole("direct_bodies"));
  if (values.has("lowest")) settings.lowest = values.real("lowest");
  if (values.has("sleeping")) settings.sleeping = values.flag("sleeping");
  if (values.has("strict")) settings.strict = values.flag("strict");
  return settings;
}

std::optional<std::chrono::nanoseconds> read_step(const Element& world, const SdfReport& report) {
  const std::vector<const Element*> all = children_of(world, "physics");
  if (all.empty()) return std::nullopt;
  const auto chosen =
      std::ranges::find_if(all, [](const Element* each) { return is_true(each->attribute("default")); });
  const Element* const physics = chosen == all.end() ? all.front() : *chosen;
  const Element* const step = physics->child("max_step_size");
  if (step == nullptr) return std::nullopt;
  constexpr double nanoseconds = 1e9;
  constexpr double rounding = 1e-3;  // in ns: 1/100 s has no exact binary representation
  constexpr double longest = 1.0;
  const auto seconds = step->real();
  if (!(seconds > 0.0 && seconds <= longest)) {
    if (!std::isnan(seconds)) report.problem(step, "expected a step > 0 s and <= 1 s");
    return std::nullopt;
  }
  constexpr double longest_accurate = 0.05;
  if (seconds > longest_accurate)
    report.warning(step, "a step of " + step->text() +
                             " s is too long for contacts and joints, which may then gain energy; use at most 0.05 s");
  const double count = std::round(seconds * nanoseconds);
  if (count < 1.0 || std::abs(seconds * nanoseconds - count) > rounding)
    report.problem(step, "expected a whole number of nanoseconds, not " + step->text() + " s");
  return std::chrono::nanoseconds(static_cast<std::int64_t>(count));
}

KeyValues read_physics_map(const YamlNode& node, const std::string& path, const YamlReport& report) {
  return read_values(node, path, *find_extension("physics", "world"), false, report);
}

}  // namespace cohort::parsing
