// SPDX-License-Identifier: Apache-2.0
#include "server/placement/check_detachable_joints.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "server/core/text.hpp"

namespace cohort::placement {
namespace {

template <class Things>
std::vector<std::string> names_of(const Things& things) {
  std::vector<std::string> names;
  for (const auto& thing : things) names.push_back(thing.name);
  return names;
}

// Returns why `holder` cannot hold the child; empty if it can.
std::string flaw_of(const HeldChild& held, const Instance& holder, const Instance& child, const World& world) {
  if (&child == &holder) return "expected an object other than '" + child.name + "', to which it is attached";
  const std::vector<std::string> links = names_of(world.models[child.model].links);
  if (held.child_link.empty() || std::ranges::find(links, held.child_link) != links.end()) return "";
  return "'" + child.name + "' has no link '" + held.child_link + "'" + suggestion(held.child_link, links);
}

}  // namespace

void check_detachable_joints(World& world, std::vector<Problem>& problems) {
  std::set<std::pair<const Device*, std::string>> said;
  const auto say = [&](const Device& device, const HeldChild& held, const std::string& message,
                       std::vector<Problem>& where) {
    if (message.empty() || !said.emplace(&device, message).second) return;
    where.push_back(held.child_place);
    where.back().message = message;
  };
  for (const Instance& instance : world.instances)
    for (const Device& device : world.models[instance.model].devices) {
      const auto held = held_child_of(device);
      if (!held || said.contains({&device, ""})) continue;
      const auto child = std::ranges::find(world.instances, held->child, &Instance::name);
      if (child != world.instances.end()) {
        say(device, *held, flaw_of(*held, instance, *child, world), problems);
        continue;
      }
      said.emplace(&device, "");  // the same for all instances of the model
      if (!held->may_be_missing)
        say(device, *held,
            "there is no object '" + held->child + "'" + suggestion(held->child, names_of(world.instances)) +
                "; nothing is attached",
            world.warnings);
    }
}

}  // namespace cohort::placement
