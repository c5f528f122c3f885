#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Velocity of one joint [rad/s] or [m/s].
class VelocityMotor final : public Actuator {
 public:
  VelocityMotor(const description::VelocityMotor& motor, const Mount& mount) : motor_(motor), mount_(mount) {}
  std::vector<Channel> channels() const override {
    const char* unit = mount_.joint(motor_.joint).type == description::JointType::prismatic ? "m/s" : "rad/s";
    return {{motor_.name + "/0/velocity", unit, 1, -motor_.max_velocity, motor_.max_velocity, 0.0}};
  }
  void apply(std::span<const double> values) override {
    mount_.world.set_joint_velocity_target(mount_.body, motor_.joint, values[0]);
  }

 private:
  description::VelocityMotor motor_;
  Mount mount_;
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::VelocityMotor& motor, const Mount& mount) {
  return std::make_unique<VelocityMotor>(motor, mount);
}

}  // namespace cohort::actuation
