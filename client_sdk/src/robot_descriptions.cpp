// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/robot_descriptions.hpp"

#include <algorithm>

namespace cohort {

void RobotDescriptions::add(const wire::RobotDescription& description, std::uint64_t server) {
  std::erase_if(known_, [&](const Known& known) {
    return known.server == server && known.description.description == description.description;
  });
  known_.push_back({description, server});
}

void RobotDescriptions::add(const wire::RobotTree& tree, std::uint64_t server) {
  trees_.insert_or_assign({server, tree.description}, tree.tree);
}

bool RobotDescriptions::is_described(const wire::AdmittedRobot& robot, std::uint64_t server) const {
  if (with_trees_.contains(server) && !trees_.contains({server, robot.description})) return false;
  return std::ranges::any_of(known_, [&](const Known& known) {
    return known.server == server && known.description.description == robot.description;
  });
}

bool RobotDescriptions::describe(const wire::Admit& admit, std::uint64_t server) const {
  return std::ranges::all_of(admit.robots,
                             [&](const wire::AdmittedRobot& robot) { return is_described(robot, server); });
}

std::vector<wire::RobotDescription> RobotDescriptions::keep(std::uint64_t server) {
  std::erase_if(known_, [&](const Known& known) { return known.server != server; });
  std::erase_if(trees_, [&](const auto& tree) { return tree.first.first != server; });
  std::vector<wire::RobotDescription> descriptions;
  descriptions.reserve(known_.size());
  for (const Known& known : known_) {
    descriptions.push_back(known.description);
    const auto tree = trees_.find({server, known.description.description});
    if (tree != trees_.end()) descriptions.back().tree = tree->second;
  }
  return descriptions;
}

}  // namespace cohort
