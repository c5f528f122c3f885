#include "tools/figures/stand.hpp"

#include <algorithm>
#include <stdexcept>

namespace cohort::figures {

using namespace description;

Pose at(double x, double y, double z, double yaw) {
  return {{x, y, z}, Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))};
}

Pose leaning(double pitch) {
  return {{0.0, 0.0, 1.0}, Eigen::Quaterniond(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()))};
}

Inertial solid_cylinder(double mass, double radius, double length, double z) {
  const double across = mass * (3.0 * radius * radius + length * length) / 12.0;
  Inertial inertial;
  inertial.mass = mass;
  inertial.X_LI.position.z() = z;
  inertial.inertia = Eigen::Vector3d(across, across, 0.5 * mass * radius * radius).asDiagonal();
  return inertial;
}

Model tracked_robot() {
  Model model;
  model.name = "robot";
  model.links.push_back({"chassis",
                         {},
                         solid_cylinder(0.4, 0.05, 0.05, 0.033),
                         {{"hull", {{0, 0, 0.034}}, Cylinder{0.05, 0.04}, {0.3, 0}}}});
  model.links.push_back({"turret",
                         {{0, 0, turret_height}},
                         solid_cylinder(0.3, turret_radius, 0.04, 0.02),
                         {{"shell", {{0, 0, 0.02}}, Cylinder{turret_radius, 0.04}, {0.3, 0}}}});
  Joint joint;
  joint.name = "turret_joint";
  joint.type = JointType::revolute;
  joint.parent = chassis;
  joint.child = turret;
  model.joints.push_back(joint);
  model.devices.push_back(TreelDrive{"treel", chassis, 0.04, 0.04, 0.0, 0.022, 0.02, 0.2, 0.8});
  return model;
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

Model static_shape(const Shape& shape) {
  Model model;
  model.name = "static";
  model.is_static = true;
  model.links.push_back({"link", {}, {}, {{"collision", {}, shape, {}}}});
  return model;
}

Stand::Stand() {
  experiment_.world.name = "stand";
  experiment_.duration = std::chrono::hours(1);
  add(static_shape(Plane{}));
}

std::uint32_t Stand::add(const Model& model, const Pose& X_WM) {
  World& world = experiment_.world;
  const auto object = static_cast<std::uint32_t>(world.instances.size());
  if (model.is_robot()) world.robots.push_back(object);
  world.instances.push_back({model.name + "_" + std::to_string(object), world.models.size(), X_WM});
  world.models.push_back(model);
  return object;
}

void Stand::add_emitter(const decltype(Emitter::what)& what, const Pose& X_WM) {
  Model model;
  model.name = "emitter";
  model.is_static = true;
  model.links.push_back({"link", {}, {}, {}});
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
