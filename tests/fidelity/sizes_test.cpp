// SPDX-License-Identifier: Apache-2.0

// The time of a step does not depend on the size of bodies, from tiny to a metre.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "tests/support/physics.hpp"

namespace cohort::test {
namespace {

using description::Box;
using description::Sphere;
using Eigen::Vector3d;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Kind {
  const char* name;
  description::Shape (*of_size)(double);
};
const Kind kinds[] = {{"sphere", [](double size) { return description::Shape(Sphere{size}); }},
                      {"box", [](double size) { return description::Shape(Box{Vector3d::Constant(2.0 * size)}); }},
                      {"cylinder",
                       [](double size) {
                         return description::Shape(description::Cylinder{size, 2.0 * size});
                       }},
                      {"capsule",
                       [](double size) {
                         return description::Shape(description::Capsule{size, size});
                       }},
                      {"ellipsoid", [](double size) {
                         return description::Shape(description::Ellipsoid{{size, 2.0 * size, size}});
                       }}};

std::vector<description::Shape> grounds(description::Fidelity fidelity) {
  std::vector<description::Shape> all = {description::Plane{}, Box{Vector3d(40000.0, 40000.0, 0.02)}};
  if (fidelity == description::Fidelity::planar) return all;
  description::Mesh surface = box_mesh(Vector3d(10.0, 10.0, 0.02));
  surface.convex = false;
  all.push_back(surface);
  auto grid = std::make_shared<description::HeightGrid>();
  grid->columns = grid->rows = 20;
  grid->spacing = Eigen::Vector2d::Constant(0.5);
  for (int i = 0; i < 400; ++i) grid->heights.push_back(0.01 * std::sin(i));
  all.push_back(description::Heightmap{grid});
  return all;
}

description::Inertial heavy_enough(double size) { return solid_sphere(0.1, std::max(size, 0.01)); }

// Returns the CPU time of five steps.
double seconds_of_ticks(SmallWorld& small) {
  const double before = cpu_seconds();
  for (int tick = 0; tick < 5; ++tick) small.world().step();
  return cpu_seconds() - before;
}

// Other processes use the CPU's caches too, so the shortest of several times counts.
template <typename Measure>
bool is_below(double allowed, const Measure& measure) {
  constexpr int most_measurements = 20;
  for (int i = 0; i < most_measurements; ++i)
    if (measure() < allowed) return true;
  return false;
}

class Sizes : public EveryPhysics {
 protected:
  description::World empty_world() const {
    description::World world = GetParam().world();
    world.models.clear();
    world.instances.clear();
    return world;
  }
  // A planar body searches for ground at most 10 m below its middle.
  static double widest() { return GetParam().fidelity == description::Fidelity::planar ? 5.0 : 1000.0; }
};
INSTANTIATE_TEST_SUITE_P(Every, Sizes, ::testing::Values(articulated, treel, by_bullet(treel), hybrid, planar),
                         name_of);

// A body that is larger than a heightmap is near all its triangles: an ellipsoid takes 28 times as long. On a loaded
// machine, caches make it more.
constexpr double much_longer = 60.0;
constexpr double too_short_to_compare = 0.002;  // [s]

TEST_P(Sizes, DoNotAffectTheTimeOfAStep) {
  for (const Kind& kind : kinds)
    for (const description::Shape& ground : grounds(GetParam().fidelity)) {
      const auto time_of = [&](double size) {
        SmallWorld small(empty_world());
        const bool has_thickness = !geometry::is_ground(ground);
        small.add(static_shape("ground", ground), at(0, 0, has_thickness ? -0.01 : 0.0));
        for (int i = 0; i < 4; ++i)
          small.add(loose("body", kind.of_size(size), heavy_enough(size)), at(3.0 * size * i, 0.3, size));
        const auto fast = small.add(loose("fast", kind.of_size(size), heavy_enough(size)), at(-0.3, -3.0 * size, size));
        small.world().set_root_twist(fast, {Vector3d::Zero(), Vector3d(3.0, 0.5, -1.0)});
        return seconds_of_ticks(small);
      };
      const double allowed = much_longer * std::max(time_of(1.0), too_short_to_compare);
      for (int decade = 3; decade >= -9; --decade)
        if (const double size = std::pow(10.0, decade); size <= widest()) {
          ASSERT_TRUE(is_below(allowed, [&] { return time_of(size); }))
              << kind.name << " of " << size << " m on ground " << ground.index();
        }
    }
}

// Like a box that rests on points, modelled as tiny spheres.
TEST_P(Sizes, MayDifferWithinABody) {
  const auto time_of = [&](double size) {
    SmallWorld small(empty_world());
    small.add(static_shape("ground", description::Plane{}), at(0, 0, 0));
    description::Model model = loose("box", Box{Vector3d(0.1, 0.1, 0.1)}, solid_box(0.3, Vector3d::Constant(0.1)));
    for (int i = 0; i < 8; ++i)
      model.links[0].collisions.push_back(
          {"point_" + std::to_string(i),
           at((i & 1) != 0 ? 0.05 : -0.05, (i & 2) != 0 ? 0.05 : -0.05, (i & 4) != 0 ? 0.05 : -0.05),
           Sphere{size},
           {}});
    for (int i = 0; i < 20; ++i) small.add(model, at(0.15 * i, 0, 0.05));
    return seconds_of_ticks(small);
  };
  const double allowed = much_longer * std::max(time_of(0.01), too_short_to_compare);
  for (int decade = -3; decade >= -9; --decade)
    ASSERT_TRUE(is_below(allowed, [&] { return time_of(std::pow(10.0, decade)); })) << decade;
}

TEST_P(Sizes, MayDifferBetweenBodies) {
  const auto time_of = [&](double tiny, double huge) {
    SmallWorld small(empty_world());
    small.add(static_shape("ground", description::Plane{}), at(0, 0, 0));
    small.add(loose("huge", Sphere{huge}, heavy_enough(huge)), at(1.5 * huge, 0, huge));
    for (int i = 0; i < 3; ++i) small.add(loose("tiny", Sphere{tiny}, heavy_enough(tiny)), at(-0.1 * i, 0, tiny));
    const double seconds = seconds_of_ticks(small);
    // A ray across the whole world must be fast too.
    const double before = cpu_seconds();
    for (int i = 0; i < 100; ++i)
      small.world().scene().cast_ray({-1e3, 0.01 * i, 0.5}, Vector3d::UnitX(), std::numeric_limits<double>::infinity());
    return seconds + cpu_seconds() - before;
  };
  const double allowed = much_longer * std::max(time_of(1.0, 1.0), too_short_to_compare);
  for (const double tiny : {1e-3, 1e-6, 1e-9})
    for (const double huge : {0.01 * widest(), 0.1 * widest(), widest()})
      ASSERT_TRUE(is_below(allowed, [&] { return time_of(tiny, huge); })) << tiny << " beside " << huge;
}

}  // namespace
}  // namespace cohort::test
