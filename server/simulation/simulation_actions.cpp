// What is done to a running simulation from outside.

#include <stdexcept>

#include "server/simulation/action_events.hpp"
#include "server/simulation/simulation.hpp"

namespace cohort {

std::string Simulation::act(const Action& action) {
  std::string done = act_unsensed(action);
  sense();
  return done;
}

std::vector<ActionResult> Simulation::act(std::span<const Action> actions) {
  std::vector<ActionResult> results;
  results.reserve(actions.size());
  bool is_changed = false;
  for (const Action& action : actions) {
    try {
      results.push_back({true, act_unsensed(action)});
      is_changed = true;
    } catch (const std::invalid_argument& error) {
      results.push_back({false, error.what()});
    }
  }
  if (is_changed) sense();
  return results;
}

std::string Simulation::act_unsensed(const Action& action) {
  note_change();
  if (const auto* const spawn = std::get_if<SpawnObject>(&action)) return spawn_object(*spawn);
  return schedule_.act_from_outside(event_of(action, {experiment_.world, *world_, objects_}), tick_);
}

std::string Simulation::spawn_object(const SpawnObject& spawn) {
  const Pose X_WM = checked_pose(spawn.X_WM);
  check_utf8(spawn.model, "the model");
  const std::size_t models_before = spawned_models_.size();
  try {
    const std::size_t model = spawned_models_.find_or_add(spawn.model);
    const description::Model& described = experiment_.world.models[model];
    if (described.is_robot())
      throw std::invalid_argument(
          "'" + described.name +
          "' is a robot, and robots cannot be spawned yet: let an event of the experiment add it");
    const std::string name = name_of_new(spawn, described.name, objects_);
    add_object(name, model, X_WM);
    return "spawn '" + name + "' of model '" + described.name + "'";
  } catch (const std::invalid_argument&) {
    spawned_models_.shrink(models_before);
    throw;
  }
}

}  // namespace cohort
