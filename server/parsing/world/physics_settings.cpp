#include "server/parsing/world/physics_settings.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "server/parsing/yaml/yaml_values.hpp"

namespace cohort::parsing {
namespace {

constexpr std::pair<std::string_view, Fidelity> fidelities[] = {
    {"articulated", Fidelity::articulated}, {"treel", Fidelity::treel}, {"planar", Fidelity::planar}};
constexpr std::pair<std::string_view, Solver> solvers[] = {
    {"iterative", Solver::iterative}, {"direct", Solver::direct}, {"hybrid", Solver::hybrid}};

template <class Named>
auto named(const Named& choices, std::string_view name) {
  const auto* const found =
      std::find_if(std::begin(choices), std::end(choices), [&](const auto& choice) { return choice.first == name; });
  if (found == std::end(choices)) throw std::logic_error("no meaning for the choice " + std::string(name));
  return found->second;
}

template <class Named, class Choice>
std::string name_in(const Named& choices, Choice wanted) {
  for (const auto& [name, choice] : choices)
    if (choice == wanted) return std::string(name);
  throw std::logic_error("a choice without a name");
}

}  // namespace

std::string name_of(Fidelity fidelity) { return name_in(fidelities, fidelity); }
std::string name_of(Solver solver) { return name_in(solvers, solver); }

PhysicsSettings with_values(PhysicsSettings settings, const KeyValues& values) {
  if (values.has("fidelity")) settings.fidelity = named(fidelities, values.text("fidelity"));
  if (values.has("solver")) settings.solver = named(solvers, values.text("solver"));
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
