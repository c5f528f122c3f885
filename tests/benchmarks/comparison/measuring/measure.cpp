// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/measuring/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "tests/benchmarks/comparison/measuring/clocks.hpp"

namespace cohort::bench {
namespace {

constexpr unsigned steps_a_control_tick = 10;
constexpr double warm_up = 1.0;          // [s]
constexpr double straight_speed = 0.15;  // commanded speed [m/s]
constexpr std::uint32_t straight_robots = 4;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double median_ratio(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
  return median(std::move(ratios));
}

unsigned control_ticks(double seconds, double step) {
  return static_cast<unsigned>(std::max(1.0, std::round(seconds / (step * steps_a_control_tick))));
}

// A scene in one engine, with random commands.
class Run {
 public:
  Run(const EngineKind& kind, unsigned threads, const Scene& scene, const Options& options)
      : name_(kind.name),
        threads_(threads),
        scene_(scene),
        robots_(static_cast<double>(scene.robots.size())),
        driving_(options.seed, static_cast<std::uint32_t>(scene.robots.size())),
        engine_(kind.make(scene, threads)) {}

  const std::string& name() const { return name_; }
  unsigned threads() const { return threads_; }

  void warm_up_for(unsigned ticks) {
    for (unsigned i = 0; i < ticks; ++i) drive_one_tick();
  }

  void measure(unsigned ticks) {
    double cpu = 0.0;
    double wall = 0.0;
    double touches = 0.0;
    for (unsigned i = 0; i < ticks; ++i) {
      const auto [tick_cpu, tick_wall] = drive_one_tick();
      cpu += tick_cpu;
      wall += tick_wall;
      touches += static_cast<double>(look());
    }
    const double robot_steps = robots_ * ticks * steps_a_control_tick;
    cpu_.push_back(cpu / robot_steps);
    wall_.push_back(wall / robot_steps);
    touches_.push_back(touches / (robots_ * ticks));
  }

  const std::vector<double>& cpu() const { return cpu_; }
  const std::vector<double>& wall() const { return wall_; }
  double touches() const { return median(touches_); }
  double error() const { return error_; }

 private:
  std::pair<double, double> drive_one_tick() {
    driving_.update(tick_++,
                    [&](std::uint32_t robot, const Command& command) { engine_->set_command(robot, command); });
    const double cpu = cpu_seconds();
    const double wall = wall_seconds();
    for (unsigned i = 0; i < steps_a_control_tick; ++i) engine_->step();
    return {cpu_seconds() - cpu, wall_seconds() - wall};
  }

  // Returns the number of touching pairs.
  std::size_t look() {
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const Touch& touch : engine_->touches()) pairs.insert(std::minmax(touch.robot, touch.other));
    if (scene_.connected) {
      for (std::uint32_t robot = 1; robot < scene_.robots.size(); ++robot)
        error_ = std::max(error_, std::abs(between(robot - 1, robot).norm() - scene_.connection_length));
    } else {
      for (const auto& [a, b] : pairs)
        if (b != Touch::wall)
          error_ = std::max(error_, 2.0 * scene_.robot.turret.radius - between(a, b).head<2>().norm());
    }
    return pairs.size();
  }

  Eigen::Vector3d between(std::uint32_t a, std::uint32_t b) const {
    return engine_->turret_centre(a) - engine_->turret_centre(b);
  }

  std::string name_;
  unsigned threads_;
  const Scene& scene_;
  double robots_;
  RandomDriving driving_;
  std::unique_ptr<Engine> engine_;
  std::uint64_t tick_ = 0;
  std::vector<double> cpu_;  // one value for each repetition, per robot and step
  std::vector<double> wall_;
  std::vector<double> touches_;
  double error_ = 0.0;
};

// Returns the speed ratio, measured over one second after one second of acceleration.
double straight_speed_ratio(const EngineKind& kind, Drive drive, std::uint64_t seed) {
  Scene scene = spread(straight_robots, seed);
  scene.drive = drive;
  const std::unique_ptr<Engine> engine = kind.make(scene, 1);
  const auto steps = static_cast<unsigned>(std::round(1.0 / scene.step));
  for (std::uint32_t robot = 0; robot < straight_robots; ++robot)
    engine->set_command(robot, {straight_speed, straight_speed, 0.0});
  for (unsigned i = 0; i < steps; ++i) engine->step();
  std::vector<Eigen::Vector3d> start_W;
  for (std::uint32_t robot = 0; robot < straight_robots; ++robot) start_W.push_back(engine->turret_centre(robot));
  for (unsigned i = 0; i < steps; ++i) engine->step();
  double way = 0.0;
  for (std::uint32_t robot = 0; robot < straight_robots; ++robot)
    way += (engine->turret_centre(robot) - start_W[robot]).head<2>().norm();
  return way / (straight_robots * straight_speed);
}

const Run* find(const std::vector<std::unique_ptr<Run>>& runs, const std::string& engine) {
  for (const auto& run : runs)
    if (run->name() == engine && run->threads() == 1) return run.get();
  return nullptr;
}

StepCost cost_of(const Run& run, const std::vector<std::unique_ptr<Run>>& runs) {
  StepCost cost;
  cost.engine = run.name();
  cost.threads = run.threads();
  cost.cpu = spread_of(run.cpu());
  cost.wall = spread_of(run.wall());
  cost.touches = run.touches();
  cost.error = run.error();
  if (const Run* reference = find(runs, reference_engine))
    cost.against_reference = median_ratio(reference->cpu(), run.cpu());
  if (const Run* single = find(runs, run.name()); single != nullptr && run.threads() > 1) {
    cost.speed_up = median_ratio(single->wall(), run.wall());
    const double even = 1.0 / run.threads();
    cost.serial_share = (1.0 / *cost.speed_up - even) / (1.0 - even);
  }
  return cost;
}

class Measurement {
 public:
  Measurement(const std::string& name, const Scene& scene, const Options& options, const Surroundings& surroundings)
      : scene_(scene), options_(options), surroundings_(surroundings) {
    result_.scene = name;
    result_.connected = scene.connected;
    result_.robots = static_cast<std::uint32_t>(scene.robots.size());
    result_.step = scene.step;
  }

  StepResult measure(const std::vector<EngineKind>& engines) {
    for (const EngineKind& kind : engines) build(kind);
    const unsigned ticks = control_ticks(options_.seconds, scene_.step);
    for (unsigned repetition = 1; repetition <= options_.repetitions; ++repetition) measure_each(repetition, ticks);
    for (const auto& run : runs_) result_.costs.push_back(cost_of(*run, runs_));
    for (StepCost& cost : result_.costs) {
      const auto kind =
          std::find_if(engines.begin(), engines.end(), [&](const EngineKind& k) { return k.name == cost.engine; });
      cost.speed_ratio = straight_speed_ratio(*kind, scene_.drive, options_.seed);
    }
    return std::move(result_);
  }

 private:
  void build(const EngineKind& kind) {
    if (const auto reason = kind.limitation(scene_)) {
      result_.left_out.push_back({kind.name, *reason});
      return;
    }
    std::vector<unsigned> threads = {1};
    if (options_.threads > 1 && kind.package.empty()) threads.push_back(options_.threads);
    for (const unsigned count : threads) {
      say(kind.name, "warm-up");
      attempt(kind.name, [&] {
        auto run = std::make_unique<Run>(kind, count, scene_, options_);
        run->warm_up_for(control_ticks(warm_up, scene_.step));
        runs_.push_back(std::move(run));
      });
    }
  }

  // An engine that fails is skipped from then on.
  void measure_each(unsigned repetition, unsigned ticks) {
    for (std::size_t i = 0; i < runs_.size();) {
      say(runs_[i]->name(), fmt::format("repetition {} of {}", repetition, options_.repetitions));
      if (attempt(runs_[i]->name(), [&] { runs_[i]->measure(ticks); }))
        ++i;
      else
        runs_.erase(runs_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  template <class Act>
  bool attempt(const std::string& engine, Act&& act) {
    if (surroundings_.stop) throw Interrupted();
    try {
      act();
      return true;
    } catch (const std::runtime_error& error) {
      result_.left_out.push_back({engine, error.what()});
      return false;
    }
  }

  void say(const std::string& engine, const std::string& what) const {
    surroundings_.progress(fmt::format("{}, {} robots: {}, {}", result_.scene, result_.robots, engine, what));
  }

  const Scene& scene_;
  const Options& options_;
  const Surroundings& surroundings_;
  StepResult result_;
  std::vector<std::unique_ptr<Run>> runs_;
};

}  // namespace

Spread spread_of(std::vector<double> values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {median(values), *least, *most};
}

StepResult measure_steps(const std::string& name, const Scene& scene, const std::vector<EngineKind>& engines,
                         const Options& options, const Surroundings& surroundings) {
  return Measurement(name, scene, options, surroundings).measure(engines);
}

}  // namespace cohort::bench
