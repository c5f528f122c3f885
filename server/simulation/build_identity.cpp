// SPDX-License-Identifier: Apache-2.0
#include "server/simulation/build_identity.hpp"

#include <cmath>
#include <cstdio>

#include "idl/include/cohort/version.h"
#include "server/core/commit.hpp"
#include "server/core/hash.hpp"
#include "server/core/random.hpp"
#include "server/core/worker_pool.hpp"
#include "server/description/world_in_code.hpp"
#include "server/physics/make_world.hpp"

namespace cohort {
namespace {

void add_functions(StateHash& hash) {
  for (const double x : {1e-9, 0.1, 0.7, 0.9, 1.0, 2.5, 31.4, 1234.5}) {
    for (const double value : {std::sin(x), std::cos(-x), std::tan(x), std::atan(x), std::atan2(-x, 0.3), std::log(x),
                               std::exp(-x), std::sqrt(x)})
      hash.add(value);
    hash.add(std::asin(x / 2000.0));
    hash.add(std::acos(x / 2000.0));
  }
}

void add_random_numbers(StateHash& hash) {
  const RandomStream random(7, "robot", "sensor");
  for (std::uint32_t draw = 0; draw < 4; ++draw) {
    hash.add(random.uniform(3, draw));
    hash.add(random.normal(3, draw));
  }
}

description::Model one_link(const char* name, const description::Shape& shape) {
  description::Model model;
  model.name = name;
  model.links.push_back({"link", {}, description::solid_sphere(0.5, 0.1), {{"collision", {}, shape, {0.7, 0.3}}}});
  return model;
}

// Returns a model of a hub with an arm on a motorized joint.
description::Model driven() {
  description::Model model = one_link("driven", description::Cylinder{0.1, 0.1});
  model.links.push_back({"arm",
                         {{0.15, 0.0, 0.1}, Eigen::Quaterniond::Identity()},
                         description::solid_sphere(0.2, 0.05),
                         {{"collision", {}, description::Sphere{0.05}, {}}}});
  description::Joint joint;
  joint.name = "joint";
  joint.type = description::JointType::revolute;
  joint.parent = 0;
  joint.child = 1;
  joint.axis.direction = Eigen::Vector3d(0.0, 0.6, 0.8);
  joint.X_LJ.position = {-0.1, 0.0, 0.0};
  model.joints.push_back(joint);
  model.devices.emplace_back(description::VelocityMotor{"motor", 0, 3.0, 0.5});
  return model;
}

description::World small_world(description::Dynamics dynamics, description::Solver solver) {
  using description::at;
  description::World world;
  world.physics.dynamics = dynamics;
  world.physics.solver = solver;
  place(world, description::static_shape("floor", description::Plane{}), "floor", {});
  place(world, one_link("box", description::Box{{0.2, 0.2, 0.2}}), "lower", at(0.0, 0.0, 0.1));
  place(world, one_link("box", description::Box{{0.2, 0.2, 0.2}}), "upper", at(0.03, 0.02, 0.301, 0.4));
  place(world, one_link("ball", description::Sphere{0.1}), "ball", at(0.25, 0.05, 0.15));
  place(world, driven(), "driven", at(-0.35, 0.0, 0.06, 0.2));
  return world;
}

void add_world(StateHash& hash, description::Dynamics dynamics, description::Solver solver) {
  constexpr int steps = 30;
  const description::World description = small_world(dynamics, solver);
  WorkerPool workers(1);
  const auto world = physics::make_world(description, workers);
  const auto driven = static_cast<std::uint32_t>(description.instances.size() - 1);
  world->set_joint_target(BodyId{driven}, JointId{0}, physics::JointTarget::velocity(2.0));
  for (int step = 0; step < steps; ++step) world->step();
  for (std::uint32_t body = 0; body < world->body_count(); ++body) world->hash_body(BodyId{body}, hash);
  world->hash_contacts(hash);
}

}  // namespace

std::string arithmetic_fingerprint() {
  StateHash hash;
  add_functions(hash);
  add_random_numbers(hash);
  for (const auto dynamics : {description::Dynamics::bullet, description::Dynamics::cohort})
    for (const auto solver : {description::Solver::iterative, description::Solver::convex, description::Solver::direct})
      add_world(hash, dynamics, solver);
  char digits[17] = {};
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash.value()));
  return digits;
}

const BuildIdentity& this_build() {
  static const BuildIdentity build{COHORT_VERSION, commit_of_program(), arithmetic_fingerprint()};
  return build;
}

std::span<const std::string_view> versions_of_snapshots() {
  static constexpr std::string_view versions[] = {"0.1.0", COHORT_VERSION};
  return versions;
}

std::string why_results_differ(const BuildIdentity& other) {
  const BuildIdentity& own = this_build();
  const bool is_other_arithmetic = !other.arithmetic.empty() && other.arithmetic != own.arithmetic;
  if (!is_other_arithmetic && other.version == own.version) return "";
  const auto name = [](const BuildIdentity& build) {
    return "version " + build.version.substr(0, 20) + ", commit " +
           (build.commit.empty() ? "unknown" : build.commit.substr(0, 60));
  };
  return "it is from another build of Cohort (" + name(other) + "; this is " + name(own) +
         "): " + (is_other_arithmetic ? "its arithmetic differs, so results will differ" : "results may differ");
}

}  // namespace cohort
