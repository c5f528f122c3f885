#include "server/actuation/actuator.hpp"

#include "server/actuation/effort_motor.hpp"
#include "server/actuation/gripper_motor.hpp"
#include "server/actuation/led_ring.hpp"
#include "server/actuation/loudspeaker.hpp"
#include "server/actuation/message_sender.hpp"
#include "server/actuation/position_motor.hpp"
#include "server/actuation/treel_drive.hpp"
#include "server/actuation/user_action.hpp"
#include "server/actuation/velocity_motor.hpp"

namespace cohort::actuation {
namespace {

// The register of actuators: a new kind is one more line here.
struct Make {
  const description::Model& model;
  std::size_t device;
  Mount mount;

  template <class SensorOnly>
  std::unique_ptr<Actuator> operator()(const SensorOnly&) const {
    return nullptr;
  }
  std::unique_ptr<Actuator> operator()(const description::TreelDrive& d) const {
    return std::make_unique<TreelDrive>(d, device, mount);
  }
  std::unique_ptr<Actuator> operator()(const description::VelocityMotor& d) const {
    return std::make_unique<VelocityMotor>(d, model.joints[d.joint], mount);
  }
  std::unique_ptr<Actuator> operator()(const description::PositionMotor& d) const {
    return std::make_unique<PositionMotor>(d, model.joints[d.joint], mount);
  }
  std::unique_ptr<Actuator> operator()(const description::EffortMotor& d) const {
    return std::make_unique<EffortMotor>(d, model.joints[d.joint], mount);
  }
  std::unique_ptr<Actuator> operator()(const description::LedRing& d) const {
    return std::make_unique<LedRing>(d, device, mount);
  }
  std::unique_ptr<Actuator> operator()(const description::Loudspeaker& d) const {
    return std::make_unique<Loudspeaker>(d, device, mount);
  }
  std::unique_ptr<Actuator> operator()(const description::Gripper& d) const {
    return std::make_unique<GripperMotor>(d, device, mount);
  }
  std::unique_ptr<Actuator> operator()(const description::RangeAndBearing& d) const {
    return std::make_unique<MessageSender>(d, device, mount);
  }
  std::unique_ptr<Actuator> operator()(const description::UserAction& d) const {
    return std::make_unique<UserAction>(d, device, mount);
  }
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::Model& model, std::size_t device, Mount mount) {
  return std::visit(Make{model, device, mount}, model.devices[device]);
}

}  // namespace cohort::actuation
