#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Torque or force on one joint [N m] or [N].
class EffortMotor final : public Actuator {
 public:
  EffortMotor(const description::EffortMotor& motor, const Mount& mount) : motor_(motor), mount_(mount) {}
  std::vector<Channel> channels() const override {
    const char* unit = mount_.joint(motor_.joint).type == description::JointType::prismatic ? "N" : "N m";
    return {{motor_.name + "/0/effort", unit, 1, -motor_.max_effort, motor_.max_effort, 0.0}};
  }
  void apply(std::span<const double> values) override {
    mount_.world.set_joint_effort_target(mount_.body, motor_.joint, values[0]);
  }

 private:
  description::EffortMotor motor_;
  Mount mount_;
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::EffortMotor& motor, const Mount& mount) {
  return std::make_unique<EffortMotor>(motor, mount);
}

}  // namespace cohort::actuation
