// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "server/parsing/sdf/element.hpp"
#include "server/parsing/sdf/frames.hpp"

/// Positions of devices and sensors in the files of a model.
namespace cohort::parsing {

/// An element that contains `cohort:` devices: a model, or a nested model.
struct DeviceScope {
  const Element* model_element;
  std::string prefix;                    ///< prefix of all names in it, such as `arm::`
  std::set<const Element*> elsewhere{};  ///< children that belong to another body
};

/// The position of a `<sensor>` of SDF.
struct SensorPlace {
  const Element* sensor = nullptr;
  const Frames* frames = nullptr;  ///< those of its model
  bool is_on_joint = false;
  std::string owner;   ///< scoped name of the link or joint
  std::string prefix;  ///< prefix of all names in its model
};

/// Returns whether a <sensor> has a type that is simulated at its position.
bool is_sensor(const Element* element);

}  // namespace cohort::parsing
