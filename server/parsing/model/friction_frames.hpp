#pragma once

#include "server/parsing/model/read_model.hpp"

namespace cohort::parsing {

/// Returns the element with the friction of a collision that applies: <ode>, or else <bullet>; nullptr if it has none.
const Element* friction_of(const Element& collision);

/// Sets the directions of friction that `gz:expressed_in` of <fdir1> defines in another frame, for a body whose links
/// are complete and in their final order. A frame of another link that may move is kept; directions in all other frames
/// are converted to the frame of their collision. `frames`: those of the whole model.
void set_friction_frames(const Frames& frames, const ModelReading& reading, Model& body);

}  // namespace cohort::parsing
