#include "server/sensing/sensor.hpp"

#include "server/sensing/accelerometer.hpp"
#include "server/sensing/air_pressure.hpp"
#include "server/sensing/altimeter.hpp"
#include "server/sensing/battery.hpp"
#include "server/sensing/climate_sensor.hpp"
#include "server/sensing/contact_sensor.hpp"
#include "server/sensing/force_torque_sensor.hpp"
#include "server/sensing/gripper_sensor.hpp"
#include "server/sensing/ground_sensors.hpp"
#include "server/sensing/imu.hpp"
#include "server/sensing/inclinometer.hpp"
#include "server/sensing/joint_encoder.hpp"
#include "server/sensing/lidar.hpp"
#include "server/sensing/light_sensors.hpp"
#include "server/sensing/logical_camera.hpp"
#include "server/sensing/magnetometer.hpp"
#include "server/sensing/message_receiver.hpp"
#include "server/sensing/microphones.hpp"
#include "server/sensing/omnidirectional_camera.hpp"
#include "server/sensing/panoramic_camera.hpp"
#include "server/sensing/proximity_ring.hpp"
#include "server/sensing/torque_sensor.hpp"
#include "server/sensing/traction_sensor.hpp"
#include "server/sensing/treel_encoder.hpp"

namespace cohort::sensing {
namespace {

// The register of sensors: a new kind is one more line here.
struct Make {
  const description::Model& model;
  std::size_t device;
  Mount& mount;

  template <class ActuatorOnly>
  std::unique_ptr<Sensor> operator()(const ActuatorOnly&) const {
    return nullptr;
  }
  std::unique_ptr<Sensor> operator()(const description::ProximityRing& d) const {
    return std::make_unique<ProximityRing>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::Gripper& d) const {
    return std::make_unique<GripperSensor>(d, device, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::TorqueSensor& d) const {
    return std::make_unique<TorqueSensor>(d, model.joints[d.joint], std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::TractionSensor& d) const {
    return std::make_unique<TractionSensor>(d, model.joints[d.joint], std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::JointEncoder& d) const {
    return std::make_unique<JointEncoder>(d, model.joints[d.joint], std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::TreelEncoder& d) const {
    return std::make_unique<TreelEncoder>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::GroundSensors& d) const {
    return std::make_unique<GroundSensors>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::LightSensors& d) const {
    return std::make_unique<LightSensors>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::Microphones& d) const {
    return std::make_unique<Microphones>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::Accelerometer& d) const {
    return std::make_unique<Accelerometer>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::Imu& d) const {
    return std::make_unique<Imu>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::ForceTorqueSensor& d) const {
    return std::make_unique<ForceTorqueSensor>(d, model.joints[d.joint], std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::Inclinometer& d) const {
    return std::make_unique<Inclinometer>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::Lidar& d) const {
    return std::make_unique<Lidar>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::ContactSensor& d) const {
    return std::make_unique<ContactSensor>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::Altimeter& d) const {
    return std::make_unique<Altimeter>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::Magnetometer& d) const {
    return std::make_unique<Magnetometer>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::LogicalCamera& d) const {
    return std::make_unique<LogicalCamera>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::AirPressureSensor& d) const {
    return std::make_unique<AirPressureSensor>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::RangeAndBearing& d) const {
    return std::make_unique<MessageReceiver>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::ClimateSensor& d) const {
    return std::make_unique<ClimateSensor>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::OmnidirectionalCamera& d) const {
    return std::make_unique<OmnidirectionalCamera>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::PanoramicCamera& d) const {
    return std::make_unique<PanoramicCamera>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::Battery& d) const {
    return std::make_unique<Battery>(d, model, std::move(mount));
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::Model& model, std::size_t device, Mount mount) {
  return std::visit(Make{model, device, mount}, model.devices[device]);
}

}  // namespace cohort::sensing
