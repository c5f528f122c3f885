#include <sdf/Link.hh>

#include "server/parsing/model/read_model.hpp"
#include "server/parsing/model/read_values.hpp"

namespace cohort::parsing {
namespace {

void check_part(const GripRing&, const ExtensionValues&, const SdfReport&) {}

void check_part(const Fin& fin, const ExtensionValues& values, const SdfReport& report) {
  if (fin.alpha_stall > Fin{}.alpha_stall)
    report.problem(values.where("alpha_stall"), "expected an angle of at most a quarter turn, pi/2");
}

void check_part(const Drag&, const ExtensionValues& values, const SdfReport& report) {
  for (const char* const key : {"damping", "quadratic_damping", "angular_damping", "quadratic_angular_damping"})
    if (values.vector(key).minCoeff() < 0.0) report.problem(values.where(key), "expected three numbers >= 0");
}

}  // namespace

template <class Part>
std::vector<Part> read_link_parts(const sdf::Link& sdf_link, const ModelReading& reading) {
  std::vector<Part> parts;
  const sdf::ElementPtr link = sdf_link.Element();
  for (sdf::ElementPtr child = link->GetFirstElement(); child; child = child->GetNextElement())
    if (const auto values = read_as<Part>(child, reading.report)) {
      parts.emplace_back().name = values->name();
      read_values<Part>(*values, parts.back());
      check_part(parts.back(), *values, reading.report);
    }
  return parts;
}

template std::vector<GripRing> read_link_parts(const sdf::Link&, const ModelReading&);
template std::vector<Fin> read_link_parts(const sdf::Link&, const ModelReading&);
template std::vector<Drag> read_link_parts(const sdf::Link&, const ModelReading&);

}  // namespace cohort::parsing
