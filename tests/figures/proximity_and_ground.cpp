// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/sensing/readings/take_samples.hpp"
#include "tests/figures/figures.hpp"
#include "tests/figures/stand.hpp"

namespace cohort::figures {
namespace {

using description::ProximityTechnique;

constexpr double range = 0.2;                          // thesis, section 3.2.1 [m]
constexpr double cone = 2.0 / 9.0 * std::numbers::pi;  // 40 degrees, the same
constexpr double ring_height = turret_height + 0.02;

description::ProximityRing ring_of(ProximityTechnique technique) {
  description::ProximityRing ring;
  ring.name = "proximity";
  ring.link = turret;
  ring.X_LS.position.z() = ring_height - turret_height;
  ring.count = 15;
  ring.spacing = 2.0 * std::numbers::pi / 15.0;
  ring.ring_radius = turret_radius;
  ring.range = range;
  ring.cone = cone;
  ring.technique = technique;
  return ring;
}

description::Model robot_with(ProximityTechnique technique) {
  description::Model model = tracked_robot();
  model.devices.push_back(ring_of(technique));
  if (technique != ProximityTechnique::samples) return model;
  auto& ring = std::get<description::ProximityRing>(model.devices.back());
  ring.technique = ProximityTechnique::five_rays;
  ring.samples = std::make_shared<const description::Samples>(sensing::take_samples(model, 1, {}));
  ring.technique = ProximityTechnique::samples;
  return model;
}

// Reading of the sensor that faces ahead.
double reading(ProximityTechnique technique, const description::Shape& shape, const Pose& X_WO) {
  Stand stand;
  stand.add(robot_with(technique));
  stand.add(static_shape("static", shape), X_WO);
  return stand.read("proximity/0/reading");
}

struct Named {
  const char* name;
  ProximityTechnique technique;
};

Panel wall_ahead() {
  Panel panel{"Proximity: a wall ahead", "line: 1 - d / 0.2 m", "distance d of the wall [m]", "reading", {}};
  for (const Named& each :
       {Named{"ray", ProximityTechnique::ray}, Named{"random_ray", ProximityTechnique::random_ray},
        Named{"five_rays", ProximityTechnique::five_rays}, Named{"shadow", ProximityTechnique::shadow}}) {
    Series series{each.name, {}};
    for (const double d : evenly(0.005, 0.245, 25))
      series.measured.emplace_back(
          d, reading(each.technique, description::Box{{0.1, 2.0, 2.0}}, at(turret_radius + d + 0.05, 0, 0)));
    if (each.technique == ProximityTechnique::ray) {
      series.closed_form = [](double d) { return std::max(0.0, 1.0 - d / range); };
      series.tolerance = exact;
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

Panel pillar_around() {
  constexpr double pillar = 0.058;
  static constexpr double gap = 0.05;
  constexpr double away = turret_radius + gap + pillar;
  Panel panel{"Proximity: a robot 5 cm away",
              "line: where a ray meets a circle",
              "bearing of the robot [degrees]",
              "reading of the sensor ahead",
              {}};
  for (const Named& each :
       {Named{"ray", ProximityTechnique::ray}, Named{"five_rays", ProximityTechnique::five_rays},
        Named{"shadow", ProximityTechnique::shadow}, Named{"samples", ProximityTechnique::samples}}) {
    Series series{each.name, {}};
    for (const double bearing : evenly(-90.0, 90.0, 61)) {
      const double angle = degree * bearing;
      series.measured.emplace_back(bearing, reading(each.technique, description::Cylinder{pillar, 0.5},
                                                    at(away * std::cos(angle), away * std::sin(angle), ring_height)));
    }
    if (each.technique == ProximityTechnique::ray) {
      series.closed_form = [](double bearing) {
        const double x = away * std::cos(degree * bearing);
        const double y = away * std::sin(degree * bearing);
        if (std::abs(y) >= pillar) return 0.0;
        return std::max(0.0, 1.0 - (x - std::sqrt(pillar * pillar - y * y) - turret_radius) / range);
      };
      series.tolerance = exact;
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

Panel ground_below() {
  static constexpr double ground_range = 0.04;
  static constexpr double place = 0.014;
  const auto measure = [](double d) {
    Stand stand;
    description::Model model = tracked_robot();
    model.devices.push_back(description::GroundSensors{"ground", chassis, {{0.045, 0.0, place}}, ground_range, {}});
    stand.add(model, at(0, 0, d - place));
    return stand.read("ground/0/reading");
  };
  const auto expected = [](double d) { return std::max(0.0, 1.0 - d / ground_range); };
  return {"Ground sensors",
          "line: 1 - d / 0.04 m",
          "distance d of the ground [m]",
          "reading",
          {measured_at(evenly(place, 0.05, 25), measure, expected)}};
}

}  // namespace

Page proximity_and_ground() {
  return {"proximity", "Proximity and ground sensors", {wall_ahead(), pillar_around(), ground_below()}};
}

}  // namespace cohort::figures
