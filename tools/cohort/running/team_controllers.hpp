#pragma once

#include <optional>
#include <vector>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/hosting/plugin_loader.hpp"
#include "server/description/experiment.hpp"
#include "server/simulation/simulation.hpp"
#include "tools/cohort/running/keyboard.hpp"

namespace cohort::tool {

/// What drives a team.
struct TeamController {
  std::optional<LoadedPlugin> plugin;  ///< none: people, by `cohort teleop`, or nobody

  bool is_started() const { return plugin.has_value(); }
  ControllerKind kind() const;
};

bool has_keyboard(const description::Experiment& experiment);

/// Checks that the plugins of an experiment are there and can be loaded, without loading them. Throws
/// description::InputError.
void check_controllers(const description::Experiment& experiment);

/// Loads the controllers of the experiment's teams. Returns them in their order. One that is named by a relative path
/// is looked for beside the experiment. Throws description::InputError.
std::vector<TeamController> load_controllers(const description::Experiment& experiment);

/// Starts a controller of each team for one robot of each kind that the team has, and throws it away: so mistakes in
/// parameters and channels are found before anything runs. Throws description::InputError.
void try_controllers(const description::Experiment& experiment, const Simulation& simulation,
                     const std::vector<TeamController>& controllers);

}  // namespace cohort::tool
