// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// The visual elements of a URDF, whose errors never prevent reading a file.
class UrdfVisuals {
 public:
  /// Removes the materials of a robot that would stop the converter. Materials that are defined in a link become
  /// materials of the robot, so that visuals of all links can refer to them.
  void mend_materials(XmlNode& robot);
  /// Removes the visuals of a link that cannot be read.
  void mend_link(XmlNode& link) const;

 private:
  std::set<std::string> materials_;
};

/// Changes the scale of a mesh, if the geometry is one, to three numbers.
void mend_mesh(XmlNode& geometry);

}  // namespace cohort::parsing
