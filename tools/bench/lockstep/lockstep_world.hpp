#pragma once

#include <cstddef>
#include <cstdint>

#include "server/description/experiment.hpp"

namespace cohort::bench {

/// Robots whose world costs next to nothing: bodies in the plane that touch nothing, with a camera that sees nobody
/// (61 values) and five actions that nobody handles (5 values). The controllers' delay is in ticks.
description::Experiment idle_robots(std::uint32_t robots, std::uint32_t delay);

inline constexpr std::size_t idle_observation_size = 61;  ///< values of a robot
inline constexpr std::size_t idle_command_size = 5;

/// Bytes of an Observation, or of all its robots' Commands, as DDS encodes them (CDR, its own header included).
std::size_t observation_bytes(std::size_t robots);
std::size_t command_bytes(std::size_t robots);

}  // namespace cohort::bench
