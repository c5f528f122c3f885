// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iterator>

#include "tests/benchmarks/comparison/engines/engines.hpp"
#include "tests/benchmarks/comparison/engines/mujoco_model.hpp"

namespace cohort::bench {
namespace {

std::string three(const Eigen::Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

// Returns the model as text; the bodies of a chain are nested.
std::string text_of(const Mechanism& mechanism) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, R"(<mujoco><option timestep="{}" gravity="{}"/><worldbody>)", mechanism.step,
                 three(mechanism.gravity));
  const double friction = mechanism.floor_friction.value_or(0.0);
  if (mechanism.floor_friction) fmt::format_to(out, R"(<geom type="plane" size="0 0 1" friction="{}"/>)", friction);
  Eigen::Vector3d parent_W = Eigen::Vector3d::Zero();
  for (const RigidBody& body : mechanism.bodies) {
    fmt::format_to(out, R"(<body pos="{}">)", three(body.centre_W - parent_W));
    if (body.hinge_W)
      fmt::format_to(out, R"(<joint pos="{}" axis="0 1 0"/>)", three(*body.hinge_W - body.centre_W));
    else
      text += "<freejoint/>";
    fmt::format_to(out, R"(<inertial pos="0 0 0" mass="{}" diaginertia="{}"/>)", body.mass, three(body.inertia));
    if (body.box)
      fmt::format_to(out, R"(<geom type="box" size="{}" friction="{}"/>)", three(0.5 * *body.box), friction);
    parent_W = body.centre_W;
  }
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i) text += "</body>";
  return text + "</worldbody></mujoco>";
}

class MujocoMechanism final : public MechanismRun {
 public:
  explicit MujocoMechanism(const Mechanism& mechanism)
      : model_(compile_mujoco(text_of(mechanism))), data_(mj_makeData(model_.get())) {
    if (const RigidBody& body = mechanism.bodies.front(); !body.hinge_W)
      for (int i = 0; i < 3; ++i) data_->qvel[3 + i] = body.angular_velocity_W[i];
    mj_forward(model_.get(), data_.get());
  }

  void step() override {
    step_mujoco(*model_, *data_);
    mj_kinematics(model_.get(), data_.get());  // mj_step leaves poses and velocities from before the step
    mj_comPos(model_.get(), data_.get());
    mj_fwdVelocity(model_.get(), data_.get());
  }
  Eigen::Vector3d position(std::size_t body) const override {
    return Eigen::Map<const Eigen::Vector3d>(data_->xipos + 3 * (body + 1));
  }
  Eigen::Vector3d velocity(std::size_t body) const override { return velocities(body).tail<3>(); }
  Eigen::Vector3d angular_velocity(std::size_t body) const override { return velocities(body).head<3>(); }
  Eigen::Matrix3d rotation(std::size_t body) const override {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data_->ximat + 9 * (body + 1));
  }

 private:
  // Returns the velocity of a body's centre of mass in the world's axes: angular, then linear.
  Eigen::Matrix<double, 6, 1> velocities(std::size_t body) const {
    Eigen::Matrix<double, 6, 1> both;
    mj_objectVelocity(model_.get(), data_.get(), mjOBJ_BODY, static_cast<int>(body) + 1, both.data(), 0);
    return both;
  }

  MujocoModel model_;
  MujocoData data_;
};

}  // namespace

std::unique_ptr<MechanismRun> make_mujoco_mechanism(const Mechanism& mechanism) {
  return std::make_unique<MujocoMechanism>(mechanism);
}

}  // namespace cohort::bench
