// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/hosting/plugin_loader.hpp"
#include "server/description/experiment.hpp"
#include "server/simulation/simulation.hpp"
#include "tools/cli/running/keyboard.hpp"

namespace cohort::tool {

/// The controller of a team.
struct TeamController {
  std::optional<LoadedPlugin> plugin;  ///< none: a user with `cohort teleop`, or no controller

  bool is_started() const { return plugin.has_value(); }
  ControllerKind kind() const;
};

bool has_keyboard(const description::Experiment& experiment);

/// Checks that the plugins of an experiment exist and can be loaded, without loading them. Throws
/// description::InputError.
void check_controllers(const description::Experiment& experiment);

/// Loads the controllers of the experiment's teams, and returns them in the same order. A relative path is looked up
/// beside the experiment. Throws description::InputError.
std::vector<TeamController> load_controllers(const description::Experiment& experiment);

/// Starts and discards a controller of each team for one robot of each kind in the team. This finds errors in
/// parameters and channels before the run. Throws description::InputError.
void try_controllers(const description::Experiment& experiment, const Simulation& simulation,
                     const std::vector<TeamController>& controllers);

}  // namespace cohort::tool
