// SPDX-License-Identifier: Apache-2.0

// Robots drawn at random: mirror-symmetric, with held joints, and dropped on their feet.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "server/core/random.hpp"
#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Dynamics;
using Eigen::Vector3d;

constexpr int robots_at_each_step = 125;

struct RandomRobot {
  description::Model model;
  double size = 0.0;              // length of the trunk [m]
  double height = 0.0;            // the trunk's centre above the lowest foot [m]
  double friction = 0.0;          // the floor's
  std::vector<std::size_t> feet;  // links, each with its foot as the only collision, at the origin
};

// Draws the numbers of one robot.
class Draws {
 public:
  explicit Draws(int robot) : robot_(static_cast<std::uint64_t>(robot)) {}

  double between(double least, double most) { return least + (most - least) * random_.uniform(robot_, draw_++); }
  /// With equal chances for each order of magnitude.
  double spread(double least, double most) { return least * std::pow(most / least, between(0.0, 1.0)); }
  int whole(int least, int most) { return static_cast<int>(between(least, most + 1)); }

 private:
  RandomStream random_{7, "random_robots", "model"};
  std::uint64_t robot_;
  std::uint32_t draw_ = 0;
};

struct LimbPart {
  Vector3d along;  // from its joint to its end, on the left side
  Vector3d axis;
};

// Adds a limb with held hinges, whose first joint is on the trunk. Returns its last link.
std::size_t add_limb(RandomRobot& robot, const std::vector<LimbPart>& parts, const Vector3d& first_joint, double side,
                     double link_mass) {
  description::Model& model = robot.model;
  Vector3d end = first_joint;
  std::size_t parent = 0;
  for (const LimbPart& part : parts) {
    const Vector3d along = part.along.cwiseProduct(Vector3d(1.0, side, 1.0));
    end += along;
    const std::string name = std::to_string(model.links.size());
    description::Inertial inertial = solid_box(link_mass, Vector3d::Constant(0.1 * robot.size) + along.cwiseAbs());
    inertial.X_LI.position = -0.5 * along;
    model.links.push_back({"link" + name, {end}, inertial, {}});
    const std::size_t link = model.links.size() - 1;
    model.joints.push_back(joint_of("joint" + name, description::JointType::revolute, parent, link, part.axis, -along));
    const double strength = 1e3 * model.links[0].inertial.mass * robot.size;  // 100 times its weight at its length
    model.devices.push_back(description::VelocityMotor{"motor" + name, model.joints.size() - 1, 10.0, strength});
    parent = link;
  }
  return parent;
}

// A trunk from 3 cm to 1 m long, from 100 to 5000 kg/m^3, with two to four pairs of limbs. Each has one to three links
// on hinges with axes along x, y or z, held by strong motors, and ends in a ball, a box or an upright cylinder. A link
// has from a thousandth to a third of the trunk's mass.
RandomRobot random_robot(int index) {
  Draws draws(index);
  RandomRobot robot;
  robot.size = draws.spread(0.03, 1.0);
  robot.friction = draws.between(0.3, 1.2);
  const Vector3d trunk = robot.size * Vector3d(1.0, draws.between(0.3, 0.9), draws.between(0.1, 0.4));
  const double mass = draws.spread(100.0, 5000.0) * trunk.prod();
  const double link_mass = draws.spread(1e-3, 0.3) * mass;
  robot.model = loose("robot", description::Box{trunk}, solid_box(mass, trunk));
  const int pairs = draws.whole(2, 4);
  for (int pair = 0; pair < pairs; ++pair) {
    const double half = 0.06 * robot.size * draws.between(0.5, 1.5);  // height of a foot
    const description::Shape feet[] = {description::Sphere{half}, description::Box{Vector3d(3.0, 2.0, 2.0) * half},
                                       description::Cylinder{half, 2.0 * half}};
    const description::Shape& foot = feet[draws.whole(0, 2)];
    const double x = robot.size * (0.5 - pair / (pairs - 1.0)) * draws.between(0.7, 1.0);
    const int count = draws.whole(1, 3);
    std::vector<LimbPart> parts;
    double depth = half;
    for (int part = 0; part < count; ++part) {
      const double down = draws.between(0.25, 0.45) / count;
      depth += robot.size * down;
      parts.push_back({robot.size * Vector3d(draws.between(-0.15, 0.15), draws.between(0.02, 0.2), -down),
                       Vector3d::Unit(draws.whole(0, 2))});
    }
    robot.height = std::max(robot.height, depth);
    for (const double side : {1.0, -1.0}) {
      robot.feet.push_back(add_limb(robot, parts, {x, side * 0.5 * trunk.y(), 0.0}, side, link_mass));
      robot.model.links.back().collisions.push_back({"foot", {}, foot, {1.0, 0.0}});
    }
  }
  return robot;
}

// Returns how far a shape reaches down from its centre.
double reach_down(const description::Shape& shape, const Eigen::Quaterniond& orientation) {
  const Vector3d down = orientation.conjugate() * Vector3d::UnitZ();
  if (const auto* box = std::get_if<description::Box>(&shape)) return 0.5 * box->size.dot(down.cwiseAbs());
  if (const auto* cylinder = std::get_if<description::Cylinder>(&shape))
    return 0.5 * cylinder->length * std::abs(down.z()) + cylinder->radius * down.head<2>().norm();
  return std::get<description::Sphere>(shape).radius;
}

using StepAndDynamics = std::tuple<int, Dynamics>;
class RandomRobots : public ::testing::TestWithParam<StepAndDynamics> {};
std::string name_of_both(const ::testing::TestParamInfo<StepAndDynamics>& tested) {
  return std::to_string(std::get<0>(tested.param)) +
         (std::get<1>(tested.param) == Dynamics::bullet ? "ms_bullet" : "ms");
}
INSTANTIATE_TEST_SUITE_P(At, RandomRobots,
                         ::testing::Combine(::testing::Values(10, 2),
                                            ::testing::Values(Dynamics::cohort, Dynamics::bullet)),
                         name_of_both);

TEST_P(RandomRobots, StandStillInTheirPlaneOfSymmetryOnFeetThatDoNotSinkIn) {
  physics::Convergence all;
  for (int index = 0; index < robots_at_each_step; ++index) {
    SCOPED_TRACE("robot " + std::to_string(index));
    const RandomRobot robot = random_robot(index);
    description::World world = world_with_floor(robot.friction);
    world.step = std::chrono::milliseconds(std::get<0>(GetParam()));
    world.physics.dynamics = std::get<1>(GetParam());
    world.physics.fidelity = description::Fidelity::articulated;
    SmallWorld small(world);
    const BodyId body = small.add(robot.model, at(0, 0, robot.height + 0.01 * robot.size));
    small.run(6.0);
    EXPECT_TRUE(small.world().is_asleep(body)) << small.velocity(body).norm() << " m/s";
    EXPECT_NEAR(small.position(body).y(), 0.0, 1e-4 * robot.size);
    double lowest = robot.size;
    for (const std::size_t foot : robot.feet) {
      const Pose X_WL = small.world().link_pose(body, LinkId{foot});
      const description::Shape& shape = robot.model.links[foot].collisions[0].shape;
      lowest = std::min(lowest, X_WL.position.z() - reach_down(shape, X_WL.orientation));
    }
    EXPECT_GT(lowest, -1e-4 * robot.size);
    const physics::Convergence& its = small.world().convergence();
    all.solved += its.solved;
    all.unconverged += its.unconverged;
    all.worst = std::max(all.worst, its.worst);
  }
  // While they land. The bounds were set after 0.7 % and 1.5e-3 were measured.
  EXPECT_LT(static_cast<double>(all.unconverged), 0.01 * static_cast<double>(all.solved));
  EXPECT_LT(all.worst, 1e-2);
}

}  // namespace
}  // namespace cohort::test
