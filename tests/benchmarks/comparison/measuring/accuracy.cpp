// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/measuring/accuracy.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tests/benchmarks/comparison/scenes/mechanics.hpp"

namespace cohort::bench {
namespace {

using Eigen::Vector3d;

constexpr double g = 9.81;

using Make = std::function<std::unique_ptr<MechanismRun>(const Mechanism&)>;

Vector3d moments_of_box(double mass, const Vector3d& size) {
  const Vector3d squares = size.cwiseProduct(size);
  return mass / 12.0 * Vector3d(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y());
}

RigidBody box(const Vector3d& size, const Vector3d& centre_W) {
  RigidBody body;
  body.inertia = moments_of_box(body.mass, size);
  body.centre_W = centre_W;
  body.box = size;
  return body;
}

// Returns a mass of one kilogram at the end of a light rod.
RigidBody bob(const Vector3d& hinge_W, const Vector3d& centre_W) {
  RigidBody body;
  body.inertia = Vector3d::Constant(1e-3);
  body.centre_W = centre_W;
  body.hinge_W = hinge_W;
  return body;
}

void run(MechanismRun& run, double seconds, double step) {
  for (auto steps = std::lround(seconds / step); steps > 0; --steps) run.step();
}

double energy_of(const MechanismRun& run, const Mechanism& mechanism) {
  double energy = 0.0;
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i) {
    const RigidBody& body = mechanism.bodies[i];
    const Vector3d turning = run.rotation(i).transpose() * run.angular_velocity(i);
    energy += 0.5 * body.mass * run.velocity(i).squaredNorm() + 0.5 * turning.dot(body.inertia.cwiseProduct(turning)) -
              body.mass * mechanism.gravity.dot(run.position(i));
  }
  return energy;
}

double fall(const Make& make, double step) {
  const auto falling = make({.step = step, .bodies = {RigidBody{.centre_W = {0.0, 0.0, 100.0}}}});
  run(*falling, 1.0, step);
  return falling->position(0).z() - (100.0 - 0.5 * g);
}

// Returns a box on a slope, which is modelled as a floor under tilted gravity.
Mechanism box_on_slope(double step, double friction) {
  constexpr double slope = 0.4;  // [rad]
  const Vector3d size(0.2, 0.2, 0.1);
  return {.step = step,
          .gravity = g * Vector3d(std::sin(slope), 0.0, -std::cos(slope)),
          .floor_friction = friction,
          .bodies = {box(size, {0.0, 0.0, 0.05})}};
}

double slide(const Make& make, double step) {
  constexpr double friction = 0.2;
  const Mechanism mechanism = box_on_slope(step, friction);
  const auto sliding = make(mechanism);
  run(*sliding, 1.0, step);
  return sliding->velocity(0).x() - (mechanism.gravity.x() + friction * mechanism.gravity.z());
}

double creep(const Make& make, double step) {
  const auto resting = make(box_on_slope(step, 0.6));
  run(*resting, 0.5, step);
  const Vector3d start_W = resting->position(0);
  run(*resting, 5.0, step);
  return (resting->position(0) - start_W).norm();
}

// Returns the period, measured over ten passages through the middle in the same direction.
double pendulum_period(const Make& make, double step) {
  constexpr double amplitude = 0.2;  // [rad]
  constexpr int periods = 10;
  const RigidBody body = bob(Vector3d::Zero(), {std::sin(amplitude), 0.0, -std::cos(amplitude)});
  const auto pendulum = make({.step = step, .bodies = {body}});
  double first = 0.0;
  int passages = 0;
  double before = pendulum->position(0).x();
  for (long tick = 1;; ++tick) {
    pendulum->step();
    const double now = pendulum->position(0).x();
    if (before > 0.0 && now <= 0.0) {
      const double time = step * (static_cast<double>(tick) - now / (now - before));
      if (passages++ == 0) first = time;
      if (passages > periods) {
        const double inertia = body.inertia.y() + body.mass;  // about the hinge, a metre away
        const double small = 2.0 * std::numbers::pi * std::sqrt(inertia / (body.mass * g));
        const double square = amplitude * amplitude;
        return (time - first) / periods - small * (1.0 + square / 16.0 + 11.0 * square * square / 3072.0);
      }
    }
    before = now;
  }
}

// Returns the energy error of two rods of one metre, released from the side.
double double_pendulum_energy(const Make& make, double step) {
  const Mechanism mechanism{
      .step = step,
      .bodies = {bob(Vector3d::Zero(), Vector3d::UnitX()), bob(Vector3d::UnitX(), 2.0 * Vector3d::UnitX())}};
  const auto pendulum = make(mechanism);
  const double start = energy_of(*pendulum, mechanism);
  double greatest = 0.0;
  for (auto steps = std::lround(5.0 / step); steps > 0; --steps) {
    pendulum->step();
    greatest = std::max(greatest, std::abs(energy_of(*pendulum, mechanism) - start));
  }
  return greatest;
}

// Returns the relative errors of energy and angular momentum of a box that rotates about the axis of its middle moment,
// where it turns over repeatedly.
std::pair<double, double> tumble(const Make& make, double step) {
  RigidBody body = box({0.3, 0.2, 0.1}, Vector3d::Zero());
  body.box.reset();
  body.angular_velocity_W = {0.1, 5.0, 0.1};
  const Mechanism mechanism{.step = step, .gravity = Vector3d::Zero(), .bodies = {body}};
  const auto tumbling = make(mechanism);
  const auto momentum = [&] {
    const Eigen::Matrix3d R = tumbling->rotation(0);
    return Vector3d(R * body.inertia.cwiseProduct(R.transpose() * tumbling->angular_velocity(0)));
  };
  const double energy = energy_of(*tumbling, mechanism);
  const Vector3d start = momentum();
  run(*tumbling, 10.0, step);
  return {energy_of(*tumbling, mechanism) / energy - 1.0, (momentum() - start).norm() / start.norm()};
}

struct Case {
  const char* name;
  const char* unit;
  double (*error)(const Make&, double step);
};
constexpr Case cases[] = {
    {"free fall, distance in 1 s", "mm", [](const Make& make, double step) { return 1e3 * fall(make, step); }},
    {"box sliding down a slope, speed after 1 s", "mm/s",
     [](const Make& make, double step) { return 1e3 * slide(make, step); }},
    {"box at rest on a slope, creep in 5 s", "mm",
     [](const Make& make, double step) { return 1e3 * creep(make, step); }},
    {"pendulum, period of 2 s", "ms", [](const Make& make, double step) { return 1e3 * pendulum_period(make, step); }},
    {"double pendulum, energy of 29 J in 5 s, greatest", "J", double_pendulum_energy},
    {"tumbling box, energy after 10 s", "%",
     [](const Make& make, double step) { return 100.0 * tumble(make, step).first; }},
    {"tumbling box, angular momentum after 10 s", "%",
     [](const Make& make, double step) { return 100.0 * tumble(make, step).second; }},
};

}  // namespace

AccuracyResult measure_accuracy(const std::string& name, const std::vector<EngineKind>& engines,
                                const Surroundings& surroundings) {
  AccuracyResult result{name, {}};
  for (const Case& of : cases) {
    surroundings.progress(fmt::format("{}: {}", name, of.name));
    AccuracyCase& found = result.cases.emplace_back();
    found.name = of.name;
    found.unit = of.unit;
    for (const EngineKind& engine : engines) {
      if (!engine.make_mechanism) continue;
      for (const double step : {0.01, 0.001}) {
        if (surroundings.stop) throw Interrupted();
        found.errors.push_back({engine.name, step, of.error(engine.make_mechanism, step)});
      }
    }
  }
  return result;
}

}  // namespace cohort::bench
