// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort::tool {

/// The direction of view. In the viewer's frame V, x points to the right, y upwards, and z towards the viewer.
enum class Viewpoint {
  above,  ///< V is W
  side,   ///< x of V is that of W, y of V is z of W
};

}  // namespace cohort::tool
