#include <algorithm>

#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Where one joint goes, and stays [rad] or [m].
class PositionMotor final : public Actuator {
 public:
  PositionMotor(const description::PositionMotor& motor, const Mount& mount) : motor_(motor), mount_(mount) {}
  std::vector<Channel> channels() const override {
    const char* unit = mount_.joint(motor_.joint).type == description::JointType::prismatic ? "m" : "rad";
    const description::JointAxis& axis = mount_.joint(motor_.joint).axis;
    return {{motor_.name + "/0/position", unit, 1, axis.lower, axis.upper, std::clamp(0.0, axis.lower, axis.upper)}};
  }
  void apply(std::span<const double> values) override {
    mount_.world.set_joint_position_target(mount_.body, motor_.joint, values[0]);
  }

 private:
  description::PositionMotor motor_;
  Mount mount_;
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::PositionMotor& motor, const Mount& mount) {
  return std::make_unique<PositionMotor>(motor, mount);
}

}  // namespace cohort::actuation
