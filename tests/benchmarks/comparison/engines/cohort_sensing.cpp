// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "server/description/world_in_code.hpp"
#include "server/physics/make_world.hpp"
#include "server/sensing/exteroceptive/lamp_view.hpp"
#include "server/sensing/make_sensor.hpp"
#include "server/sensing/readings/take_samples.hpp"
#include "server/sensing/sensor.hpp"
#include "server/simulation/simulation.hpp"
#include "tests/benchmarks/comparison/engines/cohort_scene.hpp"
#include "tests/benchmarks/comparison/engines/sensing_run.hpp"

namespace cohort::bench {
namespace {

using description::Device;
using description::ProximityTechnique;

constexpr double obstacle_friction = 0.5;

Device proximity_ring(const SensingScene& scene, ProximityTechnique technique) {
  const ProximityLayout& layout = scene.proximity;
  description::ProximityRing ring;
  ring.name = "proximity";
  ring.link = turret_link;
  ring.X_LS.position.z() = layout.height - scene.scene.robot.turret_joint_height;
  ring.count = layout.sensors;
  ring.first_bearing = layout.first_bearing;
  ring.spacing = layout.spacing;
  ring.ring_radius = layout.radius;
  ring.range = layout.range;
  ring.cone = layout.cone;
  if (technique == ProximityTechnique::samples) {
    description::Model robot = describe(scene.scene).models.back();
    robot.devices = {ring};
    ring.samples = std::make_shared<const description::Samples>(sensing::take_samples(robot, 0, {}));
  }
  ring.technique = technique;
  return ring;
}

// Returns eight light sensors and four microphones.
std::vector<Device> senses(const SensingScene& scene, Perceived perceived) {
  const double z = scene.light_height - scene.scene.robot.turret_joint_height;
  std::vector<Device> devices;
  if (perceived != Perceived::sound) {
    description::LightSensors light;
    light.name = "light";
    light.link = turret_link;
    light.X_LS.position.z() = z;
    light.count = 8;
    light.spacing = 0.25 * std::numbers::pi;
    devices.emplace_back(light);
  }
  if (perceived != Perceived::light) {
    description::Microphones microphones;
    microphones.name = "microphones";
    microphones.link = turret_link;
    microphones.places_L = {{0.03, 0.0, z}, {0.0, 0.03, z}, {-0.03, 0.0, z}, {0.0, -0.03, z}};
    microphones.bands = {{0.0, 20'000.0}};
    devices.emplace_back(microphones);
  }
  return devices;
}

void place_sources(description::World& world, const SensingScene& scene) {
  constexpr double frequency = 440.0;  // [Hz]
  for (const Eigen::Vector3d& p_W : scene.sources) {
    description::Model model = description::static_model("source_" + std::to_string(world.models.size()));
    model.emitters.push_back({"lamp", 0, {}, true, description::Light{}});
    model.emitters.push_back({"tone", 0, {}, true, description::Sound{frequency, 1.0}});
    place(world, model, model.name, Pose{p_W});
  }
}

description::World describe(const SensingScene& scene, const std::vector<Device>& devices, bool is_driven) {
  description::World world = describe(scene.scene);
  std::vector<Device>& of_robots = world.models.edit(world.models.size() - 1).devices;
  if (!is_driven) of_robots.clear();
  of_robots.insert(of_robots.end(), devices.begin(), devices.end());
  const double z = 0.5 * scene.obstacle_height;
  const auto pose = [&](const Placement& at) {
    return Pose{{at.x, at.y, z}, Eigen::Quaterniond(Eigen::AngleAxisd(at.yaw, Eigen::Vector3d::UnitZ()))};
  };
  for (const Placement& at : scene.boxes)
    place_static(world, description::Box{{scene.box_size, scene.box_size, scene.obstacle_height}}, obstacle_friction,
                 pose(at));
  for (const Placement& at : scene.pillars)
    place_static(world, description::Cylinder{scene.pillar_radius, scene.obstacle_height}, obstacle_friction, pose(at));
  place_sources(world, scene);
  return world;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

class CohortSensing final : public SensingRun {
 public:
  CohortSensing(const SensingScene& scene, const std::vector<Device>& devices)
      : description_(describe(scene, devices, false)),
        workers_(1),
        world_(physics::make_world(description_, workers_)),
        emitters_(description_, *world_),
        grippers_(description_, *world_),
        lamp_view_(views_.get<sensing::LampView>(*world_, emitters_)) {
    std::size_t size = 0;
    for (const std::size_t body : description_.robots)
      for (std::size_t device = 0; device < devices.size(); ++device) {
        sensors_.push_back(sensing::make_sensor(
            {*world_, emitters_, description_, grippers_, views_, BodyId{body}, DeviceId{device}, scene.seed}));
        std::size_t of_sensor = 0;
        for (const Channel& channel : sensors_.back()->channels()) of_sensor += channel.size;
        ends_.push_back(size += of_sensor);
      }
    values_.resize(size);
  }

  void sense() override {
    emitters_.update(workers_);
    for (const auto& sensor : sensors_) sensor->ask_shared_view();
    views_.update(workers_);
    std::size_t begin = 0;
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      sensors_[i]->sense(tick_, std::span(values_).subspan(begin, ends_[i] - begin));
      begin = ends_[i];
    }
    ++tick_;
  }

  std::optional<double> answer() const override {
    if (emitters_.lit_lamps().empty()) return mean(values_);
    const std::uint32_t rings = lamp_view_.ring_count();
    if (rings == 0) return std::nullopt;
    std::size_t seen = 0;
    const std::size_t lamps = emitters_.lit_lamps().size();
    for (std::uint32_t ring = 0; ring < rings; ++ring)
      for (std::uint32_t lamp = 0; lamp < lamps; ++lamp) seen += lamp_view_.is_in_sight(lamp, ring) ? 1 : 0;
    return static_cast<double>(seen) / static_cast<double>(lamps * rings);
  }

 private:
  description::World description_;
  WorkerPool workers_;
  std::unique_ptr<physics::World> world_;
  emission::Emitters emitters_;
  gripping::Grippers grippers_;
  sensing::SharedViews views_;
  sensing::LampView& lamp_view_;
  std::vector<std::unique_ptr<sensing::Sensor>> sensors_;
  std::vector<std::size_t> ends_;  // end index of each sensor's values
  std::vector<double> values_;
  std::uint64_t tick_ = 0;
};

class CohortTicks final : public SensingRun {
 public:
  CohortTicks(const SensingScene& scene, const std::vector<Device>& devices) {
    experiment_.world = describe(scene, devices, true);
    experiment_.seed = scene.seed;
    description::Team team{"team", {}, "none", {}};
    for (std::uint32_t robot = 0; robot < experiment_.world.robots.size(); ++robot) team.robots.push_back(robot);
    experiment_.teams = {team};
    experiment_.duration = std::chrono::hours(24);
    simulation_ = std::make_unique<Simulation>(experiment_, 1);
  }

  void sense() override { simulation_->step(); }
  std::optional<double> answer() const override { return std::nullopt; }

 private:
  description::Experiment experiment_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace

std::unique_ptr<SensingRun> make_cohort_proximity(const SensingScene& scene, ProximityTechnique technique) {
  return std::make_unique<CohortSensing>(scene, std::vector<Device>{proximity_ring(scene, technique)});
}

std::unique_ptr<SensingRun> make_cohort_sources(const SensingScene& scene, Perceived perceived) {
  return std::make_unique<CohortSensing>(scene, senses(scene, perceived));
}

std::unique_ptr<SensingRun> make_cohort_proximity_ticks(const SensingScene& scene, ProximityTechnique technique) {
  return std::make_unique<CohortTicks>(scene, std::vector<Device>{proximity_ring(scene, technique)});
}

std::unique_ptr<SensingRun> make_cohort_sources_ticks(const SensingScene& scene, Perceived perceived) {
  return std::make_unique<CohortTicks>(scene, senses(scene, perceived));
}

}  // namespace cohort::bench
