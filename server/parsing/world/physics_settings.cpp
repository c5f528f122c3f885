#include "server/parsing/world/physics_settings.hpp"

#include "server/parsing/keys/choices.hpp"
#include "server/parsing/yaml/yaml_values.hpp"

namespace cohort::parsing {

PhysicsSettings with_values(PhysicsSettings settings, const KeyValues& values) {
  if (values.has("fidelity")) settings.fidelity = choice_of<Fidelity>(fidelities, values.text("fidelity"));
  if (values.has("dynamics")) settings.dynamics = choice_of<Dynamics>(dynamics_kinds, values.text("dynamics"));
  if (values.has("solver")) settings.solver = choice_of<Solver>(solvers, values.text("solver"));
  if (values.has("iterations")) settings.iterations = static_cast<std::uint32_t>(values.whole("iterations"));
  if (values.has("direct_bodies")) settings.direct_bodies = static_cast<std::uint32_t>(values.whole("direct_bodies"));
  if (values.has("lowest")) settings.lowest = values.real("lowest");
  if (values.has("strict")) settings.strict = values.flag("strict");
  return settings;
}

KeyValues read_physics_map(const YamlNode& node, const std::string& path, const YamlReport& report) {
  return read_values(node, path, *find_extension("physics", "world"), false, report);
}

}  // namespace cohort::parsing
