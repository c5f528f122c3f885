#include <sdf/Link.hh>

#include "server/parsing/model/read_model.hpp"
#include "server/parsing/model/read_values.hpp"

namespace cohort::parsing {

std::vector<GripRing> read_grip_rings(const sdf::Link& sdf_link, const ModelReading& reading) {
  std::vector<GripRing> rings;
  const sdf::ElementPtr link = sdf_link.Element();
  for (sdf::ElementPtr child = link->GetFirstElement(); child; child = child->GetNextElement())
    if (const auto values = read_as<GripRing>(child, reading.report)) {
      rings.emplace_back().name = values->name();
      read_values<GripRing>(*values, rings.back());
    }
  return rings;
}

}  // namespace cohort::parsing
