// SPDX-License-Identifier: Apache-2.0
#include "tests/figures/stand.hpp"

#include <algorithm>
#include <stdexcept>

namespace cohort::figures {

using namespace description;

Pose leaning(double pitch) {
  return {{0.0, 0.0, 1.0}, Eigen::Quaterniond(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()))};
}

void hold(Model& model) {
  Joint joint;
  joint.name = "to_the_world";
  joint.parent = Joint::world;
  model.joints.push_back(joint);
}

Model held_robot() {
  Model model = tracked_robot();
  model.devices.clear();
  hold(model);
  return model;
}

Series measured_at(const std::vector<double>& places, const std::function<double(double)>& measure,
                   std::function<double(double)> closed_form, double tolerance, std::string name) {
  Series series{std::move(name), {}, std::move(closed_form), tolerance};
  for (const double place : places) series.measured.emplace_back(place, measure(place));
  return series;
}

Stand::Stand() {
  experiment_.world.name = "stand";
  experiment_.duration = std::chrono::hours(1);
  add(static_shape("static", Plane{}));
}

std::uint32_t Stand::add(const Model& model, const Pose& X_WM) {
  World& world = experiment_.world;
  return place(world, model, model.name + "_" + std::to_string(world.instances.size()), X_WM);
}

void Stand::add_emitter(const decltype(Emitter::what)& what, const Pose& X_WM) {
  Model model = static_model("emitter");
  model.emitters.push_back({"emitter", 0, {}, true, what});
  add(model, X_WM);
}

Simulation& Stand::simulation() {
  if (!simulation_) {
    Team team{"team", {}, "none", {}};
    for (std::uint32_t robot = 0; robot < experiment_.world.robots.size(); ++robot) team.robots.push_back(robot);
    experiment_.teams = {team};
    simulation_.emplace(experiment_, 1);
  }
  return *simulation_;
}

void Stand::step(int ticks) {
  for (; ticks > 0; --ticks) simulation().step();
}

double Stand::time() { return std::chrono::duration<double>(simulation().time()).count(); }

double Stand::read(const std::string& channel, std::size_t index, std::uint32_t robot) {
  const RobotKind& kind = simulation().kinds()[simulation().kind_of(robot)];
  return simulation().observation(robot)[offset_of(kind.observation, channel) + index];
}

void Stand::command(const std::string& channel, const std::vector<double>& values, std::uint32_t robot) {
  const RobotKind& kind = simulation().kinds()[simulation().kind_of(robot)];
  commands_.resize(simulation().robot_count());
  std::vector<double>& command = commands_[robot];
  if (command.empty())
    for (const Channel& each : kind.command) command.insert(command.end(), each.size, each.neutral);
  std::ranges::copy(values, command.begin() + static_cast<std::ptrdiff_t>(offset_of(kind.command, channel)));
  simulation().set_command(robot, command);
}

std::size_t Stand::offset_of(const std::vector<Channel>& channels, const std::string& name) {
  std::size_t offset = 0;
  for (const Channel& channel : channels) {
    if (channel.name == name) return offset;
    offset += channel.size;
  }
  throw std::invalid_argument("no channel " + name);
}

}  // namespace cohort::figures
