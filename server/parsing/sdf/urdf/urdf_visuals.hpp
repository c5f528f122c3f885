#pragma once

#include <set>
#include <string>

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// What a URDF has only to be seen. It never stops a file.
class UrdfVisuals {
 public:
  /// Takes out the materials of a robot that the converter would stop at, and remembers the rest.
  void mend_materials(XmlNode& robot);
  /// Takes out the visuals of a link that cannot be read.
  void mend_link(XmlNode& link) const;

 private:
  std::set<std::string> materials_;
};

/// Makes the scale of a mesh, if the geometry is one, three numbers.
void mend_mesh(XmlNode& geometry);

}  // namespace cohort::parsing
