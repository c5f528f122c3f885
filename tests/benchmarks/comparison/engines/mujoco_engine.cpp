// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "tests/benchmarks/comparison/engines/engines.hpp"
#include "tests/benchmarks/comparison/engines/mujoco_model.hpp"

namespace cohort::bench {
namespace {

// Debian's MuJoCo 2.2 has dense matrices, newer versions sparse ones.
constexpr bool is_dense = mjVERSION_HEADER < 300;
constexpr std::size_t most_robots = is_dense ? 512 : 2000;

// Constraint rows for each robot: two wheels and a caster on the ground need 9, a contact of two robots 4 and more. The
// size of dense matrices is counted in 32 bits, which leaves little reserve in a crowd. A few robots get some more.
constexpr std::size_t contacts_a_robot = 10;
constexpr std::size_t rows_a_robot = 18;
constexpr std::size_t rows_a_connection = 6;
constexpr std::size_t freedoms_a_robot = 9;

// Bits of geoms: a pair collides if the type of one is in the affinity of the other.
constexpr int shell = 1;  // hulls, turrets and walls
constexpr int wheel = 2;

// MuJoCo numbers bodies in the order of the model: the world, then chassis, wheels and turret of each robot.
constexpr int bodies_a_robot = 4;
constexpr int turret_body = 4;  // turret of the first robot

using Output = std::back_insert_iterator<std::string>;

std::string inertial_xml(const CylinderBody& body, double z) {
  const double across = body.mass * (3.0 * body.radius * body.radius + body.height * body.height) / 12.0;
  const double along = body.mass * body.radius * body.radius / 2.0;
  return fmt::format(R"(<inertial pos="0 0 {}" mass="{}" diaginertia="{} {} {}"/>)", z, body.mass, across, across,
                     along);
}

// Returns the damping of a velocity motor with bounded torque that MuJoCo integrates stably in steps of 10 ms: torque =
// damping * (commanded velocity - velocity). The integrator treats damping implicitly. The maximum torque is reached
// when a robot that is commanded its maximum speed is held.
double damping(double max_torque, double max_velocity) { return max_torque / max_velocity; }

class ModelText {
 public:
  explicit ModelText(const Scene& scene) : scene_(scene), out_(text_) {}

  std::string write() {
    const std::size_t robots = scene_.robots.size();
    text_ += R"(<mujoco><compiler angle="radian"/>)";
    is_dense ? add_dense_sizes() : add_sparse_sizes();
    fmt::format_to(out_, R"(<option timestep="{}" gravity="0 0 {}"/><worldbody>)", scene_.step, -scene_.gravity);
    // The larger friction and the larger dimension of a pair are used.
    fmt::format_to(out_, R"(<geom type="plane" size="0 0 1" friction="0" condim="1" contype="0" conaffinity="{}"/>)",
                   shell | wheel);
    for (const Wall& wall : scene_.walls()) add_wall(wall);
    for (std::size_t i = 0; i < robots; ++i) add_robot(i);
    text_ += "</worldbody>";
    if (scene_.connected) add_connections();
    text_ += "<actuator>";
    for (std::size_t i = 0; i < robots; ++i) add_motors(i);
    text_ += "</actuator></mujoco>";
    return text_;
  }

 private:
  // Two to four times the measured need of robots; by default, MuJoCo requests 14 GB for 2000 of them.
  void add_sparse_sizes() {
    const std::size_t robots = scene_.robots.size();
    fmt::format_to(out_, R"(<size memory="{}"/>)", 100 * robots * robots + 64'000 * robots + 1'000'000);
  }

  void add_dense_sizes() {
    const std::size_t robots = scene_.robots.size();
    const std::size_t rows = rows_a_robot * robots + (scene_.connected ? rows_a_connection * robots : 0) + 100;
    const std::size_t freedoms = freedoms_a_robot * robots;
    fmt::format_to(out_, R"(<size njmax="{}" nconmax="{}" nstack="{}"/>)", rows, contacts_a_robot * robots + 100,
                   2 * freedoms * freedoms + 3 * rows * freedoms + 100'000);
  }

  void add_wall(const Wall& wall) {
    fmt::format_to(out_,
                   R"(<geom type="box" pos="{} {} {}" size="{} {} {}" friction="{}" contype="0" conaffinity="{}"/>)",
                   wall.centre.x(), wall.centre.y(), wall.centre.z(), 0.5 * wall.size.x(), 0.5 * wall.size.y(),
                   0.5 * wall.size.z(), scene_.robot.friction, shell);
  }

  void add_cylinder(double radius, double height, double z) {
    fmt::format_to(out_,
                   R"(<geom type="cylinder" pos="0 0 {}" size="{} {}" friction="{}" contype="{}" conaffinity="{}"/>)",
                   z, radius, 0.5 * height, scene_.robot.friction, shell, shell);
  }

  void add_wheel(const char* side, std::size_t i, double y) {
    const Robot& robot = scene_.robot;
    fmt::format_to(out_, R"(<body pos="0 {} {}"><joint name="{}{}" axis="0 1 0" damping="{}"/>)", y, robot.wheel_radius,
                   side, i, damping(robot.max_torque, robot.max_speed / robot.wheel_radius));
    fmt::format_to(out_,
                   R"(<geom type="sphere" size="{}" mass="{}" friction="{}" contype="{}" conaffinity="0"/></body>)",
                   robot.wheel_radius, robot.wheel_mass, robot.track_friction, wheel);
  }

  void add_robot(std::size_t i) {
    const Robot& robot = scene_.robot;
    const Placement& at = scene_.robots[i];
    const CylinderBody chassis = robot.chassis_without_wheels();
    fmt::format_to(out_, R"(<body pos="{} {} 0" euler="0 0 {}"><freejoint/>)", at.x, at.y, at.yaw);
    text_ += inertial_xml(chassis, chassis.z);
    add_cylinder(robot.hull_radius, robot.hull_height, robot.hull_z);
    for (const double x : {-robot.caster_x, robot.caster_x})
      fmt::format_to(
          out_, R"(<geom type="sphere" pos="{} 0 {}" size="{}" friction="0" condim="1" contype="{}" conaffinity="0"/>)",
          x, robot.caster_radius + robot.caster_clearance, robot.caster_radius, wheel);
    add_wheel("left", i, robot.half_gauge);
    add_wheel("right", i, -robot.half_gauge);
    fmt::format_to(out_, R"(<body name="turret{}" pos="0 0 {}"><joint name="turret{}" axis="0 0 1" damping="{}"/>)", i,
                   robot.turret_joint_height, i, damping(robot.max_turret_torque, robot.max_turret_rate));
    text_ += inertial_xml(robot.turret, robot.turret.z - robot.turret_joint_height);
    add_cylinder(robot.turret.radius, robot.turret.height, robot.turret.z - robot.turret_joint_height);
    text_ += "</body></body>";
  }

  void add_connections() {
    text_ += "<equality>";
    for (std::size_t i = 1; i < scene_.robots.size(); ++i)
      fmt::format_to(out_, R"(<weld body1="turret{}" body2="turret{}"/>)", i - 1, i);
    text_ += "</equality>";
  }

  // Adds motors in the order of mjData::ctrl.
  void add_motors(std::size_t i) {
    const Robot& robot = scene_.robot;
    for (const char* side : {"left", "right"})
      fmt::format_to(out_, R"(<motor joint="{}{}" gear="{}"/>)", side, i,
                     damping(robot.max_torque, robot.max_speed / robot.wheel_radius));
    fmt::format_to(out_, R"(<motor joint="turret{}" gear="{}"/>)", i,
                   damping(robot.max_turret_torque, robot.max_turret_rate));
  }

  const Scene& scene_;
  std::string text_;
  Output out_;
};

class MujocoEngine final : public Engine {
 public:
  explicit MujocoEngine(const Scene& scene) : wheel_radius_(scene.robot.wheel_radius) {
    model_ = compile_mujoco(ModelText(scene).write());
    data_.reset(mj_makeData(model_.get()));
    mj_kinematics(model_.get(), data_.get());  // positions at tick 0
  }

  void set_command(std::uint32_t robot, const Command& command) override {
    mjtNum* control = data_->ctrl + std::size_t{3} * robot;
    control[0] = command.left / wheel_radius_;
    control[1] = command.right / wheel_radius_;
    control[2] = command.turret;
  }

  void step() override { step_mujoco(*model_, *data_); }

  Eigen::Vector3d turret_centre(std::uint32_t robot) const override {
    const mjtNum* position =
        data_->xipos + std::ptrdiff_t{3} * (turret_body + bodies_a_robot * static_cast<int>(robot));
    return {position[0], position[1], position[2]};
  }

  std::vector<Touch> touches() const override {
    std::vector<Touch> touches;
    for (int i = 0; i < data_->ncon; ++i) {
      const mjContact& contact = data_->contact[i];
      if (contact.dist > 0.0) continue;
      if (model_->geom_type[contact.geom1] == mjGEOM_PLANE || model_->geom_type[contact.geom2] == mjGEOM_PLANE)
        continue;
      const std::uint32_t a = robot_of(contact.geom1);
      const std::uint32_t b = robot_of(contact.geom2);
      touches.push_back({std::min(a, b), std::max(a, b)});  // a wall has the larger index
    }
    return touches;
  }

 private:
  std::uint32_t robot_of(int geom) const {
    const int body = model_->geom_bodyid[geom];
    return body == 0 ? Touch::wall : static_cast<std::uint32_t>((body - 1) / bodies_a_robot);
  }

  double wheel_radius_;
  MujocoModel model_;
  MujocoData data_;
};

}  // namespace

std::string mujoco_version() { return mj_versionString(); }

std::optional<std::string> mujoco_limitation(const Scene& scene) {
  if (scene.robots.size() > most_robots)
    return fmt::format(is_dense ? "its matrices are dense and become too large for more than {} robots"
                                : "reading a model of more than {} robots takes minutes",
                       most_robots);
  return std::nullopt;
}

std::unique_ptr<Engine> make_mujoco_engine(const Scene& scene) { return std::make_unique<MujocoEngine>(scene); }

}  // namespace cohort::bench
