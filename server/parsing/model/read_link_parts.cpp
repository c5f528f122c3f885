// SPDX-License-Identifier: Apache-2.0
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

template <class Part>
Part read_part(const ExtensionValues& values, const SdfReport& report) {
  Part part;
  part.name = values.name();
  read_values<Part>(values, part);
  check_part(part, values, report);
  return part;
}

template <class Part>
void add_link_part(const Counterpart& counterpart, Model& model, std::vector<Part>& parts, const SdfReport& report) {
  if (counterpart.extension->name != keys::table_of<Part>.head.name) return;
  parts.push_back(read_part<Part>(counterpart.values, report));
  while (model.links[parts.back().link].name != counterpart.link) ++parts.back().link;
}

}  // namespace

void add_link_parts(const std::vector<Counterpart>& of_plugins, Model& model, const SdfReport& report) {
  for (const Counterpart& counterpart : of_plugins) {
    add_link_part(counterpart, model, model.fins, report);
    add_link_part(counterpart, model, model.drags, report);
  }
}

template <class Part>
std::vector<Part> read_link_parts(const Element& element, const ModelReading& reading) {
  std::vector<Part> parts;
  for (const Element* const child : element.children())
    if (const auto values = read_as<Part>(child, reading.report))
      parts.push_back(read_part<Part>(*values, reading.report));
  return parts;
}

template std::vector<GripRing> read_link_parts(const Element&, const ModelReading&);
template std::vector<Fin> read_link_parts(const Element&, const ModelReading&);
template std::vector<Drag> read_link_parts(const Element&, const ModelReading&);

}  // namespace cohort::parsing
