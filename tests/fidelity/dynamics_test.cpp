// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/core/random.hpp"
#include "server/physics/dynamics/equations.hpp"
#include "tests/support/worlds/small_world.hpp"

// Bullet's articulated bodies and Cohort's own mass matrix give the same velocities and the same responses to impulses,
// for any mechanism and state.
namespace cohort::test {
namespace {

using description::Dynamics;
using description::JointType;
using Eigen::Vector3d;

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_(seed, "dynamics", "draws") {}
  double between(double low, double high) { return low + (high - low) * random_.uniform(0, next_++); }
  Vector3d vector(double half_width) {
    return {between(-half_width, half_width), between(-half_width, half_width), between(-half_width, half_width)};
  }
  Eigen::Quaterniond rotation() {
    return Eigen::Quaterniond(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)).normalized();
  }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(between(0.0, static_cast<double>(count))); }

 private:
  RandomStream random_;
  std::uint32_t next_ = 0;
};

// Returns a tree of one to ten links with arbitrary centres and axes; every other tree is fixed to the world.
description::Model random_mechanism(Draws& draws) {
  constexpr JointType types[] = {JointType::revolute, JointType::prismatic, JointType::ball, JointType::universal,
                                 JointType::fixed};
  description::Model model;
  const bool is_free = draws.between(0, 1) < 0.6;
  const std::size_t links = 1 + draws.below(10);
  for (std::size_t i = 0; i < links; ++i) {
    description::Link& link = model.links.emplace_back();
    link.name = "link_" + std::to_string(i);
    link.X_ML = {draws.vector(0.3), draws.rotation()};
    link.inertial.mass = draws.between(0.05, 2.0);
    link.inertial.X_LI = {draws.vector(0.05), draws.rotation()};
    // The inertia of a solid box, so that no principal moment exceeds the sum of the other two.
    const Vector3d squares =
        Vector3d(draws.between(0.02, 0.2), draws.between(0.02, 0.2), draws.between(0.02, 0.2)).cwiseAbs2();
    link.inertial.inertia = (link.inertial.mass / 12.0 *
                             Vector3d(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y()))
                                .asDiagonal();
    if (i == 0 && is_free) continue;
    description::Joint& joint = model.joints.emplace_back();
    joint.name = "joint_" + std::to_string(i);
    joint.type = types[draws.below(std::size(types))];
    joint.parent = i == 0 ? description::Joint::world : draws.below(i);
    joint.child = i;
    joint.X_LJ = {draws.vector(0.1), draws.rotation()};
    for (description::JointAxis* axis : {&joint.axis, &joint.second_axis}) {
      axis->direction = draws.vector(1.0).normalized();
      if (draws.between(0, 1) < 0.5) axis->damping = draws.between(0.0, 0.5);
      if (draws.between(0, 1) < 0.3) axis->spring_stiffness = draws.between(1.0, 1000.0);
      axis->spring_reference = draws.between(-0.5, 0.5);
    }
    const bool turns = joint.type == JointType::revolute || joint.type == JointType::universal;
    if (joint.type == JointType::universal) {
      joint.second_axis.direction = joint.axis.direction.unitOrthogonal();
    } else if (turns && draws.between(0, 1) < 0.5) {
      description::EffortMotor motor;
      motor.name = joint.name + "_motor";
      motor.joint = model.joints.size() - 1;
      motor.rotor_inertia = draws.between(1e-5, 1e-2);
      model.devices.emplace_back(motor);
    }
  }
  return model;
}

void add_masses_of_fluid(Draws& draws, description::Model& model) {
  for (description::Link& link : model.links) {
    if (draws.between(0, 1) < 0.3) continue;
    description::SpatialMatrix root;
    for (double& value : root.reshaped()) value = draws.between(-0.3, 0.3);
    link.inertial.added_mass = std::make_shared<const description::SpatialMatrix>(root * root.transpose());
  }
}

void set_random_state(physics::BodyMotion& body, Draws& draws) {
  if (body.mechanism().has_free_root()) body.set_root_twist({draws.vector(10.0), draws.vector(3.0)});
  for (std::size_t j = 0; j < body.mechanism().model().joints.size(); ++j) {
    const int dofs = body.mechanism().joint(j).dofs;
    std::vector<double> coordinates;
    std::vector<double> velocities;
    for (int i = 0; i < dofs; ++i) {
      coordinates.push_back(draws.between(-1.5, 1.5));
      velocities.push_back(draws.between(-10.0, 10.0));
    }
    if (dofs == 3) {
      const Eigen::Quaterniond rotation = draws.rotation();
      coordinates.assign(rotation.coeffs().data(), rotation.coeffs().data() + 4);
    }
    body.set_joint_state(j, coordinates, velocities);
  }
}

using Numbers = Eigen::Map<const Eigen::VectorXd>;

TEST(Dynamics, BothImplementationsAgreeOnRandomMechanisms) {
  constexpr double most = 1e-10;
  constexpr double step = 0.01;
  const Vector3d gravity(0.3, -0.2, -9.81);
  int mechanisms = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Draws model_draws(seed);
    const description::Model model = random_mechanism(model_draws);
    const physics::Mechanism mechanism(model, description::Fidelity::articulated);
    if (mechanism.dof_count() == 0) continue;
    ++mechanisms;
    const Pose X_WM{model_draws.vector(5.0), model_draws.rotation()};
    physics::BodyMotion bullets(mechanism, Dynamics::bullet, X_WM);
    physics::BodyMotion ours(mechanism, Dynamics::cohort, X_WM);
    physics::Equations of_bullets;
    physics::Equations of_ours;
    for (std::uint64_t state = 0; state < 4; ++state) {
      for (physics::BodyMotion* body : {&bullets, &ours}) {
        Draws draws(1000 * seed + state);
        set_random_state(*body, draws);
      }
      of_bullets.set_up(bullets, gravity, step, false);
      of_ours.set_up(ours, gravity, step, false);
      const Eigen::Index size = of_ours.size();
      const Numbers expected(of_ours.velocity(), size);
      const Numbers before(ours.velocities(), size);
      const double scale = 1.0 + (expected - before).norm();
      EXPECT_LT((Numbers(of_bullets.velocity(), size) - expected).norm(), most * scale);
      EXPECT_EQ(Numbers(bullets.velocities(), size), before) << "the state stays as it is";

      Draws draws(seed);
      for (std::size_t s = 0; s < mechanism.segments().size(); ++s) {
        std::vector<double> jacobian(static_cast<std::size_t>(of_ours.stride()), 0.0);
        std::vector<double> response = jacobian;
        std::vector<double> expected_response = jacobian;
        of_ours.add_force(static_cast<int>(s), X_WM.position + draws.vector(0.5), draws.vector(1.0), jacobian.data());
        of_ours.add_torque(static_cast<int>(s), draws.vector(1.0), jacobian.data());
        of_bullets.respond(jacobian.data(), response.data());
        of_ours.respond(jacobian.data(), expected_response.data());
        const Numbers by_ours(expected_response.data(), size);
        EXPECT_LT((Numbers(response.data(), size) - by_ours).norm(), most * (1e-3 + by_ours.norm()));
      }
    }
  }
  EXPECT_GT(mechanisms, 400);
}

// Returns M + D + h K: the mass matrix, the added inertia, and the derivative of the bias forces.
Eigen::MatrixXd dense_equations(const physics::BodyMotion& body, const std::vector<double>& added_inertia, double h) {
  const Eigen::Index size = body.mechanism().dof_count();
  const auto stride = static_cast<Eigen::Index>(body.mechanism().stride());
  std::vector<physics::Spatial> axes;
  physics::find_joint_axes(body, axes);
  physics::BiasForces bias;
  bias.set_up(body, axes);
  physics::MassMatrix inertia;
  inertia.set_up(body, axes, bias);
  for (int i = 0; i < size; ++i) inertia.add_inertia(i, added_inertia[static_cast<std::size_t>(i)]);
  inertia.factorise();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(stride, stride);
  inertia.add_product(matrix.data());

  const auto bias_at = [&](const Eigen::VectorXd& velocities) {
    Eigen::VectorXd forces(size);
    bias.find(velocities.data(), Vector3d::Zero(), forces.data());
    return forces;
  };
  const Eigen::VectorXd present = Numbers(body.velocities(), size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(size, i);
    matrix.col(i).head(size) += 0.5 * h * (bias_at(present + unit) - bias_at(present - unit));
  }
  return matrix.topLeftCorner(size, size);
}

// Returns how far the recursion is from elimination for some right-hand sides, relative to the solution.
double distance_to_elimination(const physics::BodyMotion& body, Draws& draws, double h) {
  const Eigen::Index size = body.mechanism().dof_count();
  std::vector<double> added_inertia(static_cast<std::size_t>(size));
  for (double& inertia : added_inertia) inertia = draws.between(0, 1) < 0.5 ? draws.between(0.0, 0.01) : 0.0;
  const Eigen::PartialPivLU<Eigen::MatrixXd> dense(dense_equations(body, added_inertia, h));
  physics::ArticulatedBody recursion;
  recursion.set_up(body, added_inertia, h);
  double furthest = 0.0;
  for (int side = 0; side < 3; ++side) {
    Eigen::VectorXd x(size);
    for (double& value : x) value = draws.between(-1.0, 1.0);
    const Eigen::VectorXd expected = dense.solve(x);
    recursion.solve(x.data());
    furthest = std::max(furthest, (x - expected).norm() / expected.norm());
  }
  return furthest;
}

TEST(Dynamics, RecursionAgreesWithEliminationOnRandomMechanisms) {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Draws draws(seed);
    description::Model model = random_mechanism(draws);
    if (seed % 3 == 0) add_masses_of_fluid(draws, model);
    const physics::Mechanism mechanism(model, description::Fidelity::articulated);
    if (mechanism.dof_count() == 0 || mechanism.turns_freely()) continue;
    physics::BodyMotion body(mechanism, Dynamics::cohort, {draws.vector(5.0), draws.rotation()});
    set_random_state(body, draws);
    for (const double h : {0.0, 0.005, 0.05}) EXPECT_LT(distance_to_elimination(body, draws, h), 1e-10);
  }
}

// Returns hanging links of 0.1 m.
description::Model chain_of(std::size_t links, JointType type, bool is_free) {
  description::Model model;
  for (std::size_t i = 0; i < links; ++i) {
    model.links.push_back({"link" + std::to_string(i), at(0, 0, -0.1 * static_cast<double>(i)), {}, {}});
    model.links.back().inertial = solid_box(0.1, Vector3d(0.02, 0.03, 0.1));
    model.links.back().inertial.X_LI.position.z() = -0.05;
    if (i == 0 && is_free) continue;
    const std::size_t parent = i == 0 ? description::Joint::world : i - 1;
    model.joints.push_back(joint_of("joint" + std::to_string(i), type, parent, i, Vector3d::UnitX()));
    model.joints.back().second_axis.direction = Vector3d::UnitY();
  }
  return model;
}

// The rounding errors of elimination itself grow with the length of the chain.
TEST(Dynamics, RecursionAgreesWithEliminationOnALongChain) {
  for (const JointType type : {JointType::ball, JointType::universal})
    for (const bool is_free : {false, true}) {
      SCOPED_TRACE((type == JointType::ball ? "balls" : "universal joints") + std::string(is_free ? ", free" : ""));
      const description::Model model = chain_of(100, type, is_free);
      const physics::Mechanism mechanism(model, description::Fidelity::articulated);
      physics::BodyMotion body(mechanism, Dynamics::cohort, at(1, 2, 3));
      Draws draws(1);
      set_random_state(body, draws);
      for (const double h : {0.0, 0.005}) EXPECT_LT(distance_to_elimination(body, draws, h), 1e-8);
    }
}

TEST(Dynamics, BothImplementationsAgreeOnALongChain) {
  for (const bool is_free : {false, true})
    for (const bool is_fast : {false, true}) {
      SCOPED_TRACE(std::string(is_free ? "free " : "") + (is_fast ? "fast" : "at rest"));
      const description::Model model = chain_of(30, JointType::ball, is_free);
      const physics::Mechanism mechanism(model, description::Fidelity::articulated);
      const Eigen::Index size = mechanism.dof_count();
      const auto stride = static_cast<Eigen::Index>(mechanism.stride());
      Eigen::VectorXd expected_velocity;
      for (const Dynamics dynamics : {Dynamics::cohort, Dynamics::bullet}) {
        physics::BodyMotion body(mechanism, dynamics, at(1, 2, 3));
        Draws draws(1);
        set_random_state(body, draws);
        if (!is_fast) body.stop();
        physics::Equations equations;
        equations.set_up(body, Vector3d(0.3, -0.2, -9.81), 0.01, false);
        ASSERT_EQ(equations.is_symmetric(), !is_fast);
        const Numbers velocity(equations.velocity(), size);
        if (dynamics == Dynamics::cohort) expected_velocity = velocity;
        EXPECT_LT((velocity - expected_velocity).norm(), 1e-8 * expected_velocity.norm());
        if (is_fast) continue;
        Eigen::MatrixXd inertia = Eigen::MatrixXd::Zero(stride, stride);
        equations.add_inertia(inertia.data());
        Eigen::VectorXd jacobian = Eigen::VectorXd::Zero(stride);
        for (Eigen::Index i = 0; i < size; ++i) jacobian[i] = draws.between(-1.0, 1.0);
        Eigen::VectorXd response(stride);
        equations.respond(jacobian.data(), response.data());
        EXPECT_LT((inertia * response - jacobian).norm(), 1e-8 * jacobian.norm());
      }
    }
}

}  // namespace
}  // namespace cohort::test
