// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/world_in_code.hpp"

namespace cohort::test {

enum class Obstacles { fixed, drawn };

/// Returns a walled arena of 4 m x 4 m with 24 obstacles, in rows or in a population with random places. One robot is
/// in a population that is placed after them. The populations are not placed yet.
inline description::World arena_of_obstacles(Obstacles obstacles) {
  using namespace description;
  World world;
  world.name = "arena";
  place(world, static_shape("floor", Plane{}), "floor", {});
  for (const double side : {-2.0, 2.0}) {
    place(world, static_shape("wall", Box{{0.02, 4.0, 0.3}}), "wall_x" + std::to_string(side), at(side, 0.0, 0.15));
    place(world, static_shape("wall", Box{{4.0, 0.02, 0.3}}), "wall_y" + std::to_string(side), at(0.0, side, 0.15));
  }
  const Model post = static_model("post", {{"collision", at(0.0, 0.0, 0.1), Box{{0.2, 0.1, 0.2}}, {}}});
  world.models.push_back(post);
  const std::size_t model = world.models.size() - 1;
  if (obstacles == Obstacles::fixed)
    for (int i = 0; i < 24; ++i)
      place(world, model, "post_" + std::to_string(i), at(-1.5 + 0.6 * (i % 6), -1.2 + 0.8 * (i / 6), 0.0, 0.1 * i));
  Model robot = static_shape("robot", Cylinder{0.058, 0.1});
  robot.is_static = false;
  robot.links[0].inertial = solid_cylinder(0.7, 0.058, 0.1, 0.0);
  world.models.push_back(robot);
  const auto add_population = [&](const std::string& name, std::size_t which, std::uint64_t count) {
    Population& population = world.populations.emplace_back();
    population.name = name;
    population.model = which;
    population.count = count;
    population.layout = UniformLayout{{-1.9, -1.9}, {1.9, 1.9}};
    population.gap = 0.02;
    population.first = world.instances.size();
  };
  if (obstacles == Obstacles::drawn) add_population("posts", model, 24);
  add_population("robots", model + 1, 1);
  return world;
}

}  // namespace cohort::test
