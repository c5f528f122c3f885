// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/world/read_population.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "server/parsing/keys/choices.hpp"
#include "server/parsing/sdf/extension_values.hpp"

namespace cohort::parsing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

std::optional<Layout> read_uniform(const ExtensionValues& values, std::uint64_t, const SdfReport& report) {
  const UniformLayout layout{values.point("min"), values.point("max")};
  if (!(layout.lower.array() > layout.upper.array()).any()) return layout;
  report.problem(values.where("min"), "exceeds <cohort:max>");
  return std::nullopt;
}

std::optional<Layout> read_grid(const ExtensionValues& values, std::uint64_t count, const SdfReport&) {
  const auto square = static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  return GridLayout{values.point("center"), values.real("spacing"),
                    values.has("columns") ? values.whole("columns") : square, values.real("yaw")};
}

std::optional<Layout> read_gaussian(const ExtensionValues& values, std::uint64_t, const SdfReport&) {
  return GaussianLayout{values.point("center"), values.real("deviation")};
}

std::optional<Layout> read_ring(const ExtensionValues& values, std::uint64_t, const SdfReport&) {
  return RingLayout{values.point("center"), values.real("radius"), values.real("first_bearing")};
}

std::optional<Layout> read_line(const ExtensionValues& values, std::uint64_t, const SdfReport&) {
  return LineLayout{values.point("from"), values.point("to")};
}

// Returns a position in a pattern, in units of its spacing: the first member in front, the others behind or beside it.
Vector3d place_in(std::string_view pattern, std::uint64_t member, std::uint64_t count) {
  const auto number = static_cast<double>(member);
  if (pattern == "column") return {-number, 0.0, 0.0};
  if (pattern == "row") return {0.0, 0.5 * static_cast<double>(count - 1) - number, 0.0};
  // A wedge: alternately to the left and to the right of the first member.
  const std::uint64_t side_by_side = (member + 1) / 2;
  const auto rank = static_cast<double>(side_by_side);
  return {-rank, member % 2 == 1 ? rank : -rank, 0.0};
}

std::optional<Layout> read_formation(const ExtensionValues& values, std::uint64_t count, const SdfReport& report) {
  FormationLayout layout{values.point("center"), values.vectors("member")};
  if (values.has("pattern") == !layout.members.empty()) {
    report.problem(values.element(),
                   "expected either a <cohort:pattern> or a list of members, each as a <cohort:member>");
    return std::nullopt;
  }
  if (values.has("pattern")) {
    if (!values.has("spacing")) {
      report.problem(values.element(), "missing: distance between the members of a pattern", "cohort:spacing");
      return std::nullopt;
    }
    for (std::uint64_t i = 0; i < count; ++i)
      layout.members.emplace_back(values.real("spacing") * place_in(values.text("pattern"), i, count));
  } else if (layout.members.size() < count) {
    report.problem(values.element(), "has " + std::to_string(layout.members.size()) +
                                         " members, but <cohort:count> is " + std::to_string(count));
    return std::nullopt;
  }
  return layout;
}

using ReadLayout = std::optional<Layout> (*)(const ExtensionValues&, std::uint64_t, const SdfReport&);
constexpr std::pair<std::string_view, ReadLayout> layouts[] = {
    {"uniform", &read_uniform}, {"gaussian", &read_gaussian}, {"grid", &read_grid},
    {"ring", &read_ring},       {"line", &read_line},         {"formation", &read_formation},
};

std::optional<Layout> read_layout(const ExtensionValues& placement, std::uint64_t count, const SdfReport& report) {
  std::optional<Layout> layout;
  std::string known;
  int given = 0;
  for (const auto& [name, read] : layouts) {
    const Element* const element = placement.where(name);
    known += (known.empty() ? "<cohort:" : ", <cohort:") + std::string(name) + ">";
    if (element == placement.element()) continue;
    if (++given > 1) {
      report.problem(element, "is a second layout; a placement must have only one");
      return std::nullopt;
    }
    const auto values = ExtensionValues::read(element, *find_extension(name, "placement"), report);
    if (values) layout = read(*values, count, report);
  }
  if (given == 0) report.problem(placement.element(), "missing: one of " + known);
  return layout;
}

// Returns false, with a report, if the heading is invalid.
bool read_heading(const ExtensionValues& values, const SdfReport& report, Population& population) {
  const bool is_random = std::holds_alternative<UniformLayout>(population.layout) ||
                         std::holds_alternative<GaussianLayout>(population.layout);
  const bool has_course =
      std::holds_alternative<RingLayout>(population.layout) || std::holds_alternative<LineLayout>(population.layout);
  population.heading = is_random ? HeadingKind::random : HeadingKind::fixed;
  population.yaw = values.real("yaw");
  if (values.has("heading")) population.heading = choice_of<HeadingKind>(headings, values.text("heading"));
  if (population.heading == HeadingKind::along && !has_course) {
    report.problem(values.where("heading"), "'along' can only be used with <cohort:ring> and <cohort:line>");
    return false;
  }
  const bool needs_point = population.heading == HeadingKind::towards || population.heading == HeadingKind::away;
  if (needs_point != values.has("point")) {
    report.problem(values.where(needs_point ? "heading" : "point"),
                   needs_point ? "'" + values.text("heading") + "' requires a <cohort:point>"
                               : "can only be used with the headings 'towards' and 'away'");
    return false;
  }
  if (needs_point) population.point = values.point("point");
  return true;
}

}  // namespace

std::optional<WrittenPopulation> read_population(const Element* element, const Extension& extension,
                                                 const SdfReport& report) {
  const auto values = ExtensionValues::read(element, extension, report);
  if (!values) return std::nullopt;
  const auto placement =
      ExtensionValues::read(values->where("placement"), *find_extension("placement", "population"), report);
  if (!placement) return std::nullopt;

  WrittenPopulation written{values->where("uri"), values->text("uri"), {}};
  Population& population = written.population;
  population.name = values->name();
  population.count = values->whole("count");
  population.seed_offset = values->whole("seed_offset");
  population.may_be_fewer = values->flag("may_be_fewer");
  population.gap = placement->real("gap");
  population.level = placement->real("level");
  population.place = report.place_of(element);
  population.placement_place = report.place_of(placement->element());
  const std::optional<Layout> layout = read_layout(*placement, population.count, report);
  if (!layout) return std::nullopt;
  population.layout = *layout;
  if (!read_heading(*placement, report, population)) return std::nullopt;
  return written;
}

}  // namespace cohort::parsing
