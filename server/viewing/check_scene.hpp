#pragma once

#include "idl/messages/scene_messages.hpp"

/// For scenes that came over a network. What does not fit throws messages::CdrError.
namespace cohort::viewing {

/// Every index in a scene is that of something. Returns how many links a frame of it has.
std::size_t check_scene(const messages::Scene& scene);
/// A frame has as many poses as its scene has links.
void check_frame(const messages::SceneFrame& frame, std::size_t links);

}  // namespace cohort::viewing
