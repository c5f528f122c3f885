#include "tools/bench/rays.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "server/geometry/scene.hpp"
#include "tools/bench/clocks.hpp"

namespace cohort::bench {
namespace {

constexpr std::size_t rays_a_robot = 24;
constexpr double range = 0.2;       // [m]
constexpr double least_gap = 0.01;  // between two robots [m]
constexpr double least_rays = 5e5;  // in one repetition, so that the clock's own time is nothing

class Field {
 public:
  Field(std::uint32_t robots, double spacing, std::uint64_t seed) {
    const CylinderBody turret = Robot{}.turret;
    radius_ = turret.radius;
    const RandomStream random(seed, "bench", "rays");
    const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(robots)));
    const double freedom = 0.5 * (spacing - 2.0 * radius_ - least_gap);
    for (std::uint32_t i = 0; i < robots; ++i) {
      const auto within = [&](std::uint32_t draw) { return freedom * (2.0 * random.uniform(i, draw) - 1.0); };
      const Eigen::AngleAxisd yaw(2.0 * std::numbers::pi * random.uniform(i, 2), Eigen::Vector3d::UnitZ());
      poses_.push_back({{spacing * (i % columns) + within(0), spacing * (i / columns) + within(1), turret.z},
                        Eigen::Quaterniond(yaw)});
      scene_.add({description::Cylinder{turret.radius, turret.height}, {}, i, true, poses_.back()});
    }
    scene_.build();
    for (std::size_t ray = 0; ray < rays_a_robot; ++ray) {
      const double bearing = 2.0 * std::numbers::pi * static_cast<double>(ray) / rays_a_robot;
      directions_.emplace_back(std::cos(bearing), std::sin(bearing), 0.0);
    }
  }

  /// As a proximity ring does; returns the number of hits.
  std::size_t cast() {
    for (std::uint32_t i = 0; i < poses_.size(); ++i) scene_.set_pose(i, poses_[i]);
    scene_.update();
    std::size_t hits = 0;
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius_ + range);
    for (std::uint32_t i = 0; i < poses_.size(); ++i) {
      const Pose& X_WS = poses_[i];
      const std::vector<std::uint32_t> near = scene_.solids_in({X_WS.position - reach, X_WS.position + reach}, i);
      for (const Eigen::Vector3d& direction : directions_) {
        const Eigen::Vector3d direction_W = X_WS.orientation * direction;
        if (scene_.cast_ray_among(near, X_WS.position + radius_ * direction_W, direction_W, range)) ++hits;
      }
    }
    return hits;
  }

  double rays() const { return static_cast<double>(poses_.size() * rays_a_robot); }

 private:
  double radius_ = 0.0;
  geometry::Scene scene_;
  std::vector<Pose> poses_;
  std::vector<Eigen::Vector3d> directions_;
};

}  // namespace

RayResult measure_rays(const std::string& name, std::uint32_t robots, const Options& options,
                       const Surroundings& surroundings) {
  RayResult result{name, robots, {}};
  for (const auto& [density, spacing] : {std::pair{"sparse", 0.7}, std::pair{"dense", 0.14}}) {
    surroundings.progress(fmt::format("{}, {} robots: {}", name, robots, density));
    Field field(robots, spacing, options.seed);
    const double hits = static_cast<double>(field.cast()) / field.rays();
    const auto times = static_cast<unsigned>(std::ceil(least_rays / field.rays()));
    std::vector<double> speeds;
    for (unsigned repetition = 0; repetition < options.repetitions; ++repetition) {
      if (surroundings.stop) throw Interrupted();
      const double before = cpu_seconds();
      for (unsigned i = 0; i < times; ++i) field.cast();
      speeds.push_back(times * field.rays() / (cpu_seconds() - before));
    }
    result.costs.push_back({density, spacing, hits, spread_of(speeds)});
  }
  return result;
}

}  // namespace cohort::bench
