// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/figures/figures.hpp"
#include "tests/figures/stand.hpp"

namespace cohort::figures {
namespace {

constexpr double eye = 0.02;  // in the turret [m]
constexpr double eye_height = turret_height + eye;

struct Air {
  double air;
  double added;
  double spread;
  double operator()(double d) const { return air + added * std::exp(-d * d / (2.0 * spread * spread)); }
};

Panel climate(const std::string& quantity, const Air& expected, const std::string& title, const std::string& label) {
  const auto measure = [&](double d) {
    Stand stand;
    description::Model model = tracked_robot();
    model.devices.push_back(description::ClimateSensor{"climate", turret, {0.0, 0.0, eye}, {}});
    stand.add(model);
    stand.add_emitter(description::ClimateSource{10.0, 0.3, expected.spread}, at(d, 0, eye_height));
    return stand.read("climate/0/" + quantity);
  };
  return {title,
          "line: air + source · exp(-2 d² / m²)",
          "distance d of the source [m]",
          label,
          {measured_at(evenly(0.0, 2.0, 25), measure, expected)}};
}

description::Model seeing_robot(double range) {
  description::Model model = tracked_robot();
  model.devices.push_back(description::OmnidirectionalCamera{"camera", turret, {{0, 0, eye}}, range, -1.0, 1.0, 8, {}});
  return model;
}

Panel camera_bearing() {
  const auto measure = [](double bearing) {
    Stand stand;
    stand.add(seeing_robot(2.0));
    stand.add_emitter(description::Marker{}, at(std::cos(degree * bearing), std::sin(degree * bearing), eye_height));
    return stand.read("camera/0/bearing") / degree;
  };
  return {"Camera: bearing",
          "line: equal",
          "bearing of a spot [degrees]",
          "bearing [degrees]",
          {measured_at(evenly(-175.0, 175.0, 36), measure, std::identity())}};
}

Panel camera_distance() {
  static constexpr double range = 1.5;
  Series distance{"distance [m]", {}};
  Series count{"spots", {}};
  for (const double d : evenly(0.11, 2.01, 39)) {
    Stand stand;
    stand.add(seeing_robot(range));
    stand.add_emitter(description::Marker{}, at(d, 0, eye_height));
    distance.measured.emplace_back(d, stand.read("camera/0/distance"));
    count.measured.emplace_back(d, stand.read("camera/0/count"));
  }
  distance.closed_form = [](double d) { return d <= range ? d : 0.0; };
  count.closed_form = [](double d) { return d <= range ? 1.0 : 0.0; };
  distance.tolerance = count.tolerance = exact;
  return {
      "Camera: distance", "lines: up to its range of 1.5 m", "distance of a spot [m]", "reading", {distance, count}};
}

// A square of walls, a red pillar to the left, a blue box behind, a robot to the right.
Panel panorama() {
  Stand stand;
  description::Model model = tracked_robot();
  description::PanoramicCamera camera;
  camera.name = "film";
  camera.link = turret;
  camera.X_LS.position.z() = eye + 0.03;
  camera.width = 115;
  camera.height = 40;
  camera.min_elevation = -35.0 * degree;
  camera.max_elevation = 25.0 * degree;
  camera.sky = {0.6, 0.75, 0.95};
  model.devices.emplace_back(camera);
  stand.add(model);
  const auto add = [&](const description::Shape& shape, const Eigen::Vector3d& color, const Pose& X_WO) {
    description::Model thing = static_shape("static", shape);
    thing.links[0].color = color;
    stand.add(thing, X_WO);
  };
  const Eigen::Vector3d sand(0.8, 0.7, 0.5);
  for (const double side : {-1.0, 1.0}) {
    add(description::Box{{0.02, 2.0, 0.3}}, sand, at(side, 0, 0.15));
    add(description::Box{{2.0, 0.02, 0.3}}, sand, at(0, side, 0.15));
  }
  add(description::Cylinder{0.06, 0.4}, {0.9, 0.1, 0.1}, at(0, 0.5, 0.2));
  add(description::Box{{0.2, 0.2, 0.2}}, {0.1, 0.2, 0.9}, at(-0.5, 0, 0.1));
  description::Model other = tracked_robot();
  other.links[turret].color = {0.95, 0.5, 0.1};
  stand.add(other, at(0, -0.3, 0));
  Panel panel{"Panorama", "pillar left, box behind, robot right", "bearing [degrees]", "", {}};
  panel.image.width = camera.width;
  panel.image.height = camera.height;
  for (std::size_t i = 0; i < 3 * camera.width * camera.height; ++i)
    panel.image.pixels.push_back(stand.read("film/0/image", i));
  return panel;
}

Panel battery() {
  constexpr double capacity = 40.0;    // [J]
  constexpr double idle = 0.5;         // [W]
  constexpr double damping = 0.2;      // [N m s/rad]
  static constexpr double rate = 1.5;  // [rad/s]
  constexpr double efficiency = 0.5;
  Panel panel{"Battery: at rest, turret turning", "lines: 1 - P t / 40 J", "time t [s]", "charge", {}};
  for (const bool turns : {false, true}) {
    Stand stand;
    description::Model model = held_robot();
    model.joints[0].axis.damping = damping;
    model.devices.push_back(description::VelocityMotor{"turret", 0, rate, 1.0});
    model.devices.push_back(description::Battery{"battery", capacity, 1.0, idle, efficiency, {}});
    stand.add(model);
    stand.command("turret/0/velocity", {turns ? rate : 0.0});
    Series series{turns ? "P = 1.4 W" : "P = 0.5 W", {}};
    for (int tick = 0; tick <= 4000; ++tick) {
      if (tick % 200 == 0) series.measured.emplace_back(stand.time(), stand.read("battery/0/charge"));
      stand.step();
    }
    const double power = idle + (turns ? damping * rate * rate / efficiency : 0.0);
    series.closed_form = [power](double t) { return std::max(0.0, 1.0 - power * t / capacity); };
    series.tolerance = 1e-3;
    panel.series.push_back(std::move(series));
  }
  return panel;
}

}  // namespace

Page surroundings() {
  const description::Climate air;
  return {"surroundings",
          "Climate, cameras and battery",
          {climate("temperature", {air.temperature, 10.0, 0.5}, "Temperature: a source of 10 K", "temperature [K]"),
           climate("humidity", {air.humidity, 0.3, 0.5}, "Humidity: a source of 0.3", "relative humidity"),
           camera_bearing(), camera_distance(), panorama(), battery()}};
}

}  // namespace cohort::figures
