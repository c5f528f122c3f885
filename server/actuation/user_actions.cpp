// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/user_actions.hpp"

namespace cohort::actuation {

UserActions::UserActions(const description::World& description, const physics::World& world) : world_(world) {
  for (std::uint32_t robot = 0; robot < description.robots.size(); ++robot)
    add_robot(RobotId{robot}, BodyId{description.robots[robot]}, description.robot_model(robot));
}

void UserActions::add_robot(RobotId robot, BodyId body, const description::Model& model) {
  for (std::size_t device = 0; device < model.devices.size(); ++device) {
    const auto* const action = std::get_if<description::UserAction>(&model.devices[device]);
    if (action == nullptr) continue;
    const auto [known, is_new] =
        numbers_.try_emplace({world_.slot_of(body), DeviceId{device}}, static_cast<std::uint32_t>(actions_.size()));
    if (is_new) actions_.emplace_back();
    actions_[known->second] = {.name = action->name, .robot = robot, .body = body};
  }
}

void UserActions::finish_step() {
  for (ActionOfRobot& action : actions_) {
    if (!world_.is_active(action.body)) action.value = 0.0;
    const bool was_done = action.is_done;
    action.is_done = action.value > threshold;
    action.begins = action.is_done && !was_done;
  }
}

void UserActions::hash(StateHash& hash) const {
  for (const ActionOfRobot& action : actions_) hash.add(static_cast<std::uint64_t>(action.is_done));
}

void UserActions::save(SnapshotWriter& writer) const {
  for (const ActionOfRobot& action : actions_) writer.add(action.is_done);
}

void UserActions::restore(SnapshotReader& reader) {
  for (ActionOfRobot& action : actions_) reader.read(action.is_done);
}

}  // namespace cohort::actuation
