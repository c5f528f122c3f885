#pragma once

namespace cohort::tool {

/// Who looks at a run: in their frame V x goes to the right, y upwards, and z towards them.
enum class Viewpoint {
  above,  ///< V is W
  side,   ///< x of V is that of W, y of V is z of W
};

}  // namespace cohort::tool
