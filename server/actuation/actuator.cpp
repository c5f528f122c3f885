#include "server/actuation/actuator.hpp"

#include "server/actuation/treel_drive.hpp"
#include "server/actuation/velocity_motor.hpp"

namespace cohort::actuation {
namespace {

// The register of actuators: a new kind is one more line here.
struct Make {
  const description::Model& model;
  std::size_t device;
  physics::World& world;
  std::uint32_t body;

  template <class SensorOnly>
  std::unique_ptr<Actuator> operator()(const SensorOnly&) const {
    return nullptr;
  }
  std::unique_ptr<Actuator> operator()(const description::TreelDrive& d) const {
    return std::make_unique<TreelDrive>(d, device, world, body);
  }
  std::unique_ptr<Actuator> operator()(const description::VelocityMotor& d) const {
    return std::make_unique<VelocityMotor>(d, model.joints[d.joint], world, body);
  }
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::Model& model, std::size_t device, physics::World& world,
                                        std::uint32_t body) {
  return std::visit(Make{model, device, world, body}, model.devices[device]);
}

}  // namespace cohort::actuation
