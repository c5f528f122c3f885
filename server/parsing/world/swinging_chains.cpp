// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/world/swinging_chains.hpp"

#include <chrono>
#include <cmath>
#include <vector>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

// Limits for the step times the sum of sqrt(g / length), measured for equal rods that are let go when level
// (docs/fidelity.md). Up to the first, 2 to 12 rods keep their energy within about 1 % for 10 to 30 s. At the second, 5
// and more are off by over a tenth.
constexpr double accurate = 0.05;
constexpr double wrong = 0.25;

bool is_turning(JointType type) {
  return type == JointType::revolute || type == JointType::ball || type == JointType::universal;
}

bool is_braked(const JointAxis& axis) {
  return axis.damping > 0.0 || axis.friction > 0.0 || axis.spring_stiffness > 0.0;
}

// Returns which joints turn with nothing that holds or brakes them.
std::vector<bool> free_joints(const Model& model) {
  std::vector<bool> is_free;
  for (const Joint& joint : model.joints)
    is_free.push_back(is_turning(joint.type) && !is_braked(joint.axis) && !is_braked(joint.second_axis));
  for (const Device& device : model.devices)
    for (const description::MotorLimits& motor : description::motor_limits(device)) is_free[motor.joint] = false;
  for (const description::Coupling& coupling : model.couplings)
    is_free[coupling.follower] = is_free[coupling.leader] = false;
  return is_free;
}

// The free joints in a row above a link.
struct Chain {
  int joints = 0;
  double rate = 0.0;                                 // sum of sqrt(gravity / length) over the links between them [1/s]
  Eigen::Vector3d last_M = Eigen::Vector3d::Zero();  // the last joint

  void add_link(double length, double gravity) {
    if (length > 0.0) rate += std::sqrt(gravity / length);
  }
};

// Returns the length of the thin rod that would swing like a link about a point of its, or 0 if the link does not
// swing.
double length_as_rod(const Link& link, const Eigen::Vector3d& pivot_L) {
  const double arm = (link.inertial.X_LI.position - pivot_L).norm();
  const double moment = link.inertial.mass * arm;
  if (!(moment > 0.0)) return 0.0;
  const double across = 0.5 * link.inertial.inertia.trace();  // for a rod, that of any axis across
  return 1.5 * (across + moment * arm) / moment;
}

// Returns the chain of a model that swings fastest.
Chain fastest_chain(const Model& model, double gravity) {
  const std::vector<bool> is_free = free_joints(model);
  std::vector<std::size_t> joint_of(model.links.size(), Joint::world);
  for (std::size_t i = 0; i < model.joints.size(); ++i) joint_of[model.joints[i].child] = i;
  std::vector<Chain> above(model.links.size());
  Chain fastest;
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    if (joint_of[link] == Joint::world) continue;
    const Joint& joint = model.joints[joint_of[link]];
    Chain& chain = above[link];
    if (joint.parent != Joint::world) chain = above[joint.parent];
    if (!is_free[joint_of[link]]) continue;
    const Eigen::Vector3d pivot_M = (model.links[link].X_ML * joint.X_LJ).position;
    if (chain.joints > 0) chain.add_link((pivot_M - chain.last_M).norm(), gravity);
    chain.last_M = pivot_M;
    ++chain.joints;
    Chain whole = chain;
    whole.add_link(length_as_rod(model.links[link], joint.X_LJ.position), gravity);
    if (whole.joints > 1 && whole.rate > fastest.rate) fastest = whole;
  }
  return fastest;
}

}  // namespace

void warn_of_swinging_chains(World& world) {
  const double step = std::chrono::duration<double>(world.step).count();
  for (const Model& model : world.models) {
    if (model.is_static || !model.loop_joints.empty()) continue;
    const Chain chain = fastest_chain(model, world.gravity.norm());
    if (!(step * chain.rate > wrong)) continue;
    constexpr double digits = 1e5;
    world.warnings.push_back(
        {world.file, 0, "model[" + model.name + "]",
         "swings on " + std::to_string(chain.joints) + " joints in a row that nothing brakes: steps of " +
             shortest_text(step) + " s are too long to keep its energy; use at most " +
             shortest_text(std::floor(digits * accurate / chain.rate) / digits) + " s, or give the joints damping"});
  }
}

}  // namespace cohort::parsing
