// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "server/core/pose.hpp"

/// Emitters, which sensors perceive from a distance, as plain data. An emitter is on a link, in a frame E. Frames as in
/// model.hpp; colours are red, green and blue from 0 to 1.
namespace cohort::description {

/// A lamp. The intensity at a distance d [m] is intensity / (constant + linear d + quadratic d^2), and 0 beyond
/// `range`; for a directional lamp it is the intensity everywhere.
struct Light {
  enum class Kind { point, spot, directional };
  Kind kind = Kind::point;
  Eigen::Vector3d color = Eigen::Vector3d::Ones();
  double intensity = 1.0;                                  ///< at 1 m, for a lamp with inverse-square attenuation [1]
  double range = std::numeric_limits<double>::infinity();  ///< [m]
  double constant = 0.0;
  double linear = 0.0;                                      ///< [1/m]
  double quadratic = 1.0;                                   ///< [1/m^2]
  Eigen::Vector3d direction_E = -Eigen::Vector3d::UnitZ();  ///< for a spot or directional light, unit
  double inner_angle = 0.0;  ///< for a spot: full intensity within this angle from the direction [rad]
  double outer_angle = 0.0;  ///< zero intensity beyond this angle [rad]
  /// Exponent of the decrease between the two angles: ((cos a - cos outer) / (cos inner - cos outer))^falloff.
  double falloff = 0.0;
};

/// A source of one tone.
struct Sound {
  double frequency = 0.0;                                  ///< [Hz]
  double intensity = 1.0;                                  ///< at 1 m; it decreases with the square of the distance [1]
  double range = std::numeric_limits<double>::infinity();  ///< [m]
};

/// A coloured spot that cameras see: an LED or a painted spot.
struct Marker {
  Eigen::Vector3d color = Eigen::Vector3d::Ones();
};

/// A source of warmth or moisture around a point: at a distance d it adds amount * exp(-d^2 / (2 spread^2)).
struct ClimateSource {
  double temperature = 0.0;  ///< [K]
  double humidity = 0.0;     ///< relative [1]
  double spread = 1.0;       ///< [m]
};

struct Emitter {
  std::string name;  ///< unique in the model
  std::size_t link = 0;
  Pose X_LE;
  bool is_on = true;  ///< initial state
  std::variant<Light, Sound, Marker, ClimateSource> what;
};

/// A change of an emitter; values that are absent or do not apply to its kind stay unchanged.
struct EmitterChange {
  std::optional<bool> is_on;
  std::optional<double> intensity;       ///< for a light or a sound [1]
  std::optional<double> frequency;       ///< for a sound [Hz]
  std::optional<Eigen::Vector3d> color;  ///< for a light or a marker
  std::optional<double> temperature;     ///< for a climate source [K]
  std::optional<double> humidity;        ///< [1]
};

}  // namespace cohort::description
