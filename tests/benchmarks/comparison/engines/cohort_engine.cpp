// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "server/physics/make_world.hpp"
#include "tests/benchmarks/comparison/engines/cohort_scene.hpp"
#include "tests/benchmarks/comparison/engines/engines.hpp"

namespace cohort::bench {
namespace {

class CohortEngine final : public Engine {
 public:
  CohortEngine(const Scene& scene, unsigned threads, description::Dynamics dynamics)
      : robot_(scene.robot),
        drive_(scene.drive),
        description_(describe(scene, dynamics)),
        first_robot_(static_cast<std::uint32_t>(description_.robots.front())),
        workers_(threads),
        world_(physics::make_world(description_, workers_)) {
    if (!scene.connected) return;
    const Pose X_LP{{0.5 * scene.connection_length, 0.0, robot_.turret.z - robot_.turret_joint_height}};
    constexpr LinkId turret{turret_link};
    for (std::uint32_t body = first_robot_ + 1; body < world_->body_count(); ++body)
      world_->connections().connect({BodyId{body}, turret}, X_LP, {BodyId{body - 1}, turret});
  }

  void set_command(std::uint32_t robot, const Command& command) override {
    using Target = physics::JointTarget;
    const BodyId body{first_robot_ + robot};
    if (drive_ == Drive::wheels) {
      world_->set_joint_target(body, JointId{left_wheel_joint}, Target::velocity(command.left / robot_.wheel_radius));
      world_->set_joint_target(body, JointId{right_wheel_joint}, Target::velocity(command.right / robot_.wheel_radius));
    } else {
      world_->set_device_target(body, DeviceId{treel_drive}, 0, command.left);
      world_->set_device_target(body, DeviceId{treel_drive}, 1, command.right);
    }
    world_->set_joint_target(body, JointId{turret_joint}, Target::velocity(command.turret));
  }

  void step() override { world_->step(); }

  Eigen::Vector3d turret_centre(std::uint32_t robot) const override {
    const Eigen::Vector3d centre_L(0.0, 0.0, robot_.turret.z - robot_.turret_joint_height);
    return world_->link_pose(BodyId{first_robot_ + robot}, LinkId{turret_link}) * centre_L;
  }

  std::vector<Touch> touches() const override {
    std::vector<Touch> touches;
    for (const physics::Contact& contact : world_->contacts()) {
      const auto [low, high] = std::minmax(contact.body_a.value, contact.body_b.value);  // static bodies come first
      if (low == ground) continue;
      touches.push_back({high - first_robot_, low < first_robot_ ? Touch::wall : low - first_robot_});
    }
    return touches;
  }

 private:
  static constexpr std::uint32_t ground = 0;

  Robot robot_;
  Drive drive_;
  description::World description_;
  std::uint32_t first_robot_;
  WorkerPool workers_;
  std::unique_ptr<physics::World> world_;
};

}  // namespace

std::unique_ptr<Engine> make_cohort_engine(const Scene& scene, unsigned threads, description::Dynamics dynamics) {
  return std::make_unique<CohortEngine>(scene, threads, dynamics);
}

}  // namespace cohort::bench
