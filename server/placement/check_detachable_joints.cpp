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

// Empty if `holder` can hold it.
std::string flaw_of(const DetachableJoint& joint, const Instance& holder, const Instance& child, const World& world) {
  if (&child == &holder) return "expected another object than '" + child.name + "', which holds";
  const std::vector<std::string> links = names_of(world.models[child.model].links);
  if (joint.child_link.empty() || std::ranges::find(links, joint.child_link) != links.end()) return "";
  return "'" + child.name + "' has no link '" + joint.child_link + "'" + suggestion(joint.child_link, links);
}

}  // namespace

void check_detachable_joints(World& world, std::vector<Problem>& problems) {
  std::set<std::pair<const DetachableJoint*, std::string>> said;
  const auto say = [&](const DetachableJoint& joint, const std::string& message, std::vector<Problem>& where) {
    if (message.empty() || !said.emplace(&joint, message).second) return;
    where.push_back(joint.child_place);
    where.back().message = message;
  };
  for (const Instance& instance : world.instances)
    for (const Device& device : world.models[instance.model].devices) {
      const auto* const joint = std::get_if<DetachableJoint>(&device);
      if (joint == nullptr || said.contains({joint, ""})) continue;
      const auto child = std::ranges::find(world.instances, joint->child, &Instance::name);
      if (child != world.instances.end()) {
        say(*joint, flaw_of(*joint, instance, *child, world), problems);
        continue;
      }
      said.emplace(joint, "");  // the same for all instances of the model
      if (!joint->may_be_missing)
        say(*joint,
            "no object is called '" + joint->child + "'" + suggestion(joint->child, names_of(world.instances)) +
                "; nothing is held",
            world.warnings);
    }
}

}  // namespace cohort::placement
