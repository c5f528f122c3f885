// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "server/core/random.hpp"
#include "server/physics/dynamics/articulated_body.hpp"
#include "server/physics/dynamics/bias_forces.hpp"
#include "server/physics/dynamics/equations.hpp"
#include "server/physics/dynamics/integration.hpp"
#include "server/physics/dynamics/mass_matrix.hpp"
#include "server/physics/dynamics/whole_body.hpp"
#include "tests/support/worlds/small_world.hpp"

// The algorithms of server/physics/dynamics on random trees of links, against each other and against sums over links.
namespace cohort::test {
namespace {

using description::Dynamics;
using description::JointType;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using physics::BodyMotion;
using physics::MassMatrix;
using physics::Mechanism;

class TreeDraws {
 public:
  explicit TreeDraws(std::uint64_t seed) : random_(seed, "dynamics_agree", "draws") {}
  double between(double low, double high) { return low + (high - low) * random_.uniform(0, next_++); }
  bool chance(double share) { return between(0.0, 1.0) < share; }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(between(0.0, static_cast<double>(count))); }
  Vector3d vector(double half_width) {
    const double x = between(-half_width, half_width);
    const double y = between(-half_width, half_width);
    return {x, y, between(-half_width, half_width)};
  }
  Eigen::Quaterniond rotation() {
    const Vector3d axis = vector(1.0).normalized();
    return Eigen::Quaterniond(Eigen::AngleAxisd(between(-3.0, 3.0), axis));
  }
  VectorXd numbers(Eigen::Index size) {
    VectorXd drawn(size);
    for (double& number : drawn) number = between(-1.0, 1.0);
    return drawn;
  }

 private:
  RandomStream random_;
  std::uint32_t next_ = 0;
};

// Returns 2 to 12 links, with a joint of the root to the world if it is fixed.
description::Model draw_links(TreeDraws& draws) {
  constexpr JointType types[] = {JointType::revolute, JointType::prismatic, JointType::ball};
  description::Model model;
  const bool is_free = draws.chance(0.5);
  const std::size_t links = 2 + draws.below(11);
  for (std::size_t i = 0; i < links; ++i) {
    description::Link& link = model.links.emplace_back();
    link.name = "link_" + std::to_string(i);
    link.X_ML = {draws.vector(0.3), draws.rotation()};
    const double mass = draws.between(0.1, 2.0);
    link.inertial = solid_box(mass, Vector3d(0.1, 0.1, 0.1) + draws.vector(0.06));
    link.inertial.X_LI = {draws.vector(0.05), draws.rotation()};
    if (i == 0 && is_free) continue;
    const std::size_t parent = i == 0 ? description::Joint::world : draws.below(i);
    const JointType type = types[draws.below(std::size(types))];
    const Vector3d axis = draws.vector(1.0).normalized();
    description::Joint& joint =
        model.joints.emplace_back(joint_of("joint_" + std::to_string(i), type, parent, i, axis, draws.vector(0.1)));
    joint.X_LJ.orientation = draws.rotation();
    if (draws.chance(0.5)) joint.axis.damping = draws.between(0.0, 0.5);
    if (draws.chance(0.3)) joint.axis.spring_stiffness = draws.between(1.0, 500.0);
    joint.axis.spring_reference = draws.between(-0.5, 0.5);
  }
  return model;
}

// Returns them with the masses of a fluid around most of them.
description::Model draw_links_in_fluid(TreeDraws& draws) {
  description::Model model = draw_links(draws);
  for (description::Link& link : model.links) {
    if (draws.chance(0.3)) continue;
    description::SpatialMatrix root;
    for (double& number : root.reshaped()) number = draws.between(-0.3, 0.3);
    link.inertial.added_mass = std::make_shared<const description::SpatialMatrix>(root * root.transpose());
  }
  return model;
}

struct Tree {
  explicit Tree(std::uint64_t seed, bool in_fluid = false)
      : draws(seed),
        model(in_fluid ? draw_links_in_fluid(draws) : draw_links(draws)),
        mechanism(model, description::Fidelity::articulated) {
    X_WM = {draws.vector(2.0), draws.rotation()};
    state_seed = seed + 1000;
  }
  Eigen::Index size() const { return mechanism.dof_count(); }
  // Gives every body of this tree the same state.
  void set_state(BodyMotion& body) const {
    TreeDraws state(state_seed);
    if (mechanism.has_free_root()) body.set_root_twist({state.vector(2.0), state.vector(2.0)});
    for (std::size_t joint = 0; joint < model.joints.size(); ++joint) {
      const bool is_ball = mechanism.joint(joint).dofs == 3;
      const Eigen::Quaterniond turned = state.rotation();
      std::vector<double> coordinates{state.between(-1.0, 1.0)};
      if (is_ball) coordinates.assign(turned.coeffs().data(), turned.coeffs().data() + 4);
      const Vector3d velocities = state.vector(2.0);
      body.set_joint_state(joint, coordinates, {velocities.data(), is_ball ? 3u : 1u});
    }
  }

  TreeDraws draws;
  description::Model model;
  Mechanism mechanism;
  Pose X_WM;
  std::uint64_t state_seed = 0;
};

template <class Visit>
void for_each_tree(Visit&& visit, bool in_fluid = false) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("tree " + std::to_string(seed) + (in_fluid ? " in fluid" : ""));
    Tree tree(seed, in_fluid);
    BodyMotion body(tree.mechanism, Dynamics::cohort, tree.X_WM);
    tree.set_state(body);
    visit(tree, body);
  }
}
template <class Visit>
void for_each_tree_also_in_fluid(Visit&& visit) {
  for (const bool in_fluid : {false, true}) for_each_tree(visit, in_fluid);
}

VectorXd velocities_of(const BodyMotion& body) {
  return Eigen::Map<const VectorXd>(body.velocities(), body.mechanism().dof_count());
}

double relative_distance(const MatrixXd& found, const MatrixXd& expected) {
  return (found - expected).norm() / expected.norm();
}

// Returns the velocities of all segments, one after the other: angular, then linear at the centre of mass.
VectorXd segment_velocities(const BodyMotion& body) {
  const std::vector<physics::Segment>& segments = body.mechanism().segments();
  VectorXd velocities(6 * static_cast<Eigen::Index>(segments.size()));
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto index = static_cast<int>(s);
    const physics::Twist twist = body.segment_twist(index, body.segment_pose(index) * segments[s].centre_S);
    velocities.segment<6>(6 * static_cast<Eigen::Index>(s)) << twist.angular_W, twist.linear_W;
  }
  return velocities;
}
// Returns the momenta of the fluid around the links at these velocities of the segments, in the same order and about
// the same points.
VectorXd momenta_of_fluid(const BodyMotion& body, const VectorXd& velocities) {
  VectorXd momenta = VectorXd::Zero(velocities.size());
  const std::vector<description::Link>& links = body.mechanism().model().links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!links[i].inertial.added_mass) continue;
    const Eigen::Index s = body.mechanism().link(i).segment;
    const Pose X_WL = body.link_pose(i);
    const Vector3d centre = body.segment_poses()[static_cast<std::size_t>(s)] *
                            body.mechanism().segments()[static_cast<std::size_t>(s)].centre_S;
    const Eigen::Matrix3d R = X_WL.orientation.toRotationMatrix();
    const Vector3d w = velocities.segment<3>(6 * s);
    const Vector3d v = velocities.segment<3>(6 * s + 3) + w.cross(X_WL.position - centre);
    Eigen::Matrix<double, 6, 1> motion_L;
    motion_L << R.transpose() * w, R.transpose() * v;
    const Eigen::Matrix<double, 6, 1> momentum_L = *links[i].inertial.added_mass * motion_L;
    const Vector3d linear = R * momentum_L.tail<3>();
    momenta.segment<3>(6 * s) += R * momentum_L.head<3>() + (X_WL.position - centre).cross(linear);
    momenta.segment<3>(6 * s + 3) += linear;
  }
  return momenta;
}
// Returns the momenta of the segments at these velocities, in the same order and about the same points.
VectorXd momenta_at(const BodyMotion& body, VectorXd velocities) {
  const VectorXd present = velocities;
  const std::vector<physics::Segment>& segments = body.mechanism().segments();
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto index = static_cast<Eigen::Index>(s);
    const Eigen::Matrix3d R = body.segment_poses()[s].orientation.toRotationMatrix();
    const Vector3d spin = R * segments[s].inertia_S * R.transpose() * velocities.segment<3>(6 * index);
    velocities.segment<3>(6 * index) = spin;
    velocities.segment<3>(6 * index + 3) *= segments[s].mass;
  }
  return velocities + momenta_of_fluid(body, present);
}

// Returns the velocities of the segments by a unit of each dof, by column.
MatrixXd segment_jacobian(BodyMotion& body) {
  const VectorXd present = velocities_of(body);
  Eigen::Map<VectorXd> velocities(body.state().velocities(), present.size());
  MatrixXd jacobian(6 * static_cast<Eigen::Index>(body.mechanism().segments().size()), present.size());
  for (Eigen::Index i = 0; i < present.size(); ++i) {
    velocities = VectorXd::Unit(present.size(), i);
    jacobian.col(i) = segment_velocities(body);
  }
  velocities = present;
  return jacobian;
}

// The mass matrix with what it is computed from.
struct TreeInertia {
  explicit TreeInertia(const BodyMotion& body) : mechanism(body.mechanism()) {
    physics::find_joint_axes(body, axes);
    bias.set_up(body, axes);
    matrix.set_up(body, axes, bias);
  }
  // Returns the matrix from its factors.
  MatrixXd product() const {
    const auto stride = static_cast<Eigen::Index>(mechanism.stride());
    MatrixXd padded = MatrixXd::Zero(stride, stride);
    matrix.add_product(padded.data());
    return padded.topLeftCorner(mechanism.dof_count(), mechanism.dof_count());
  }

  const Mechanism& mechanism;
  std::vector<physics::Spatial> axes;
  physics::BiasForces bias;
  MassMatrix matrix;
};

TEST(MassMatrixOfTrees, IsTheMatrixOfTheKineticEnergy) {
  int free_roots = 0;
  for_each_tree_also_in_fluid([&](const Tree& tree, BodyMotion& body) {
    const MatrixXd jacobian = segment_jacobian(body);
    MatrixXd expected(tree.size(), tree.size());
    for (Eigen::Index i = 0; i < tree.size(); ++i)
      expected.col(i) = jacobian.transpose() * momenta_at(body, jacobian.col(i));
    TreeInertia inertia(body);
    for (int i = 0; i < tree.size(); ++i)
      EXPECT_NEAR(inertia.matrix.inertia(i), expected(i, i), 1e-12 * expected.norm());
    inertia.matrix.factorise();
    EXPECT_LT(relative_distance(inertia.product(), expected), 1e-12);
    free_roots += tree.mechanism.has_free_root() ? 1 : 0;
  });
  EXPECT_GT(free_roots, 20);
  EXPECT_LT(free_roots, 60);
}

TEST(MassMatrixOfTrees, IsSymmetricAndPositiveDefinite) {
  for_each_tree([](const Tree&, BodyMotion& body) {
    TreeInertia inertia(body);
    inertia.matrix.factorise();
    const MatrixXd matrix = inertia.product();
    EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-14 * matrix.norm());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix).eigenvalues().minCoeff(), 1e-6);
  });
}

TEST(MassMatrixOfTrees, SolvesForTheForcesThatItsProductGives) {
  for_each_tree([](Tree& tree, BodyMotion& body) {
    TreeInertia inertia(body);
    for (int i = 0; i < tree.size(); ++i) inertia.matrix.add_inertia(i, tree.draws.between(0.0, 0.1));
    inertia.matrix.factorise();
    const VectorXd expected = tree.draws.numbers(tree.size());
    VectorXd found = inertia.product() * expected;
    inertia.matrix.solve(found.data());
    EXPECT_LT(relative_distance(found, expected), 1e-9);
  });
}

TEST(MassMatrixOfTrees, HasAnInverseThatAgreesWithSolving) {
  int inverted = 0;
  for_each_tree_also_in_fluid([&](Tree& tree, BodyMotion& body) {
    const auto size = static_cast<int>(tree.size());
    if (!MassMatrix::is_small(size)) return;
    ++inverted;
    TreeInertia inertia(body);
    inertia.matrix.factorise();
    const auto stride = static_cast<Eigen::Index>(tree.mechanism.stride());
    MatrixXd inverse = MatrixXd::Zero(stride, stride);
    inertia.matrix.invert(inverse.data());
    for (Eigen::Index i = 0; i < size; ++i) {
      VectorXd solution = VectorXd::Unit(size, i);
      inertia.matrix.solve(solution.data());
      EXPECT_LT(relative_distance(inverse.col(i).head(size), solution), 1e-10);
    }
  });
  EXPECT_GT(inverted, 16);
}

// The dofs before one are held, so that only the matrix of the later ones resists it.
TEST(MassMatrixOfTrees, KnowsTheInertiaOfADofThatCarriesFreeParts) {
  for_each_tree([](const Tree& tree, BodyMotion& body) {
    TreeInertia inertia(body);
    inertia.matrix.factorise();
    const MatrixXd matrix = inertia.product();
    for (int i = 0; i < tree.size(); ++i) {
      const Eigen::Index later = tree.size() - i;
      const double expected = 1.0 / matrix.bottomRightCorner(later, later).inverse()(0, 0);
      EXPECT_NEAR(inertia.matrix.articulated_inertia(i), expected, 1e-9 * expected);
    }
  });
}

TEST(ArticulatedBodyOfTrees, SolvesAsTheMassMatrixDoes) {
  for_each_tree_also_in_fluid([](Tree& tree, BodyMotion& body) {
    TreeInertia inertia(body);
    std::vector<double> added(static_cast<std::size_t>(tree.size()));
    for (int i = 0; i < tree.size(); ++i) {
      added[static_cast<std::size_t>(i)] = tree.draws.between(0.0, 0.1);
      inertia.matrix.add_inertia(i, added[static_cast<std::size_t>(i)]);
    }
    inertia.matrix.factorise();
    physics::ArticulatedBody recursion;
    recursion.set_up(body, added, 0.0);
    for (int side = 0; side < 3; ++side) {
      VectorXd expected = tree.draws.numbers(tree.size());
      VectorXd found = expected;
      inertia.matrix.solve(expected.data());
      recursion.solve(found.data());
      EXPECT_LT(relative_distance(found, expected), 1e-9);
    }
  });
}

// By d'Alembert's principle, the bias forces are the rates of all momenta, less the weights, along each dof.
TEST(BiasForcesOfTrees, AreTheRatesOfMomentaAtConstantVelocitiesLessTheWeights) {
  const Vector3d gravity(0.5, -1.0, -9.0);
  constexpr double moment = 1e-4;  // [s]
  for_each_tree_also_in_fluid([&](const Tree& tree, BodyMotion& body) {
    const VectorXd velocities = velocities_of(body);
    VectorXd found(tree.size());
    TreeInertia(body).bias.find(velocities.data(), gravity, found.data());
    const MatrixXd jacobian = segment_jacobian(body);
    VectorXd forces(jacobian.rows());
    for (std::size_t s = 0; s < tree.mechanism.segments().size(); ++s)
      forces.segment<6>(6 * static_cast<Eigen::Index>(s)) << Vector3d::Zero(),
          -tree.mechanism.segments()[s].mass * gravity;
    physics::integrate(body, velocities.data(), moment);
    const VectorXd later = momenta_at(body, segment_velocities(body));
    physics::integrate(body, velocities.data(), -2.0 * moment);
    forces += (later - momenta_at(body, segment_velocities(body))) / (2.0 * moment);
    physics::integrate(body, velocities.data(), moment);
    // Momenta are about centres that move, and that of a fluid is not along the velocity.
    const VectorXd present = segment_velocities(body);
    const VectorXd momenta = momenta_of_fluid(body, present);
    for (Eigen::Index s = 0; s < forces.size(); s += 6)
      forces.segment<3>(s) += present.segment<3>(s + 3).cross(momenta.segment<3>(s + 3));
    EXPECT_LT(relative_distance(found, jacobian.transpose() * forces), 1e-6);
  });
}

// Calls `visit(tree, by_cohort, by_bullet)` with the equations of each tree, set up in the same state.
template <class Visit>
void for_both_equations(Visit&& visit) {
  constexpr double step = 0.002;
  for_each_tree([&](Tree& tree, const BodyMotion& body) {
    BodyMotion of_bullet(tree.mechanism, Dynamics::bullet, tree.X_WM);
    tree.set_state(of_bullet);
    ASSERT_NE(of_bullet.bullet(), nullptr);
    physics::Equations by_cohort;
    physics::Equations by_bullet;
    by_cohort.set_up(body, Vector3d(0.5, -1.0, -9.0), step, false);
    by_bullet.set_up(of_bullet, Vector3d(0.5, -1.0, -9.0), step, false);
    visit(tree, by_cohort, by_bullet);
  });
}

TEST(EquationsOfTrees, GiveTheSameVelocitiesWithBothDynamics) {
  int stiff = 0;
  for_both_equations([&](const Tree& tree, const physics::Equations& by_cohort, const physics::Equations& by_bullet) {
    const Eigen::Map<const VectorXd> expected(by_cohort.velocity(), tree.size());
    const Eigen::Map<const VectorXd> found(by_bullet.velocity(), tree.size());
    EXPECT_GT((expected - velocities_of(by_cohort.body())).norm(), 1e-3) << "gravity accelerates it";
    EXPECT_LT(relative_distance(found, expected), 1e-9);
    EXPECT_EQ(by_bullet.is_symmetric(), by_cohort.is_symmetric());
    stiff += by_cohort.is_symmetric() ? 0 : 1;
  });
  EXPECT_GT(stiff, 4) << "some trees spin fast";
  EXPECT_LT(stiff, 36);
}

TEST(EquationsOfTrees, RespondToAnImpulseAlikeWithBothDynamics) {
  for_both_equations([](Tree& tree, physics::Equations& by_cohort, physics::Equations& by_bullet) {
    const auto stride = static_cast<Eigen::Index>(by_cohort.stride());
    VectorXd impulse = VectorXd::Zero(stride);
    impulse.head(tree.size()) = tree.draws.numbers(tree.size());
    VectorXd expected = VectorXd::Zero(stride);
    VectorXd found = VectorXd::Zero(stride);
    by_cohort.respond(impulse.data(), expected.data());
    by_bullet.respond(impulse.data(), found.data());
    EXPECT_LT(relative_distance(found, expected), 1e-9);
    if (!by_cohort.is_symmetric()) return;
    for (const physics::Equations* equations : {&by_cohort, &by_bullet}) {
      MatrixXd inertia = MatrixXd::Zero(stride, stride);
      equations->add_inertia(inertia.data());
      EXPECT_LT(relative_distance(inertia * expected, impulse), 1e-8);
    }
  });
}

// Sums over the links of a body, in world axes.
struct LinkSums {
  explicit LinkSums(const BodyMotion& body) {
    const std::vector<description::Link>& links = body.mechanism().model().links;
    for (std::size_t i = 0; i < links.size(); ++i) {
      mass += links[i].inertial.mass;
      centre += links[i].inertial.mass * (body.link_pose(i) * links[i].inertial.X_LI.position);
    }
    centre /= mass;
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Pose X_WI = body.link_pose(i) * links[i].inertial.X_LI;
      const Vector3d to_centre = X_WI.position - body.link_pose(i).position;
      const physics::Twist twist = body.link_twist(i);
      const Vector3d linear = links[i].inertial.mass * (twist.linear_W + twist.angular_W.cross(to_centre));
      const Eigen::Matrix3d R = X_WI.orientation.toRotationMatrix();
      const Vector3d arm = X_WI.position - centre;
      const Eigen::Matrix3d own = R * links[i].inertial.inertia * R.transpose();
      momentum += linear;
      angular_momentum += own * twist.angular_W + arm.cross(linear);
      for (int axis = 0; axis < 3; ++axis)
        inertia.col(axis) += own.col(axis) + links[i].inertial.mass * arm.cross(Vector3d::Unit(axis).cross(arm));
    }
  }

  double mass = 0.0;
  Vector3d centre = Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  Vector3d momentum = Vector3d::Zero();
  Vector3d angular_momentum = Vector3d::Zero();
};

TEST(WholeBodyOfTrees, HasTheMassTheCentreAndTheInertiaOfAllLinks) {
  for_each_tree([](const Tree&, const BodyMotion& body) {
    const physics::WholeBody whole(body);
    const LinkSums sums(body);
    EXPECT_NEAR(whole.mass, sums.mass, 1e-12 * sums.mass);
    EXPECT_LT((whole.centre_W - sums.centre).norm(), 1e-12);
    EXPECT_LT(relative_distance(whole.inertia_W, sums.inertia), 1e-12);
  });
}

TEST(WholeBodyOfTrees, HasTheMomentumOfAllLinks) {
  int bodies = 0;
  for_each_tree([&](const Tree& tree, BodyMotion& body) {
    if (!tree.mechanism.has_free_root()) return;
    ++bodies;
    const Vector3d turning = velocities_of(body).head<3>();
    const LinkSums moving(body);
    EXPECT_LT((physics::WholeBody(body).angular_velocity_at(moving.angular_momentum) - turning).norm(), 1e-10);
    body.set_root_twist({Vector3d::Zero(), Vector3d::Zero()});
    const physics::WholeBody whole(body);
    const LinkSums of_joints(body);
    EXPECT_LT(relative_distance(whole.joints_momentum_W, of_joints.momentum), 1e-10);
    EXPECT_LT(relative_distance(whole.joints_angular_momentum_W, of_joints.angular_momentum), 1e-10);
  });
  EXPECT_GT(bodies, 10);
}

}  // namespace
}  // namespace cohort::test
