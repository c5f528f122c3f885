// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "server/description/experiment.hpp"

namespace cohort::bench {

/// Returns robots whose world takes almost no time: bodies in the plane that touch nothing. Each has a camera that sees
/// no robot (61 values) and five actions without a handler (5 values). The delay of the controllers is in ticks.
description::Experiment idle_robots(std::uint32_t robots, std::uint32_t delay);

inline constexpr std::size_t idle_observation_size = 61;  ///< values of a robot
inline constexpr std::size_t idle_command_size = 5;

/// Returns the bytes of an Observation, or of the Commands of all its robots, in the encoding of DDS (CDR with its
/// header).
std::size_t observation_bytes(std::size_t robots);
std::size_t command_bytes(std::size_t robots);

}  // namespace cohort::bench
