#include <sdf/Link.hh>

#include "server/parsing/sdf/extension_values.hpp"
#include "server/parsing/model/read_model.hpp"

namespace cohort::parsing {

std::vector<GripRing> read_grip_rings(const sdf::Link& sdf_link, const ModelReading& reading) {
  std::vector<GripRing> rings;
  const sdf::ElementPtr link = sdf_link.Element();
  for (sdf::ElementPtr child = link->GetFirstElement(); child; child = child->GetNextElement()) {
    if (child->GetName() != std::string(extension_prefix) + ":grip_ring") continue;
    if (const auto values = ExtensionValues::read(child, *find_extension("grip_ring", "link"), reading.report))
      rings.push_back({values->name(), 0, values->pose("pose"), values->real("radius")});
  }
  return rings;
}

}  // namespace cohort::parsing
