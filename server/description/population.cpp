#include "server/description/population.hpp"

#include "server/description/extension_values.hpp"

namespace cohort::description {

std::optional<Population> read_population(const sdf::ElementPtr& element, const Extension& extension,
                                          std::uint64_t seed, const SdfReport& report) {
  const auto read_group = [&](const ExtensionValues& parent, std::string_view parent_name, std::string_view name) {
    return ExtensionValues::read(parent.where(name), *find_extension(name, parent_name), report);
  };
  const auto values = ExtensionValues::read(element, extension, report);
  if (!values) return std::nullopt;
  const auto placement = read_group(*values, "population", "placement");
  if (!placement) return std::nullopt;
  const auto uniform = read_group(*placement, "placement", "uniform");
  if (!uniform) return std::nullopt;

  Population population;
  population.uri_element = values->where("uri");
  population.placement_element = placement->element();
  population.uri = values->text("uri");
  population.placement.name = values->name();
  population.placement.seed = seed + values->whole("seed_offset");
  population.placement.count = values->whole("count");
  population.placement.lower = uniform->point("min");
  population.placement.upper = uniform->point("max");
  population.placement.gap = placement->real("gap");
  if ((population.placement.lower.array() > population.placement.upper.array()).any()) {
    report.problem(uniform->where("min"), "exceeds <cohort:max>");
    return std::nullopt;
  }
  return population;
}

}  // namespace cohort::description
