// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "server/serving/server.hpp"
#include "tools/cli/common/log.hpp"
#include "tools/cli/running/team_controllers.hpp"
#include "tools/common/processes/children.hpp"

namespace cohort::tool {

/// Returns the shortest selectors of some robots, which are given by ids in ascending order: `0..7,9`.
std::string selectors_of(const std::vector<std::uint32_t>& robots);

/// Returns the folder of the first client in `secure`/clients that may drive all robots of a team. Throws
/// std::runtime_error if there is none.
std::filesystem::path identity_for(const description::Experiment& experiment, const description::Team& team,
                                   const std::filesystem::path& secure);

/// Returns the processes that drive an experiment's robots on this machine: one for each team or one for each robot,
/// and none for teams that a user drives. `controllers` has one for each team, in order. `secure` is the folder of
/// identities, or empty. Throws std::runtime_error if no identity may drive a team.
std::vector<Children::Command> controller_processes(const description::Experiment& experiment,
                                                    const std::vector<TeamController>& controllers, bool per_robot,
                                                    const std::vector<std::uint32_t>& domains,
                                                    const std::filesystem::path& secure, const Log& log);

/// Returns the process through which ROS 2 nodes drive these robots of an experiment. Throws std::runtime_error as
/// above.
Children::Command ros2_bridge_process(const description::Experiment& experiment,
                                      const std::vector<std::uint32_t>& robots, const std::string& server,
                                      std::uint32_t domain, const std::filesystem::path& secure);

/// Returns a listener that logs events of the processes; a process that fails for good ends the server's run. Server
/// and log must outlive it.
Children::Listener listener_of_controllers(session::Server& server, Log& log);

}  // namespace cohort::tool
