// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "server/core/text.hpp"
#include "server/parsing/model/read_model.hpp"
#include "server/parsing/model/read_values.hpp"

namespace cohort::parsing {
namespace {

double number(const Element* element, double by_default, const SdfReport& report) {
  if (!is_written(element)) return by_default;
  const std::string text = element->text();
  if (const std::optional<double> value = parse_real(text); value && !std::isnan(*value)) return *value;
  report.problem(element, "'" + text + "' is not a number");
  return by_default;
}

Light read_light_values(const Element* element, const SdfReport& report) {
  Light light;
  const std::string type = element->attribute("type");
  if (type == "spot") light.kind = Light::Kind::spot;
  if (type == "directional") light.kind = Light::Kind::directional;
  if (type != "spot" && type != "directional" && type != "point")
    report.flaw(element, "expected the type point, directional or spot, not '" + type + "'", "the light is a point");
  if (const Element* const color = element->child("diffuse")) light.color = color->color().head<3>();
  light.intensity = number(find(element, {"intensity"}), 1.0, report);
  const Element* const attenuation = find(element, {"attenuation"});
  if (attenuation != nullptr &&
      (is_written(find(attenuation, {"range"})) || is_written(find(attenuation, {"constant"})) ||
       is_written(find(attenuation, {"linear"})) || is_written(find(attenuation, {"quadratic"})))) {
    light.range = number(find(attenuation, {"range"}), 10.0, report);
    light.constant = number(find(attenuation, {"constant"}), 1.0, report);
    light.linear = number(find(attenuation, {"linear"}), 1.0, report);
    light.quadratic = number(find(attenuation, {"quadratic"}), 0.0, report);
    const bool is_valid = light.constant >= 0.0 && light.linear >= 0.0 && light.quadratic >= 0.0 &&
                          light.constant + light.linear + light.quadratic > 0.0 && light.range >= 0.0;
    if (!is_valid && report.flaw(attenuation, "expected numbers >= 0, and one of the three factors > 0",
                                 "these values are ignored: the intensity falls with 1/distance, up to 10 m"))
      light.constant = 0.0, light.linear = 1.0, light.quadratic = 0.0, light.range = 10.0;
  }
  if (light.intensity < 0.0 || !std::isfinite(light.intensity))
    report.problem(find(element, {"intensity"}), "expected a finite intensity >= 0");
  const Element* const direction = find(element, {"direction"});
  const Eigen::Vector3d written = element->vector("direction");
  if (const auto unit = written_unit_vector(direction))
    light.direction_E = *unit;
  else if (written.norm() > 0.0 && written.allFinite())
    light.direction_E = written.normalized();
  else if (direction != nullptr)
    report.flaw(direction, "expected a direction that is not zero", "the default direction is used");
  if (light.kind == Light::Kind::spot) {
    // SDF gives full cone angles.
    light.inner_angle = 0.5 * number(find(element, {"spot", "inner_angle"}), 0.0, report);
    light.outer_angle = 0.5 * number(find(element, {"spot", "outer_angle"}), 0.0, report);
    light.falloff = number(find(element, {"spot", "falloff"}), 0.0, report);
    const bool is_cone = light.inner_angle >= 0.0 && light.outer_angle >= light.inner_angle && light.falloff >= 0.0;
    if (!is_cone && report.flaw(find(element, {"spot"}) != nullptr ? find(element, {"spot"}) : element,
                                "expected 0 <= inner_angle <= outer_angle, and a falloff >= 0",
                                "the intensity is uniform within the cone"))
      light.inner_angle = light.outer_angle = std::max(0.0, light.outer_angle), light.falloff = 0.0;
  }
  return light;
}

template <class Kind>
Emitter read_emitter(const ExtensionValues& values, const SdfReport& report) {
  Emitter emitter;
  emitter.name = values.name();
  read_values<Kind>(values, emitter);
  read_values<Kind>(values, emitter.what.emplace<Kind>());
  if constexpr (std::is_same_v<Kind, Marker>) check_color(values, "color", report);
  return emitter;
}

}  // namespace

Emitter read_light(const Element& element, const Frames& frames, const ModelReading& reading) {
  Emitter emitter;
  emitter.name = name_of(element);
  emitter.X_LE = resolved_pose(element, frames, reading);
  emitter.what = read_light_values(&element, reading.report);
  return emitter;
}

std::vector<Emitter> read_emitters(const Element& element, const Frames& frames, const ModelReading& reading) {
  std::vector<Emitter> emitters;
  for (const Element* const light : children_of(element, "light"))
    emitters.push_back(read_light(*light, frames, reading));
  for (const Element* const child : element.children())
    keys::for_kinds_in(keys::emitters, [&]<class Kind>(std::type_identity<Kind>) {
      if (const auto values = read_as<Kind>(child, reading.report))
        emitters.push_back(read_emitter<Kind>(*values, reading.report));
    });
  return emitters;
}

}  // namespace cohort::parsing
