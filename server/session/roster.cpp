#include "server/session/roster.hpp"

#include "server/core/random.hpp"

namespace cohort::session {
namespace {

std::vector<wire::Channel> to_wire(const std::vector<Channel>& channels) {
  std::vector<wire::Channel> result;
  result.reserve(channels.size());
  for (const Channel& c : channels) result.push_back({c.name, c.unit, c.size, c.lower, c.upper, c.neutral});
  return result;
}

}  // namespace

std::vector<wire::RobotDescription> describe_kinds(const Simulation& simulation) {
  std::vector<wire::RobotDescription> descriptions;
  for (const RobotKind& kind : simulation.kinds())
    descriptions.push_back({static_cast<std::uint32_t>(descriptions.size()), kind.model, to_wire(kind.observation),
                            to_wire(kind.command)});
  return descriptions;
}

std::vector<wire::AdmittedRobot> admit_robots(const description::Experiment& experiment, const Simulation& simulation,
                                              std::span<const std::uint32_t> robots) {
  std::vector<wire::AdmittedRobot> result;
  for (const std::uint32_t robot : robots) {
    const std::string& name = simulation.robot_name(robot);
    const description::Policy& policy = simulation.policy(robot);
    result.push_back({robot, name, simulation.kind_of(robot),
                      RandomStream(experiment.seed, name, "controller").bits(0, 0), policy.period, policy.phase,
                      policy.delay});
  }
  return result;
}

}  // namespace cohort::session
