#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "server/simulation/simulation.hpp"

namespace cohort::figures {

inline constexpr double degree = std::numbers::pi / 180.0;
inline constexpr double exact = 1e-9;  ///< tolerance of what is computed in closed form

Pose at(double x, double y, double z, double yaw = 0.0);
/// Leaning forwards by `pitch` [rad].
Pose leaning(double pitch);

description::Inertial solid_cylinder(double mass, double radius, double length, double z);

/// A robot like the s-bot: 0.7 kg, a chassis with tracks and a turret on a joint, both round. Links 0 and 1, joint 0,
/// device 0.
description::Model tracked_robot();
inline constexpr std::size_t chassis = 0;
inline constexpr std::size_t turret = 1;
inline constexpr double turret_height = 0.055;  ///< z of the turret's link [m]
inline constexpr double turret_radius = 0.058;  ///< [m]

/// The same without its tracks, held by the world.
description::Model held_robot();
void hold(description::Model& model);

description::Model static_shape(const description::Shape& shape);

/// A small world in which devices are measured: on a plane, ticks of 10 ms, one thread. Everything is added before the
/// first tick.
class Stand {
 public:
  Stand();
  /// Returns its index among all objects.
  std::uint32_t add(const description::Model& model, const Pose& X_WM = {});
  void add_emitter(const decltype(description::Emitter::what)& what, const Pose& X_WM);

  void step(int ticks = 1);
  /// Of the robot that was added as number `robot` of them.
  double read(const std::string& channel, std::size_t index = 0, std::uint32_t robot = 0);
  /// The other channels keep their values.
  void command(const std::string& channel, const std::vector<double>& values, std::uint32_t robot = 0);
  double time();  ///< simulated [s]
  Simulation& simulation();

 private:
  static std::size_t offset_of(const std::vector<Channel>& channels, const std::string& name);

  description::Experiment experiment_;
  std::optional<Simulation> simulation_;
  std::vector<std::vector<double>> commands_;
};

}  // namespace cohort::figures
