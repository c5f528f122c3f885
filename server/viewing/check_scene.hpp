// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/scene_messages.hpp"

/// Validation of scenes from the network. Invalid scenes throw messages::CdrError.
namespace cohort::viewing {

/// Checks every index in a scene. Returns the number of links in a frame of it.
std::size_t check_scene(const messages::Scene& scene);
/// Checks that a frame has as many poses as its scene has links.
void check_frame(const messages::SceneFrame& frame, std::size_t links);

}  // namespace cohort::viewing
