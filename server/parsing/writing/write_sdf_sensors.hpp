// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/model.hpp"
#include "server/parsing/writing/write_world.hpp"

namespace cohort::parsing {

/// Writes a `<sensor>` of SDF into its link or joint in the element of the model.
void write_sdf_sensor(XmlNode& model_element, const Model& model, const Lidar& lidar);
void write_sdf_sensor(XmlNode& model_element, const Model& model, const Imu& imu);
void write_sdf_sensor(XmlNode& model_element, const Model& model, const ContactSensor& sensor);
void write_sdf_sensor(XmlNode& model_element, const Model& model, const ForceTorqueSensor& sensor);
void write_sdf_sensor(XmlNode& model_element, const Model& model, const Altimeter& altimeter);
void write_sdf_sensor(XmlNode& model_element, const Model& model, const Magnetometer& magnetometer);
void write_sdf_sensor(XmlNode& model_element, const Model& model, const LogicalCamera& camera);
void write_sdf_sensor(XmlNode& model_element, const Model& model, const AirPressureSensor& sensor);
void write_sdf_sensor(XmlNode& model_element, const Model& model, const NavSat& sensor);

}  // namespace cohort::parsing
