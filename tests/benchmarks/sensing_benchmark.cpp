// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "server/core/random.hpp"
#include "server/geometry/visibility/panorama.hpp"
#include "server/geometry/visibility/shadow_ring.hpp"
#include "server/geometry/visibility/sight_lines.hpp"
#include "server/sensing/readings/sample_table.hpp"

// Measures the queries of sensors to the scene: an arena of 10 m x 10 m with a floor, four walls and 1000 robots.
// Robots are discs with a radius of 6 cm.
namespace cohort::geometry {
namespace {

using Eigen::Vector3d;

constexpr double half_width = 5.0;
constexpr double radius = 0.06;
constexpr double height = 0.1;

struct Arena {
  explicit Arena(std::uint32_t count) : robots(count) {
    for (std::uint32_t robot = 0; robot < count; ++robot)
      scene.add({description::Cylinder{radius, height}, {}, BodyId{robot}, true, pose_of(robot)});
    std::uint32_t body = count;
    scene.add({description::Plane{}, {}, BodyId{body++}, false, {}});
    for (const double side : {-half_width, half_width}) {
      scene.add({description::Box{{0.02, 2 * half_width, 0.3}}, {}, BodyId{body++}, false, {{side, 0, 0.15}}});
      scene.add({description::Box{{2 * half_width, 0.02, 0.3}}, {}, BodyId{body++}, false, {{0, side, 0.15}}});
    }
    scene.build();
  }

  Vector3d place(std::uint64_t n, double z) const {
    const double reach = half_width - 2 * radius;
    return {reach * (2 * random.uniform(n, 0) - 1), reach * (2 * random.uniform(n, 1) - 1), z};
  }
  Pose pose_of(std::uint32_t robot) const {
    return {place(robot, 0.5 * height),
            Eigen::Quaterniond(Eigen::AngleAxisd(6.0 * random.uniform(robot, 2), Vector3d::UnitZ()))};
  }

  RandomStream random{1, "sensing_benchmark", "places"};
  std::uint32_t robots;
  Scene scene;
};

constexpr std::uint32_t lamps = 24;

// Returns the position of each robot's light sensor.
std::vector<Vector3d> sensors_of(const Arena& arena) {
  std::vector<Vector3d> sensors;
  for (std::uint32_t robot = 0; robot < arena.robots; ++robot)
    sensors.push_back(arena.scene.solid(robot).X_WC * Vector3d(0.05, 0.0, 0.04));
  return sensors;
}

Vector3d lamp_of(const Arena& arena, std::uint32_t lamp, double z) { return arena.place(1'000'000 + lamp, z); }

// Measures everything that a tick needs: outlines, 24 lamps, and a query by each robot about each lamp. The argument is
// the height of the lamps in centimetres; light sensors are at 9 cm.
void see_lamps(benchmark::State& state) {
  const Arena arena(1000);
  std::vector<SightLines> lines(lamps);
  std::size_t seen = 0;
  for ([[maybe_unused]] auto iteration : state) {
    const Outlines outlines(arena.scene);
    const std::vector<Vector3d> sensors = sensors_of(arena);
    for (std::uint32_t lamp = 0; lamp < lamps; ++lamp) {
      lines[lamp].build(outlines, lamp_of(arena, lamp, 0.01 * static_cast<double>(state.range(0))),
                        std::numeric_limits<double>::infinity());
      for (std::uint32_t robot = 0; robot < arena.robots; ++robot)
        seen += lines[lamp].is_free(sensors[robot], BodyId{robot}) ? 1 : 0;
    }
  }
  state.SetItemsProcessed(state.iterations() * lamps * arena.robots);
  state.counters["seen"] = static_cast<double>(seen) / static_cast<double>(state.iterations() * lamps * arena.robots);
}
BENCHMARK(see_lamps)->Arg(5)->Arg(20)->Arg(100)->Unit(benchmark::kMicrosecond);

// Measures the same with each robot querying all lamps in turn, as a light sensor does.
void see_lamps_robot_by_robot(benchmark::State& state) {
  const Arena arena(1000);
  std::vector<SightLines> lines(lamps);
  std::size_t seen = 0;
  for ([[maybe_unused]] auto iteration : state) {
    const Outlines outlines(arena.scene);
    const std::vector<Vector3d> sensors = sensors_of(arena);
    for (std::uint32_t lamp = 0; lamp < lamps; ++lamp)
      lines[lamp].build(outlines, lamp_of(arena, lamp, 0.01 * static_cast<double>(state.range(0))),
                        std::numeric_limits<double>::infinity());
    for (std::uint32_t robot = 0; robot < arena.robots; ++robot) {
      for (const SightLines& line : lines) seen += line.is_free(sensors[robot], BodyId{robot}) ? 1 : 0;
    }
  }
  state.SetItemsProcessed(state.iterations() * lamps * arena.robots);
  benchmark::DoNotOptimize(seen);
}
BENCHMARK(see_lamps_robot_by_robot)->Arg(5)->Arg(20)->Arg(100)->Unit(benchmark::kMicrosecond);

// Measures only the building, including outlines.
void build_sight_lines(benchmark::State& state) {
  const Arena arena(1000);
  std::vector<SightLines> lines(lamps);
  for ([[maybe_unused]] auto iteration : state) {
    const Outlines outlines(arena.scene);
    for (std::uint32_t lamp = 0; lamp < lamps; ++lamp)
      lines[lamp].build(outlines, lamp_of(arena, lamp, 0.05), std::numeric_limits<double>::infinity());
  }
  state.SetItemsProcessed(state.iterations() * lamps * arena.robots);
}
BENCHMARK(build_sight_lines)->Unit(benchmark::kMicrosecond);

void gather_outlines(benchmark::State& state) {
  const Arena arena(1000);
  for ([[maybe_unused]] auto iteration : state) benchmark::DoNotOptimize(Outlines(arena.scene).items().data());
  state.SetItemsProcessed(state.iterations() * arena.robots);
}
BENCHMARK(gather_outlines)->Unit(benchmark::kMicrosecond);

// Measures the same queries with plain rays.
void see_lamps_by_rays(benchmark::State& state) {
  const Arena arena(1000);
  std::size_t seen = 0;
  for ([[maybe_unused]] auto iteration : state) {
    const std::vector<Vector3d> sensors = sensors_of(arena);
    for (std::uint32_t lamp = 0; lamp < lamps; ++lamp) {
      const Vector3d source = lamp_of(arena, lamp, 0.01 * static_cast<double>(state.range(0)));
      for (std::uint32_t robot = 0; robot < arena.robots; ++robot) {
        const Vector3d offset = sensors[robot] - source;
        const double distance = offset.norm();
        seen += arena.scene.cast_ray(source, offset / distance, distance, BodyId{robot}) ? 0 : 1;
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * lamps * arena.robots);
  state.counters["seen"] = static_cast<double>(seen) / static_cast<double>(state.iterations() * lamps * arena.robots);
}
BENCHMARK(see_lamps_by_rays)->Arg(5)->Arg(20)->Arg(100)->Unit(benchmark::kMicrosecond);

// Measures robots that receive each other's signals within a metre: each is a source, queried by all that may be near
// enough.
void hear_robots(benchmark::State& state) {
  const Arena arena(static_cast<std::uint32_t>(state.range(0)));
  SightLines lines;
  std::size_t pairs = 0;
  for ([[maybe_unused]] auto iteration : state) {
    const Outlines outlines(arena.scene);
    for (std::uint32_t robot = 0; robot < arena.robots; ++robot) {
      const Vector3d source = arena.scene.solid(robot).X_WC.position;
      lines.build(outlines, source, 1.0, BodyId{robot});
      const Bounds near = Bounds{source, source}.grown_by(1.0);
      arena.scene.for_each_overlap(near, [&](std::uint32_t other) {
        if (other >= arena.robots || other == robot) return;
        benchmark::DoNotOptimize(lines.is_free(arena.scene.solid(other).X_WC.position, BodyId{other}));
        ++pairs;
      });
    }
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(pairs));
}
BENCHMARK(hear_robots)->Arg(1000)->Arg(4000)->Unit(benchmark::kMicrosecond);

// Measures the same with plain rays.
void hear_robots_by_rays(benchmark::State& state) {
  const Arena arena(static_cast<std::uint32_t>(state.range(0)));
  std::size_t pairs = 0;
  for ([[maybe_unused]] auto iteration : state) {
    for (std::uint32_t robot = 0; robot < arena.robots; ++robot) {
      const Vector3d source = arena.scene.solid(robot).X_WC.position;
      const Bounds near = Bounds{source, source}.grown_by(1.0);
      arena.scene.for_each_overlap(near, [&](std::uint32_t other) {
        if (other >= arena.robots || other == robot) return;
        const Vector3d offset = arena.scene.solid(other).X_WC.position - source;
        const double distance = offset.norm();
        if (distance <= 1.0)
          benchmark::DoNotOptimize(
              arena.scene.is_free(source, offset / distance, distance, BodyId{robot}, BodyId{other}));
        ++pairs;
      });
    }
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(pairs));
}
BENCHMARK(hear_robots_by_rays)->Arg(1000)->Arg(4000)->Unit(benchmark::kMicrosecond);

// Measures 360 directions around each robot, up to 20 cm from its rim.
void cast_shadows(benchmark::State& state) {
  const Arena arena(static_cast<std::uint32_t>(state.range(0)));
  const ShadowRing ring(360);
  std::vector<double> distances(ring.size());
  for ([[maybe_unused]] auto iteration : state)
    for (std::uint32_t robot = 0; robot < arena.robots; ++robot) {
      ring.cast(arena.scene, arena.scene.solid(robot).X_WC.position, 0.1 * robot, radius + 0.2, BodyId{robot},
                distances);
      benchmark::DoNotOptimize(distances.data());
    }
  state.SetItemsProcessed(state.iterations() * arena.robots);  // rings
}
BENCHMARK(cast_shadows)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

constexpr std::size_t columns = 180;
constexpr std::size_t rows = 32;
constexpr double camera_range = 20.0;  // beyond the arena

Panorama camera() {
  std::vector<double> elevations;
  for (std::size_t row = 0; row < rows; ++row) elevations.push_back(-0.6 + 0.03 * static_cast<double>(row));
  return {columns, elevations};
}
Pose camera_of(const Arena& arena, std::uint32_t robot) {
  Pose X_WS = arena.scene.solid(robot).X_WC;
  X_WS.position.z() = 0.15;
  return X_WS;
}

void see_panorama(benchmark::State& state) {
  const Arena arena(100);
  const Panorama panorama = camera();
  std::vector<std::optional<RayHit>> image(columns * rows);
  const Outlines outlines(arena.scene);
  std::uint32_t robot = 0;
  for ([[maybe_unused]] auto iteration : state) {
    panorama.cast(outlines, camera_of(arena, robot), camera_range, BodyId{robot}, image);
    benchmark::DoNotOptimize(image.data());
    robot = (robot + 1) % arena.robots;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(columns * rows));
}
BENCHMARK(see_panorama)->Unit(benchmark::kMicrosecond);

// Measures the same pixels with plain rays.
void see_panorama_by_rays(benchmark::State& state) {
  const Arena arena(100);
  const Panorama panorama = camera();
  std::uint32_t robot = 0;
  for ([[maybe_unused]] auto iteration : state) {
    const Pose X_WS = camera_of(arena, robot);
    for (std::size_t i = 0; i < columns * rows; ++i)
      benchmark::DoNotOptimize(
          arena.scene.cast_ray(X_WS.position, X_WS.orientation * panorama.direction(i), camera_range, BodyId{robot}));
    robot = (robot + 1) % arena.robots;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(columns * rows));
}
BENCHMARK(see_panorama_by_rays)->Unit(benchmark::kMicrosecond);

// Looks up the 15 readings of one object in a table of 20 distances and 72 angles.
void look_up_samples(benchmark::State& state) {
  const RandomStream random(2, "sensing_benchmark", "samples");
  description::Samples samples;
  for (std::uint64_t i = 0; i < 20; ++i) samples.distances.push_back(0.01 * static_cast<double>(i));
  for (std::uint64_t i = 0; i < 72; ++i) samples.angles.push_back(0.087 * static_cast<double>(i));
  samples.units.assign(15, "1");
  for (std::uint64_t i = 0; i < 20 * 72 * 15; ++i) samples.readings.push_back(random.uniform(i, 0));
  const sensing::SampleTable table(std::make_shared<const description::Samples>(samples));
  std::vector<double> values(table.count(), 0.0);
  std::uint64_t n = 0;
  for ([[maybe_unused]] auto iteration : state) {
    table.keep_greatest(0.2 * static_cast<double>(n % 97) / 97.0, 0.1 * static_cast<double>(n % 131), values);
    benchmark::DoNotOptimize(values.data());
    ++n;
  }
  state.SetItemsProcessed(state.iterations());  // objects
}
BENCHMARK(look_up_samples);

}  // namespace
}  // namespace cohort::geometry
