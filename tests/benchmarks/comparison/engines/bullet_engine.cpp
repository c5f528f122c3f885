// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "tests/benchmarks/comparison/engines/bullet_world.hpp"
#include "tests/benchmarks/comparison/engines/engines.hpp"

namespace cohort::bench {
namespace {

constexpr std::size_t most_robots_in_bullet = 2000;
constexpr double unbreakable = 1e3;  // impulse limit of a connection per step, far above the pull of robots [N s]

// Wheels and casters collide with the ground only.
constexpr int ground_group = 1;
constexpr int wall_group = 2;
constexpr int turret_group = 4;
constexpr int wheel_group = 8;
constexpr BulletFilter ground_filter{ground_group, wheel_group | turret_group};
constexpr BulletFilter wall_filter{wall_group, turret_group};
constexpr BulletFilter turret_filter{turret_group, ground_group | wall_group | turret_group};
constexpr BulletFilter wheel_filter{wheel_group, ground_group};

btVector3 moments_of(const CylinderBody& body) {
  const double across = body.mass * (3.0 * body.radius * body.radius + body.height * body.height) / 12.0;
  return {across, across, body.mass * body.radius * body.radius / 2.0};
}

class BulletEngine final : public Engine {
 public:
  explicit BulletEngine(const Scene& scene)
      : robot_(scene.robot), step_(scene.step), world_(Eigen::Vector3d(0.0, 0.0, -scene.gravity), scene.step) {
    ground_ = &world_.add_static(world_.add_shape<btStaticPlaneShape>(btVector3(0, 0, 1), 0.0), {0, 0, 0},
                                 scene.ground_friction, ground_filter);
    for (const Wall& wall : scene.walls()) add_wall(wall);
    add_shapes();
    for (const Placement& placement : scene.robots) add_robot(placement);
    if (scene.connected)
      for (std::size_t i = 1; i < robots_.size(); ++i) connect(*robots_[i - 1].body, *robots_[i].body);
  }

  void set_command(std::uint32_t robot, const Command& command) override {
    const BulletRobot& motors = robots_[robot];
    motors.left->setVelocityTarget(command.left / robot_.wheel_radius);
    motors.right->setVelocityTarget(command.right / robot_.wheel_radius);
    motors.turret->setVelocityTarget(command.turret);
  }

  void step() override { world_.step(); }

  Eigen::Vector3d turret_centre(std::uint32_t robot) const override {
    const btVector3 centre_W = robots_[robot].body->localPosToWorld(turret_link, {0, 0, 0});
    return {centre_W.x(), centre_W.y(), centre_W.z()};
  }

  std::vector<Touch> touches() const override {
    std::vector<Touch> touches;
    for (int pair = 0; pair < world_.dispatcher().getNumManifolds(); ++pair) {
      const btPersistentManifold& points = *world_.dispatcher().getManifoldByIndexInternal(pair);
      if (points.getBody0() == ground_ || points.getBody1() == ground_) continue;
      for (int i = 0; i < points.getNumContacts(); ++i) {
        if (points.getContactPoint(i).getDistance() > 0.0) continue;
        const auto [robot, other] = std::minmax({index_of(*points.getBody0()), index_of(*points.getBody1())});
        touches.push_back({robot, other});  // a wall has the larger index
      }
    }
    return touches;
  }

 private:
  // Links of a robot, whose base is the chassis.
  static constexpr int left_wheel = 0;
  static constexpr int right_wheel = 1;
  static constexpr int turret_link = 2;
  static constexpr int links_of_robot = 3;

  struct BulletRobot {
    btMultiBody* body = nullptr;
    btMultiBodyJointMotor* left = nullptr;
    btMultiBodyJointMotor* right = nullptr;
    btMultiBodyJointMotor* turret = nullptr;
  };

  // Returns the robot's index, or Touch::wall, because Bullet's default is -1.
  static std::uint32_t index_of(const btCollisionObject& collider) {
    return static_cast<std::uint32_t>(collider.getUserIndex());
  }

  void add_wall(const Wall& wall) {
    const Eigen::Vector3d half = 0.5 * wall.size;
    world_.add_static(world_.add_shape<btBoxShape>(btVector3(half.x(), half.y(), half.z())),
                      {wall.centre.x(), wall.centre.y(), wall.centre.z()}, each_of_two(robot_.friction), wall_filter);
  }

  // A collider of a link has one friction and one filter. The chassis therefore has its casters but not its hull, which
  // is below the turret.
  void add_shapes() {
    casters_ = &world_.add_shape<btCompoundShape>();
    auto& ball = world_.add_shape<btSphereShape>(robot_.caster_radius);
    for (const double x : {-robot_.caster_x, robot_.caster_x})
      casters_->addChildShape(btTransform(btQuaternion::getIdentity(),
                                          {x, 0.0, robot_.caster_radius + robot_.caster_clearance - chassis_.z}),
                              &ball);
    wheel_ = &world_.add_shape<btSphereShape>(robot_.wheel_radius);
    turret_ = &world_.add_shape<btCylinderShapeZ>(
        btVector3(robot_.turret.radius, robot_.turret.radius, 0.5 * robot_.turret.height));
  }

  void set_up_wheel(btMultiBody& body, int link, double y) const {
    const double moment = 0.4 * robot_.wheel_mass * robot_.wheel_radius * robot_.wheel_radius;
    body.setupRevolute(link, robot_.wheel_mass, {moment, moment, moment}, -1, btQuaternion::getIdentity(), {0, 1, 0},
                       {0.0, y, robot_.wheel_radius - chassis_.z}, {0, 0, 0}, true);
  }

  btMultiBodyJointMotor& add_motor(btMultiBody& body, int link, double max_torque) {
    return world_.add_constraint<btMultiBodyJointMotor>(&body, link, 0.0, max_torque * step_);
  }

  void add_robot(const Placement& at) {
    const btTransform X_WB(btQuaternion({0, 0, 1}, at.yaw), {at.x, at.y, chassis_.z});
    btMultiBody& body = world_.add_body(links_of_robot, chassis_.mass, moments_of(chassis_), X_WB);
    set_up_wheel(body, left_wheel, robot_.half_gauge);
    set_up_wheel(body, right_wheel, -robot_.half_gauge);
    body.setupRevolute(turret_link, robot_.turret.mass, moments_of(robot_.turret), -1, btQuaternion::getIdentity(),
                       {0, 0, 1}, {0.0, 0.0, robot_.turret_joint_height - chassis_.z},
                       {0.0, 0.0, robot_.turret.z - robot_.turret_joint_height}, true);
    world_.finish(body);
    world_.add_link_collider(body, -1, *casters_, 0.0, wheel_filter);
    for (const int wheel : {left_wheel, right_wheel})
      world_.add_link_collider(body, wheel, *wheel_, robot_.track_friction, wheel_filter);
    world_.add_link_collider(body, turret_link, *turret_, each_of_two(robot_.friction), turret_filter)
        .setUserIndex(static_cast<int>(robots_.size()));
    robots_.push_back({&body, &add_motor(body, left_wheel, robot_.max_torque),
                       &add_motor(body, right_wheel, robot_.max_torque),
                       &add_motor(body, turret_link, robot_.max_turret_torque)});
  }

  // Fixes one turret to another in their present poses.
  void connect(btMultiBody& before, btMultiBody& after) {
    const btTransform X_BA = before.getLink(turret_link)
                                 .m_collider->getWorldTransform()
                                 .inverseTimes(after.getLink(turret_link).m_collider->getWorldTransform());
    world_
        .add_constraint<btMultiBodyFixedConstraint>(&before, turret_link, &after, turret_link, X_BA.getOrigin(),
                                                    btVector3(0, 0, 0), X_BA.getBasis(), btMatrix3x3::getIdentity())
        .setMaxAppliedImpulse(unbreakable);
  }

  Robot robot_;
  CylinderBody chassis_ = robot_.chassis_without_wheels();
  double step_;
  BulletWorld world_;
  btCollisionObject* ground_ = nullptr;
  btCompoundShape* casters_ = nullptr;
  btSphereShape* wheel_ = nullptr;
  btCylinderShapeZ* turret_ = nullptr;
  std::vector<BulletRobot> robots_;
};

}  // namespace

std::string bullet_version() { return fmt::format("{}.{}", btGetVersion() / 100, btGetVersion() % 100); }

std::optional<std::string> bullet_limitation(const Scene& scene) {
  if (scene.robots.size() > most_robots_in_bullet)
    return fmt::format("its set-up time grows quadratically: more than {} robots take minutes to start",
                       most_robots_in_bullet);
  return std::nullopt;
}

std::unique_ptr<Engine> make_bullet_engine(const Scene& scene) { return std::make_unique<BulletEngine>(scene); }

}  // namespace cohort::bench
