#pragma once

#include <vector>

#include "client_sdk/src/plugin_loader.hpp"
#include "server/description/experiment.hpp"

namespace cohort::tool {

/// The plugins of the experiment's teams, in their order. A controller named by a relative path is looked for beside
/// the experiment. Throws description::InputError.
std::vector<LoadedPlugin> load_controllers(const description::Experiment& experiment);

}  // namespace cohort::tool
