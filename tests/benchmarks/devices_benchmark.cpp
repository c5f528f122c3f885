// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <memory>
#include <numbers>
#include <vector>

#include "server/core/random.hpp"
#include "server/physics/make_world.hpp"
#include "server/sensing/make_sensor.hpp"
#include "server/sensing/sensor.hpp"
#include "tests/support/robots.hpp"

// Measures sensors with their surroundings: the whole sensing of a tick, on one thread. Robots rest in an arena of 10 m
// x 10 m with four walls.
namespace cohort::sensing {
namespace {

constexpr double half_width = 5.0;
constexpr std::uint32_t sources = 24;
constexpr std::uint32_t leds_a_robot = 8;
using std::numbers::pi;

class Swarm {
 public:
  Swarm(std::uint32_t robots, const std::vector<description::Device>& devices, std::uint32_t lamps,
        std::uint32_t tones) {
    description::Model robot = test::tracked_robot();
    robot.devices = devices;
    for (std::uint32_t n = 0; n < robots; ++n)
      test::place(description_, robot, "robot" + std::to_string(n), place(n, 0.0));
    for (const double side : {-half_width, half_width}) {
      const description::Shape wall = description::Box{{0.02, 2.0 * half_width, 0.3}};
      test::place(description_, test::static_shape("wall", wall), "wall", test::at(side, 0, 0.15));
      test::place(description_, test::static_shape("wall", wall), "wall", test::at(0, side, 0.15, pi / 2.0));
    }
    for (std::uint32_t n = 0; n < lamps; ++n) add_emitter(description::Light{}, place(100'000 + n, 0.2));
    for (std::uint32_t n = 0; n < tones; ++n) add_emitter(description::Sound{400.0, 1.0}, place(200'000 + n, 0.2));

    world_ = physics::make_world(description_, workers_);
    emitters_ = std::make_unique<emission::Emitters>(description_, *world_);
    grippers_ = std::make_unique<gripping::Grippers>(description_, *world_);
    for (const std::size_t body : description_.robots)
      for (std::size_t device = 0; device < devices.size(); ++device) {
        auto sensor =
            make_sensor({*world_, *emitters_, description_, *grippers_, views_, BodyId{body}, DeviceId{device}, 1});
        if (!sensor) continue;
        sensors_.push_back(std::move(sensor));
        std::size_t size = 0;
        for (const Channel& channel : sensors_.back()->channels()) size += channel.size;
        values_.emplace_back(size);
      }
  }

  /// Switches on all LEDs of all robots, if they have any.
  void light_up() {
    for (std::size_t body : description_.robots)
      for (std::uint32_t led = 0; led < leds_a_robot; ++led)
        emitters_->set_marker(emitters_->of_device(BodyId{body}, DeviceId{1}).marker + led, Eigen::Vector3d::Ones());
  }

  void sense(std::uint64_t tick) {
    emitters_->update(workers_);
    for (const auto& sensor : sensors_) sensor->ask_shared_view();
    views_.update(workers_);
    for (std::size_t i = 0; i < sensors_.size(); ++i) sensors_[i]->sense(tick, values_[i]);
    benchmark::DoNotOptimize(values_.data());
  }

 private:
  Pose place(std::uint64_t n, double z) const {
    const double reach = half_width - 0.12;
    return test::at(reach * (2.0 * random_.uniform(n, 0) - 1.0), reach * (2.0 * random_.uniform(n, 1) - 1.0), z,
                    6.0 * random_.uniform(n, 2));
  }
  void add_emitter(const decltype(description::Emitter::what)& what, const Pose& X_WM) {
    description::Model model;
    model.name = "emitter";
    model.is_static = true;
    model.links.push_back({"link", {}, {}, {}});
    model.emitters.push_back({"emitter", 0, {}, true, what});
    test::place(description_, model, "emitter", X_WM);
  }

  RandomStream random_{1, "devices_benchmark", "places"};
  WorkerPool workers_{1};
  description::World description_ = test::world_with_floor();
  std::unique_ptr<physics::World> world_;
  std::unique_ptr<emission::Emitters> emitters_;
  std::unique_ptr<gripping::Grippers> grippers_;
  SharedViews views_;
  std::vector<std::unique_ptr<Sensor>> sensors_;
  std::vector<std::vector<double>> values_;
};

// Reports the time per robot and tick.
void run(benchmark::State& state, Swarm& swarm) {
  std::uint64_t tick = 0;
  for ([[maybe_unused]] auto iteration : state) swarm.sense(++tick);
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.counters["a robot and tick"] = benchmark::Counter(
      static_cast<double>(state.range(0)), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const description::Device light = description::LightSensors{"light", 1, {{0, 0, 0.03}}, 8, 0.0, pi / 4.0, 0.5, {}};
const description::Device ears = description::Microphones{
    "microphones", 1, {{0.03, 0, 0.03}, {0, 0.03, 0.03}, {-0.03, 0, 0.03}, {0, -0.03, 0.03}}, {{0, 20000}}, 1.0, {}};

void see_24_lights(benchmark::State& state) {
  Swarm swarm(static_cast<std::uint32_t>(state.range(0)), {light}, sources, 0);
  run(state, swarm);
}
BENCHMARK(see_24_lights)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

void hear_24_sounds(benchmark::State& state) {
  Swarm swarm(static_cast<std::uint32_t>(state.range(0)), {ears}, 0, sources);
  run(state, swarm);
}
BENCHMARK(hear_24_sounds)->Arg(1000)->Unit(benchmark::kMicrosecond);

void see_and_hear_24_of_each(benchmark::State& state) {
  Swarm swarm(static_cast<std::uint32_t>(state.range(0)), {light, ears}, sources, sources);
  run(state, swarm);
}
BENCHMARK(see_and_hear_24_of_each)->Arg(1000)->Unit(benchmark::kMicrosecond);

// Measures each proximity technique. The argument is the technique, in the order of the enumeration.
void measure_proximity(benchmark::State& state) {
  description::ProximityRing ring{"proximity", 1, {{0, 0, 0.02}}, 15, 0.2, 2.0 * pi / 15.0, 0.058, 0.2, {}};
  ring.technique = static_cast<description::ProximityTechnique>(state.range(1));
  ring.cone = 0.7;
  description::Samples samples;
  for (int i = 0; i < 20; ++i) samples.distances.push_back(0.058 + 0.01 * i);
  for (int i = 0; i < 72; ++i) samples.angles.push_back(2.0 * pi * i / 72.0);
  samples.units.assign(15, "1");
  samples.readings.assign(20UL * 72UL * 15UL, 0.5);
  ring.samples = std::make_shared<const description::Samples>(samples);
  Swarm swarm(static_cast<std::uint32_t>(state.range(0)), {ring}, 0, 0);
  run(state, swarm);
}
BENCHMARK(measure_proximity)->ArgsProduct({{1000}, {0, 1, 2, 3, 4}})->Unit(benchmark::kMicrosecond);

const description::Device leds = description::LedRing{"leds", 1, {{0, 0, 0.02}}, leds_a_robot, 0.0, pi / 4.0, 0.058};

// Measures a camera of spots: the robots within 0.5 m, with all LEDs on.
void see_spots(benchmark::State& state) {
  const description::Device camera =
      description::OmnidirectionalCamera{"camera", 1, {{0, 0, 0.06}}, 0.5, -1.0, 1.0, 32, {}};
  Swarm swarm(static_cast<std::uint32_t>(state.range(0)), {camera, leds}, 0, 0);
  swarm.light_up();
  run(state, swarm);
}
BENCHMARK(see_spots)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

// Measures an image of 180 x 32 pixels.
void film(benchmark::State& state) {
  description::PanoramicCamera camera;
  camera.name = "film";
  camera.link = 1;
  camera.X_LS = {{0, 0, 0.06}};
  camera.width = 180;
  camera.height = 32;
  camera.min_elevation = -0.6;
  camera.max_elevation = 0.4;
  Swarm swarm(static_cast<std::uint32_t>(state.range(0)), {camera, leds}, 0, 0);
  swarm.light_up();
  run(state, swarm);
}
BENCHMARK(film)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace cohort::sensing
