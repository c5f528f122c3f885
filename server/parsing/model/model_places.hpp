#pragma once

#include <sdf/Element.hh>
#include <sdf/Sensor.hh>
#include <set>
#include <string>

/// Positions of devices and sensors in the files of a model.
namespace cohort::parsing {

/// An element that contains `cohort:` devices: a model, or a nested model.
struct DeviceScope {
  sdf::ElementPtr model_element;
  std::string prefix;                     ///< prefix of all names in it, such as `arm::`
  std::set<sdf::ElementPtr> elsewhere{};  ///< children that belong to another body
};

/// The position of a `<sensor>` of SDF.
struct SensorPlace {
  const sdf::Sensor* sensor = nullptr;
  bool is_on_joint = false;
  std::string owner;   ///< scoped name of the link or joint
  std::string prefix;  ///< prefix of all names in its model
};

/// Returns whether a <sensor> has a type that is simulated at its position.
bool is_sensor(const sdf::ElementPtr& element);

}  // namespace cohort::parsing
