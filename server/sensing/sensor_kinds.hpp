// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "server/sensing/sensor.hpp"

namespace cohort::sensing {

/// The base of a kind of sensor: a device of a model, and its mount.
template <class Device>
class SensorOf : public Sensor {
 public:
  SensorOf(const Device& device, const Mount& mount) : device_(device), mount_(mount) {}

 protected:
  const Device& device_;  // in the model
  Mount mount_;
};

// The register of sensors, by their type in a model. Each has a file of its own, and a new kind adds one line here.
std::unique_ptr<Sensor> make_sensor(const description::Accelerometer& sensor, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::AirPressureSensor& sensor, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::Altimeter& altimeter, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::Battery& battery, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::ClimateSensor& sensor, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::ContactSensor& sensor, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::ForceTorqueSensor& sensor, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::Gripper& gripper, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::GroundSensors& sensors, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::Imu& imu, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::Inclinometer& sensor, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::JointEncoder& encoder, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::Lidar& lidar, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::LightSensors& sensors, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::LogicalCamera& camera, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::Magnetometer& sensor, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::Microphones& microphones, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::NavSat& sensor, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::OmnidirectionalCamera& camera, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::PanoramicCamera& camera, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::ProximityRing& ring, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::RangeAndBearing& device, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::Rotor& rotor, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::TorqueSensor& sensor, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::TractionSensor& sensor, const Mount& mount);
std::unique_ptr<Sensor> make_sensor(const description::TreelEncoder& encoder, const Mount& mount);

}  // namespace cohort::sensing
