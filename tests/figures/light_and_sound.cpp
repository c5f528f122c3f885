// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/figures/figures.hpp"
#include "tests/figures/stand.hpp"

namespace cohort::figures {
namespace {

constexpr double sensor_height = 0.042;  // in the turret [m]
constexpr double z = turret_height + sensor_height;

// Thesis, section 3.2.3 and figure 3.2.
double saturated(double x) { return 2.0 / (1.0 + std::exp(-x)) - 1.0; }

description::Model perceiving_robot() {
  description::Model model = tracked_robot();
  description::LightSensors light;
  light.name = "light";
  light.link = turret;
  light.X_LS.position.z() = sensor_height;
  light.count = 8;
  light.spacing = 0.25 * std::numbers::pi;
  model.devices.emplace_back(light);
  description::Microphones microphones;
  microphones.name = "microphones";
  microphones.link = turret;
  microphones.places_L = {{0.0, 0.0, sensor_height}};
  microphones.bands = {{100.0, 8000.0}};
  model.devices.emplace_back(microphones);
  return model;
}

// Shines and sounds; its LED is at x = 0.06 m of its turret, its loudspeaker in the middle.
description::Model emitting_robot() {
  description::Model model = tracked_robot();
  description::LedRing leds;
  leds.name = "leds";
  leds.link = turret;
  leds.X_LS.position.z() = sensor_height;
  leds.count = 1;
  leds.ring_radius = 0.06;
  leds.intensity = 1.0;
  model.devices.emplace_back(leds);
  description::Loudspeaker speaker;
  speaker.name = "speaker";
  speaker.link = turret;
  speaker.X_LE.position.z() = sensor_height;
  speaker.max_frequency = 8000.0;
  speaker.max_intensity = 4.0;
  model.devices.emplace_back(speaker);
  return model;
}

description::Light lamp(double intensity) {
  description::Light light;
  light.intensity = intensity;
  return light;
}

// `source` gives what stands at a distance, by its intensity.
template <class Source>
Panel by_distance(const std::string& title, const std::string& of, const std::string& channel, Source source) {
  Panel panel{title, "lines: 2 / (1 + exp(-I / d²)) - 1", "distance d of the " + of + " [m]", "reading", {}};
  for (const double intensity : {1.0, 0.2}) {
    const auto measure = [&](double d) {
      Stand stand;
      stand.add(perceiving_robot());
      stand.add_emitter(source(intensity), at(d, 0, z));
      return stand.read(channel);
    };
    panel.series.push_back(measured_at(
        evenly(0.15, 3.0, 39), measure, [intensity](double d) { return saturated(intensity / (d * d)); }, exact,
        intensity == 1.0 ? "I = 1" : "I = 0.2"));
  }
  return panel;
}

Panel light_by_distance() { return by_distance("Light: distance", "lamp", "light/0/reading", lamp); }

Panel sound_by_distance() {
  return by_distance("Microphones: distance", "source", "microphones/0/intensity", [](double intensity) {
    return description::Sound{440.0, intensity};
  });
}

Panel light_by_bearing() {
  Panel panel{"Light: bearing",
              "lines: sum of cosines; a second lamp is ahead",
              "bearing of a lamp, 1 m away [degrees]",
              "reading of the sensor ahead",
              {}};
  for (const bool is_alone : {true, false}) {
    const double ahead = is_alone ? 0.0 : 1.0;
    const auto measure = [&](double bearing) {
      Stand stand;
      stand.add(perceiving_robot());
      stand.add_emitter(lamp(1.0), at(std::cos(degree * bearing), std::sin(degree * bearing), z));
      if (!is_alone) stand.add_emitter(lamp(1.0), at(1, 0, z));
      return stand.read("light/0/reading");
    };
    panel.series.push_back(measured_at(
        evenly(-180.0, 180.0, 49), measure,
        [ahead](double bearing) { return saturated(ahead + std::max(0.0, std::cos(degree * bearing))); }, exact,
        is_alone ? "one lamp" : "two lamps"));
  }
  return panel;
}

Panel light_behind_a_screen() {
  static constexpr double half_width = 0.1;
  const auto measure = [](double y) {
    Stand stand;
    stand.add(perceiving_robot());
    stand.add_emitter(lamp(1.0), at(1, 0, z));
    stand.add(static_shape("static", description::Box{{0.02, 2.0 * half_width, 0.4}}), at(0.5, y, 0.2));
    return stand.read("light/0/reading");
  };
  const auto expected = [](double y) { return std::abs(y) < half_width ? 0.0 : saturated(1.0); };
  return {"Light: a screen of 0.2 m",
          "line: 0 while the lamp is hidden",
          "lateral offset of the screen [m]",
          "reading",
          {measured_at(evenly(-0.205, 0.205, 42), measure, expected)}};
}

// Robots emit what they are told; it is perceived one tick later.
double perceived(const std::string& channel, const std::vector<double>& command, const std::string& reading,
                 double away) {
  Stand stand;
  stand.add(perceiving_robot());
  stand.add(emitting_robot(), at(away, 0, 0, std::numbers::pi));
  stand.command(channel, command, 1);
  if (channel.starts_with("speaker/")) stand.command("speaker/0/frequency", {440.0}, 1);
  stand.step();
  return stand.read(reading);
}

constexpr double after_a_tick = 1e-5;  // tolerance: the robots settle by a hair in the first one

Panel loudspeaker() {
  const auto measure = [](double intensity) {
    return perceived("speaker/0/intensity", {intensity}, "microphones/0/intensity", 1.0);
  };
  return {"Loudspeaker, 1 m away",
          "line: 2 / (1 + exp(-I)) - 1",
          "commanded intensity I",
          "reading of a microphone",
          {measured_at(evenly(0.0, 4.0, 21), measure, saturated, after_a_tick)}};
}

Panel led() {
  static constexpr double gap = 0.5;
  const auto measure = [](double brightness) {
    return perceived("leds/0/color", {brightness, brightness, brightness}, "light/0/reading", gap + 0.06);
  };
  const auto expected = [](double brightness) { return saturated(brightness / (gap * gap)); };
  return {"LED as a lamp, 0.5 m away",
          "line: 2 / (1 + exp(-b / d²)) - 1",
          "commanded brightness b",
          "reading of a light sensor",
          {measured_at(evenly(0.0, 1.0, 21), measure, expected, after_a_tick)}};
}

}  // namespace

Page light_and_sound() {
  return {
      "light_and_sound",
      "Light sensors, microphones, LEDs and loudspeakers",
      {light_by_distance(), light_by_bearing(), light_behind_a_screen(), sound_by_distance(), loudspeaker(), led()}};
}

}  // namespace cohort::figures
