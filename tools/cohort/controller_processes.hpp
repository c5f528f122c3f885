#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/session/server.hpp"
#include "tools/cohort/children.hpp"
#include "tools/cohort/log.hpp"
#include "tools/cohort/team_controllers.hpp"

namespace cohort::tool {

/// Selectors for some robots, by ids in ascending order, as short as they can be said: `0..7,9`.
std::string selectors_of(const std::vector<std::uint32_t>& robots);

/// The processes that drive an experiment's robots on this machine: one for each team, or one for each robot; none for
/// teams that people drive. `controllers`: one for each team, in order.
std::vector<Children::Command> controller_processes(const description::Experiment& experiment,
                                                    const std::vector<TeamController>& controllers, bool per_robot,
                                                    const std::vector<std::uint32_t>& domains, const Log& log);

/// Logs what becomes of them; one that fails for good ends the server's run. Both must outlive it.
Children::Listener listener_of_controllers(session::Server& server, Log& log);

}  // namespace cohort::tool
