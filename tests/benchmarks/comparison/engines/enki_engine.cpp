// SPDX-License-Identifier: Apache-2.0
#include <enki/PhysicalEngine.h>
#include <enki/robots/DifferentialWheeled.h>

#include "tests/benchmarks/comparison/engines/engines.hpp"

namespace cohort::bench {
namespace {

// Enki uses centimetres, and arbitrary units of mass.
constexpr double centimetres = 100.0;
constexpr double no_noise = 0.0;

class EnkiRobot final : public Enki::DifferentialWheeled {
 public:
  EnkiRobot(std::uint32_t id, const bench::Robot& robot, std::vector<Touch>& touches)
      : DifferentialWheeled(2.0 * robot.half_gauge * centimetres, robot.max_speed * centimetres, no_noise),
        touches_(touches) {
    uid = id;
    const double top = robot.turret.z + 0.5 * robot.turret.height;
    setCylindric(robot.turret.radius * centimetres, top * centimetres, robot.chassis.mass + robot.turret.mass);
    dryFrictionCoefficient = robot.friction;
    collisionElasticity = 0.0;
  }

 protected:
  // Called for both robots of a pair; null means a wall.
  void collisionEvent(Enki::PhysicalObject* other) override {
    if (other == nullptr)
      touches_.push_back({uid, Touch::wall});
    else if (uid < other->uid)
      touches_.push_back({uid, other->uid});
  }

 private:
  std::vector<Touch>& touches_;
};

class EnkiEngine final : public Engine {
 public:
  explicit EnkiEngine(const Scene& scene)
      : step_(scene.step), half_arena_(scene.half_arena.value_or(0.0)), world_(make_world(scene)) {
    for (std::uint32_t i = 0; i < scene.robots.size(); ++i) {
      auto* robot = new EnkiRobot(i, scene.robot, touches_);  // the world deletes it
      robot->pos = Enki::Point(scene.robots[i].x + half_arena_, scene.robots[i].y + half_arena_) * centimetres;
      robot->angle = scene.robots[i].yaw;
      world_->addObject(robot);
      robots_.push_back(robot);
    }
  }

  // Enki has no rotating turret.
  void set_command(std::uint32_t robot, const Command& command) override {
    robots_[robot]->leftSpeed = command.left * centimetres;
    robots_[robot]->rightSpeed = command.right * centimetres;
  }

  void step() override {
    touches_.clear();
    world_->step(step_, 1);
  }

  Eigen::Vector3d turret_centre(std::uint32_t robot) const override {
    const Enki::Point& position = robots_[robot]->pos;
    return {position.x / centimetres - half_arena_, position.y / centimetres - half_arena_, 0.0};
  }

  std::vector<Touch> touches() const override { return touches_; }

 private:
  // Enki's walls begin at the origin.
  static std::unique_ptr<Enki::World> make_world(const Scene& scene) {
    if (!scene.half_arena) return std::make_unique<Enki::World>();
    const double side = 2.0 * *scene.half_arena * centimetres;
    return std::make_unique<Enki::World>(side, side);
  }

  double step_;
  double half_arena_;
  std::vector<Touch> touches_;
  std::unique_ptr<Enki::World> world_;
  std::vector<EnkiRobot*> robots_;
};

}  // namespace

std::unique_ptr<Engine> make_enki_engine(const Scene& scene) { return std::make_unique<EnkiEngine>(scene); }

}  // namespace cohort::bench
