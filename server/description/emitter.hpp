#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "server/core/pose.hpp"

/// What makes an object perceptible to sensors from afar, as plain data: it stands on a link, in a frame E. Frames as
/// in model.hpp; colours are red, green and blue from 0 to 1.
namespace cohort::description {

/// A lamp. What arrives at a distance d [m] is intensity / (constant + linear d + quadratic d^2), and nothing beyond
/// `range`; of a directional one its intensity, everywhere.
struct Light {
  enum class Kind { point, spot, directional };
  Kind kind = Kind::point;
  Eigen::Vector3d color = Eigen::Vector3d::Ones();
  double intensity = 1.0;  ///< of a lamp that falls off with the square of the distance: what arrives at 1 m [1]
  double range = std::numeric_limits<double>::infinity();  ///< [m]
  double constant = 0.0;
  double linear = 0.0;                                      ///< [1/m]
  double quadratic = 1.0;                                   ///< [1/m^2]
  Eigen::Vector3d direction_E = -Eigen::Vector3d::UnitZ();  ///< of a spot or directional light, unit
  double inner_angle = 0.0;  ///< of a spot: full within this angle from the direction [rad]
  double outer_angle = 0.0;  ///< and nothing beyond this one [rad]
  /// Between them by ((cos a - cos outer) / (cos inner - cos outer)) to this power.
  double falloff = 0.0;
};

/// A source of one tone.
struct Sound {
  double frequency = 0.0;  ///< [Hz]
  double intensity = 1.0;  ///< what arrives at 1 m, falling off with the square of the distance [1]
  double range = std::numeric_limits<double>::infinity();  ///< [m]
};

/// A coloured spot that cameras see, of a LED or of something painted.
struct Marker {
  Eigen::Vector3d color = Eigen::Vector3d::Ones();
};

/// Warmth or moisture around a point: at a distance d it adds amount * exp(-d^2 / (2 spread^2)).
struct ClimateSource {
  double temperature = 0.0;  ///< [K]
  double humidity = 0.0;     ///< relative [1]
  double spread = 1.0;       ///< [m]
};

struct Emitter {
  std::string name;  ///< unique in the model
  std::size_t link = 0;
  Pose X_LE;
  bool is_on = true;  ///< at first
  std::variant<Light, Sound, Marker, ClimateSource> what;
};

/// What becomes of an emitter; what is absent, or not of its kind, stays as it is.
struct EmitterChange {
  std::optional<bool> is_on;
  std::optional<double> intensity;       ///< of a light or a sound [1]
  std::optional<double> frequency;       ///< of a sound [Hz]
  std::optional<Eigen::Vector3d> color;  ///< of a light or a marker
  std::optional<double> temperature;     ///< of a climate source [K]
  std::optional<double> humidity;        ///< [1]
};

}  // namespace cohort::description
