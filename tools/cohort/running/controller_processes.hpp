#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "server/serving/server.hpp"
#include "tools/cohort/cli/log.hpp"
#include "tools/cohort/running/team_controllers.hpp"
#include "tools/processes/children.hpp"

namespace cohort::tool {

/// Selectors for some robots, by ids in ascending order, as short as they can be said: `0..7,9`.
std::string selectors_of(const std::vector<std::uint32_t>& robots);

/// The folder of the first client in `secure`/clients that may drive all robots of a team. Throws std::runtime_error if
/// there is none.
std::filesystem::path identity_for(const description::Experiment& experiment, const description::Team& team,
                                   const std::filesystem::path& secure);

/// The processes that drive an experiment's robots on this machine: one for each team, or one for each robot; none for
/// teams that people drive. `controllers`: one for each team, in order. `secure`: folder of identities, or empty.
/// Throws std::runtime_error if no identity of it may drive a team.
std::vector<Children::Command> controller_processes(const description::Experiment& experiment,
                                                    const std::vector<TeamController>& controllers, bool per_robot,
                                                    const std::vector<std::uint32_t>& domains,
                                                    const std::filesystem::path& secure, const Log& log);

/// Logs what becomes of them; one that fails for good ends the server's run. Both must outlive it.
Children::Listener listener_of_controllers(session::Server& server, Log& log);

}  // namespace cohort::tool
