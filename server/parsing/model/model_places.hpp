#pragma once

#include <sdf/Element.hh>
#include <sdf/Sensor.hh>
#include <set>
#include <string>

/// Where devices and sensors stand in the files of a model.
namespace cohort::parsing {

/// Where `cohort:` devices stand: a model, or one inside of it.
struct DeviceScope {
  sdf::ElementPtr model_element;
  std::string prefix;                     ///< of all names in it, such as `arm::`
  std::set<sdf::ElementPtr> elsewhere{};  ///< children that belong to another body
};

/// Where one of SDF's own sensors stands.
struct SensorPlace {
  const sdf::Sensor* sensor = nullptr;
  bool is_on_joint = false;
  std::string owner;   ///< scoped name of the link or joint
  std::string prefix;  ///< of all names in its model
};

/// Whether a <sensor> is of a type that is simulated where it stands.
bool is_sensor(const sdf::ElementPtr& element);

}  // namespace cohort::parsing
