// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "server/description/model.hpp"

namespace cohort::description {

/// Returns a hash of the masses, places, joints and surfaces of a model, and of how many shapes and devices it has.
/// Does not depend on names, or on the place of the model in a world.
std::uint64_t fingerprint(const Model& model);

}  // namespace cohort::description
