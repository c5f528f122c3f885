// SPDX-License-Identifier: Apache-2.0
#include "server/placement/place.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "server/core/text.hpp"
#include "server/placement/check_detachable_joints.hpp"

namespace cohort::placement {
namespace {

using Drawn = std::vector<std::vector<Placed>>;  // by population

std::size_t end_of(const Population& population) {
  return population.first + population.numbers.size() * population.bodies;
}

bool has_same_instances(const World& world, const Drawn& drawn) {
  return std::ranges::equal(drawn, world.populations, [](const auto& places, const Population& population) {
    return std::ranges::equal(places, population.numbers, {}, &Placed::number);
  });
}

void move_instances(World& world, const Drawn& drawn) {
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    std::size_t next = world.populations[i].first;
    for (const Placed& each : drawn[i])
      for (std::size_t body = 0; body < world.populations[i].bodies; ++body) world.instances[next++].X_WM = each.X_WM;
  }
}

Problem problem_at(Problem place, std::string message) {
  place.message = std::move(message);
  return place;
}

// Makes an instance; returns false if its name is taken.
bool make_instance(World& world, const Population& population, const Placed& placed, std::set<std::string>& names,
                   std::vector<Problem>& problems) {
  const std::string& model_name = world.models[population.model].name;
  const std::string name = population.name + "/" + model_name + "_" + std::to_string(placed.number);
  for (std::size_t model = population.model; model < population.model + population.bodies; ++model) {
    const std::string own = name + world.models[model].name.substr(model_name.size());
    if (!names.insert(own).second) {
      problems.push_back(problem_at(population.place, "another instance has the name '" + name + "'"));
      return false;
    }
    world.instances.push_back({own, model, placed.X_WM});
  }
  return true;
}

// Makes the instances of all populations, up to the first problem.
void make_instances(World& world, const Drawn& drawn, std::set<std::string>& names, std::vector<Problem>& problems) {
  bool goes_on = true;
  for (std::size_t i = 0; i < world.populations.size(); ++i) {
    Population& population = world.populations[i];
    population.first = world.instances.size();
    population.numbers.clear();
    goes_on = goes_on && i < drawn.size();
    for (std::size_t n = 0; goes_on && n < drawn[i].size(); ++n) {
      goes_on = make_instance(world, population, drawn[i][n], names, problems);
      if (goes_on) population.numbers.push_back(drawn[i][n].number);
    }
  }
}

// Finds the objects of breakable joints, in a world that does not yet have the instances that events add.
void find_joined(World& world, const std::vector<Instance>& before, std::vector<Problem>& problems) {
  if (world.breakable_joints.empty()) return;
  std::map<std::string, std::size_t> places;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < world.instances.size(); ++i) {
    places.emplace(world.instances[i].name, i);
    names.push_back(world.instances[i].name);
  }
  const auto find = [&](std::size_t& object, const Problem& place) {
    const Instance& joined = before[object];
    const auto found = places.find(joined.name);
    if (found != places.end() && world.instances[found->second].model == joined.model)
      object = found->second;
    else
      problems.push_back(
          problem_at(place, "there is no object '" + joined.name + "'" + suggestion(joined.name, names)));
  };
  for (BreakableJoint& joint : world.breakable_joints) {
    find(joint.first, joint.first_place);
    find(joint.second, joint.second_place);
  }
}

void make_instances_again(World& world, const Drawn& drawn, std::vector<Problem>& problems) {
  const auto first = static_cast<std::ptrdiff_t>(world.populations.front().first);
  const auto behind = static_cast<std::ptrdiff_t>(end_of(world.populations.back()));
  const std::vector<Instance> before = std::move(world.instances);
  world.instances.assign(before.begin(), before.begin() + first);
  std::set<std::string> names;
  for (const Instance& instance : world.instances) names.insert(instance.name);
  make_instances(world, drawn, names, problems);
  find_joined(world, before, problems);
  for (auto instance = before.begin() + behind; instance != before.end(); ++instance) {
    if (!names.insert(instance->name).second)
      problems.push_back({world.file, 0, "", "another object has the name '" + instance->name + "'"});
    world.instances.push_back(*instance);
  }
}

}  // namespace

bool place(World& world, const Placer& placer, std::uint64_t seed, std::vector<Problem>& problems) {
  const Drawn drawn = placer.draw(seed, problems);
  if (!problems.empty()) return false;
  if (has_same_instances(world, drawn)) {
    move_instances(world, drawn);
    return true;
  }
  make_instances_again(world, drawn, problems);
  set_robots(world);
  if (problems.empty()) check_instances(world, problems);
  return false;
}

void add_populations(World& world, std::uint64_t seed, std::set<std::string>& names, std::vector<Problem>& problems) {
  if (world.populations.empty()) return;
  for (Population& population : world.populations) population.first = world.instances.size();
  make_instances(world, Placer(world).draw(seed, problems), names, problems);
}

void set_robots(World& world) {
  world.robots.clear();
  for (std::size_t i = 0; i < world.instances.size(); ++i)
    if (world.models[world.instances[i].model].is_robot()) world.robots.push_back(i);
}

void check_instances(World& world, std::vector<Problem>& problems) {
  world.warnings.resize(world.warnings.size() - world.seed_warnings);
  const std::size_t lasting = world.warnings.size();
  check_detachable_joints(world, problems);
  for (const Population& population : world.populations)
    if (population.numbers.size() < population.count)
      world.warnings.push_back(
          problem_at(population.placement_place, how_many_fit(population.numbers.size(), population.count)));
  world.seed_warnings = world.warnings.size() - lasting;
}

}  // namespace cohort::placement
