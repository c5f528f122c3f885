// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "idl/dds/ros2/ros_names.hpp"
#include "tools/bridges/ros2/ros_bridge.hpp"

// The robots of the bridge: those of its lease, and those that services add and remove.
namespace cohort::ros2 {

using description::RosSync;

void RosBridge::begin(Client& client, const LeaseStart& lease) {
  const auto goes_on = [](const DrivenRobot& robot) { return robot.start.reason == StartReason::going_on; };
  is_other_run_ = std::ranges::none_of(lease.robots, goes_on);
  std::set<std::string_view> names;
  for (const DrivenRobot& robot : lease.robots) names.insert(robot.start.name);
  const auto has = [&](const std::string& name) { return names.contains(name); };
  if (is_other_run_) {
    deleted_.clear();
    if (std::erase_if(spawned_, [&](const auto& each) { return each.second.has_lease && !has(each.first); }) > 0)
      client.claim(selectors());
  }
  std::erase_if(deleted_, [&](const std::string& name) { return !has(name); });
  std::vector<std::string> absent;
  for (const auto& robot : robots_)
    if (!has(robot->name())) absent.push_back(robot->name());
  for (const std::string& name : absent) remove_robot(name);

  std::map<std::string_view, RosRobot*> known;
  for (const auto& robot : robots_) known.emplace(robot->name(), robot.get());
  robot_of_id_.clear();
  bool has_new = false;
  for (const DrivenRobot& robot : lease.robots) {
    if (const auto found = spawned_.find(robot.start.name); found != spawned_.end()) found->second.has_lease = true;
    if (!is_shown(robot)) continue;
    const auto found = known.find(robot.start.name);
    RosRobot* its = found == known.end() ? nullptr : found->second;
    const bool is_new = its == nullptr;
    if (is_new) {
      if (!std::exchange(has_new, true) && is_other_run_) experiment_ = options_.experiment();
      its = show(robot);
    }
    if (its == nullptr) continue;
    robot_of_id_[robot.start.robot] = its;
    if (is_new || !goes_on(robot)) its->begin(lease.tick * lease.step);
  }
  if (has_new) {
    announce();
    graph_has_changed_ = true;  // for these robots: nodes may have been there before them
  }
  step_ = lease.step;
  is_first_frame_ = true;
  if (true_poses_) true_poses_->forget();
}

// Claims robots that services have added, for nodes to drive them.
void RosBridge::take_entity_changes(Client& client) {
  std::vector<std::variant<SpawnedRobot, std::string>> changes;
  {
    const std::lock_guard lock(entity_changes_mutex_);
    changes.swap(entity_changes_);
  }
  if (changes.empty()) return;
  for (const auto& change : changes) {
    if (const auto* robot = std::get_if<SpawnedRobot>(&change)) {
      deleted_.erase(robot->name);
      spawned_.insert_or_assign(robot->name, Spawned{robot->model, robot->is_driven, false});
    } else {
      const std::string& entity = std::get<std::string>(change);
      const bool was_shown = remove_robot(entity);
      if (spawned_.erase(entity) > 0 || was_shown) deleted_.insert(entity);
    }
  }
  if (is_announced_) announce();
  client.claim(selectors());
}

std::vector<std::string> RosBridge::selectors() const {
  std::vector<std::string> all = options_.client.robots;
  for (const auto& [name, robot] : spawned_) all.push_back(name);
  return all;
}

bool RosBridge::is_shown(const DrivenRobot& robot) const {
  const auto found = spawned_.find(robot.start.name);
  return !deleted_.contains(robot.start.name) && (found == spawned_.end() || found->second.is_driven);
}

// Adds a robot with its topics, and returns it. If a robot that was added during the run cannot have topics, returns
// null: it stands still, and the run goes on.
RosRobot* RosBridge::show(const DrivenRobot& robot) {
  try {
    const description::Model* const model = model_of(robot);
    if (model == nullptr)
      throw std::runtime_error("the experiment has no model '" + robot.start.model + "', the model of robot " +
                               robot.start.name);
    add_robot(robot, *model);
    return robots_.back().get();
  } catch (const std::runtime_error& error) {
    if (is_of_experiment(robot.start.name)) throw;
    options_.tell("robot " + robot.start.name + " has no topics and stands still: " + error.what());
    return nullptr;
  }
}

bool RosBridge::is_of_experiment(const std::string& robot) const {
  return std::ranges::find(experiment_->world.instances, robot, &description::Instance::name) !=
         experiment_->world.instances.end();
}

// Returns null if the model is not known.
const description::Model* RosBridge::model_of(const DrivenRobot& robot) const {
  if (const auto found = spawned_.find(robot.start.name); found != spawned_.end() && found->second.model)
    return &found->second.model->model;
  const auto& models = experiment_->world.models;
  const auto model = std::ranges::find(models, robot.start.model, &description::Model::name);
  return model == models.end() ? nullptr : &*model;
}

void RosBridge::add_robot(const DrivenRobot& robot, const description::Model& model) {
  RosRobot::Options options;
  options.settings = experiment_->ros2.of_team(robot.start.team);
  if (!is_of_experiment(robot.start.name)) options.settings = in_own_namespace(std::move(options.settings));
  options.settings.sync = options_.sync.value_or(options.settings.sync);
  if (!options_.command.empty()) options.settings.sync = RosSync::idle;
  if (options.settings.sync == RosSync::idle && options_.command.empty())
    throw std::runtime_error("robot " + robot.start.name +
                             " has 'sync: idle', which requires --run COMMAND: the bridge must start its nodes");
  if (options.settings.name_space.empty()) options.settings.name_space = absolute_name(robot.start.name);
  options.first_input = robot_of_input_.size();
  options.tell = [this, name = robot.start.name](const std::string& text) {
    options_.tell("robot " + name + ": " + text);
  };
  // DDS tells of an endpoint before it is matched, and the graph has said so by then.
  options.changed = [this] { note_change(); };
  robots_.push_back(std::make_unique<RosRobot>(participant_, graph_, inbox_, model, robot, std::move(options)));
  robot_of_input_.resize(robot_of_input_.size() + robots_.back()->inputs(), robots_.back().get());
}

// Returns whether the robot had topics.
bool RosBridge::remove_robot(const std::string& name) {
  const auto found = std::ranges::find(robots_, name, [](const auto& each) { return each->name(); });
  if (found == robots_.end()) return false;
  RosRobot* const robot = found->get();
  std::ranges::replace(robot_of_input_, robot, nullptr);
  std::erase_if(robot_of_id_, [&](const auto& each) { return each.second == robot; });
  robots_.erase(found);
  return true;
}

}  // namespace cohort::ros2
