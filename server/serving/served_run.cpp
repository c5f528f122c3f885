// SPDX-License-Identifier: Apache-2.0
#include "server/serving/served_run.hpp"

#include <algorithm>
#include <optional>
#include <set>

namespace cohort::session {

ServedRun::ServedRun(const description::Experiment& its_experiment, Simulation& its_simulation,
                     const RunOptions& options, const RunListener& listener, std::uint32_t its_number,
                     std::uint64_t first_epoch)
    : experiment(its_experiment),
      simulation(its_simulation),
      number(its_number),
      monitor(its_experiment, its_simulation, options, listener),
      exchange(its_simulation),
      leases(its_simulation.robot_count(), first_epoch),
      robots_at_first(static_cast<std::uint32_t>(its_experiment.world.robots.size())) {
  add_newcomers();
}

bool ServedRun::add_newcomers() {
  const auto before = static_cast<std::uint32_t>(was_driven.size());
  if (before == simulation.robot_count()) return false;
  for (std::uint32_t robot = before; robot < simulation.robot_count(); ++robot)
    if (!simulation.policy(robot).required) undemanding.push_back(robot);
  was_driven.resize(simulation.robot_count());
  leases.note_robots(simulation.robot_count());
  exchange.add_newcomers();
  return true;
}

std::vector<std::uint32_t> ServedRun::undriven_newcomers() const {
  std::vector<std::uint32_t> robots;
  for (std::uint32_t robot = robots_at_first; robot < was_driven.size(); ++robot)
    if (!was_driven[robot] && simulation.policy(robot).required && simulation.is_present(robot) &&
        !exchange.barrier().is_detached(robot))
      robots.push_back(robot);
  return robots;
}

bool ServedRun::is_gone(std::uint32_t robot) const {
  return robot >= robots_at_first && !simulation.is_present(robot) && exchange.barrier().unanswered(robot).empty();
}

bool ServedRun::is_ready() const {
  for (std::uint32_t robot = 0; robot < robots_at_first; ++robot)
    if (!leases.holder(robot) && simulation.policy(robot).required && !exchange.barrier().is_detached(robot))
      return false;
  return undriven_newcomers().empty();
}

std::vector<std::uint32_t> ServedRun::awaited(bool is_held) const {
  if (started && is_held) return {};
  const std::vector<std::uint32_t> newcomers = undriven_newcomers();
  if (started) return newcomers.empty() ? exchange.barrier().awaited() : newcomers;
  std::vector<std::uint32_t> robots;
  for (std::uint32_t robot = 0; robot < robots_at_first; ++robot)
    if (!leases.holder(robot) && simulation.policy(robot).required) robots.push_back(robot);
  robots.insert(robots.end(), newcomers.begin(), newcomers.end());
  return robots;
}

std::chrono::nanoseconds ServedRun::waiting() const {
  if (!started) return std::chrono::nanoseconds(0);
  return RunMonitor::Clock::now().time_since_epoch() - exchange.barrier().opened_at();
}

bool ServedRun::is_awaited(std::uint64_t client) const {
  const lockstep::Leases::Lease* lease = leases.lease(client);
  return lease != nullptr &&
         std::ranges::any_of(lease->robots, [&](auto robot) { return exchange.barrier().is_awaited(robot); });
}

std::vector<std::uint64_t> ServedRun::frames_under_way(const std::vector<std::uint32_t>& robots) const {
  std::set<std::uint64_t> ticks;
  for (const std::uint32_t robot : robots)
    for (const std::uint64_t tick : exchange.barrier().unanswered(robot))
      if (is_out(tick) && tick + simulation.policy(robot).delay >= simulation.tick()) ticks.insert(tick);
  return {ticks.begin(), ticks.end()};
}

// At a boundary, the frames of its tick were not sent yet.
bool ServedRun::is_out(std::uint64_t tick) const {
  return tick < simulation.tick() || (!exchange.barrier().is_fresh() && tick <= exchange.barrier().tick());
}

std::uint64_t ServedRun::due_tick_of(const std::vector<std::uint32_t>& robots) const {
  if (started)
    if (const auto frames = frames_under_way(robots); !frames.empty()) return frames.front();
  const std::uint64_t now = simulation.tick();
  std::optional<std::uint64_t> next;
  for (const std::uint32_t robot : robots) {
    const description::Policy& policy = simulation.policy(robot);
    const std::uint64_t from = is_out(now) ? now + 1 : now;
    const std::uint64_t after = from <= policy.phase ? 0 : (from - policy.phase + policy.period - 1) / policy.period;
    const std::uint64_t tick = policy.phase + after * policy.period;
    next = std::min(next.value_or(tick), tick);
  }
  return next.value_or(now);
}

void ServedRun::see_who_drives() {
  for (const std::uint32_t robot : undemanding) {
    const auto holder = leases.holder(robot);
    exchange.barrier().set_driven(robot, holder && leases.lease(*holder)->alive);
  }
}

std::string ServedRun::teams_text(const std::vector<std::uint32_t>& robots) const {
  std::string text;
  for (const description::Team& team : simulation.experiment().teams)
    if (std::ranges::any_of(robots, [&](auto robot) { return std::ranges::count(team.robots, robot) > 0; }))
      text += (text.empty() ? "team '" : ", team '") + team.name + "'";
  return text;
}

std::string ServedRun::robots_text(const std::vector<std::uint32_t>& robots) const {
  if (robots.empty()) return "no robot";
  std::string text = simulation.robot_name(robots.front());
  if (robots.size() > 1) text += " and " + std::to_string(robots.size() - 1) + " more";
  return text;
}

}  // namespace cohort::session
