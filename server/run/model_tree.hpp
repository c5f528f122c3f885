// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/include/cohort/kinematic_tree.hpp"
#include "server/description/model.hpp"

namespace cohort::session {

/// Returns the kinematic tree of robots of this model, as clients receive it.
KinematicTree tree_of(const description::Model& model);

}  // namespace cohort::session
