#include "client_sdk/src/robot_descriptions.hpp"

#include <algorithm>

namespace cohort {

void RobotDescriptions::add(const wire::RobotDescription& description, std::uint64_t server) {
  std::erase_if(known_, [&](const Known& known) {
    return known.server == server && known.description.description == description.description;
  });
  known_.push_back({description, server});
}

bool RobotDescriptions::describe(const wire::Admit& admit, std::uint64_t server) const {
  return std::ranges::all_of(admit.robots, [&](const wire::AdmittedRobot& robot) {
    return std::ranges::any_of(known_, [&](const Known& known) {
      return known.server == server && known.description.description == robot.description;
    });
  });
}

std::vector<wire::RobotDescription> RobotDescriptions::keep(std::uint64_t server) {
  std::erase_if(known_, [&](const Known& known) { return known.server != server; });
  std::vector<wire::RobotDescription> descriptions;
  descriptions.reserve(known_.size());
  for (const Known& known : known_) descriptions.push_back(known.description);
  return descriptions;
}

}  // namespace cohort
