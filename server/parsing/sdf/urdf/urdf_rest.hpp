#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// Properties in a URDF that its converter to SDF does not support. They are added to the SDF afterwards.
struct UrdfRest {
  std::map<std::string, XmlNode> surfaces;                            ///< as SDF has them, of all collisions of a link
  std::set<std::pair<std::string, std::size_t>> capsules;             ///< a link, and which of its collisions is one
  std::map<std::pair<std::string, std::size_t>, std::string> planes;  ///< likewise, and its normal
  std::set<std::string> weightless;                                   ///< links that have mass only for the converter
  std::set<std::string> balls;                                        ///< joints of Bullet's type `spherical`
  std::set<std::string> let_go;  ///< joints of the type `floating`, which constrain nothing
  std::string held;              ///< the link that is fixed to the world; empty if there is none
};

/// Adds the rest to the model that was made from the URDF.
void add_rest(const UrdfRest& rest, XmlNode& model);

}  // namespace cohort::parsing
