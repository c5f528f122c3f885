// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/world/mass_ratio.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

// Beyond this, the impulses between two bodies that touch are inaccurate.
constexpr double greatest_ratio = 1e4;

double mass_of(const Model& model) {
  return std::accumulate(model.links.begin(), model.links.end(), 0.0,
                         [](double sum, const Link& link) { return sum + link.inertial.mass; });
}

bool may_touch(const Model& model) {
  return !model.is_static &&
         std::ranges::any_of(model.links, [](const Link& link) { return !link.collisions.empty(); });
}

}  // namespace

void warn_of_mass_ratio(World& world) {
  const Model* lightest = nullptr;
  const Model* heaviest = nullptr;
  for (const Model& model : world.models) {
    if (!may_touch(model)) continue;
    if (lightest == nullptr || mass_of(model) < mass_of(*lightest)) lightest = &model;
    if (heaviest == nullptr || mass_of(model) > mass_of(*heaviest)) heaviest = &model;
  }
  if (lightest == nullptr || !(mass_of(*heaviest) > greatest_ratio * mass_of(*lightest))) return;
  const double ratio = mass_of(*heaviest) / mass_of(*lightest);
  world.warnings.push_back({world.file, 0, "model[" + heaviest->name + "]",
                            "has " + shortest_text(std::round(ratio)) + " times the mass of '" + lightest->name +
                                "': where they touch, forces are inaccurate; use at most 10000 times"});
}

}  // namespace cohort::parsing
