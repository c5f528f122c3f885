// SPDX-License-Identifier: Apache-2.0

// Prints a table of the cost of a batch of many small worlds. Each has one s-bot, in an empty square or among 24 posts.
//
//   batch_benchmark [--worlds N] [--seconds S] [--resets N]
//
// Rates are ticks of single worlds per second of CPU time, on one thread. The memory of a world is the growth of the
// heap for each world after the first. A reset uses a new seed and draws the poses of the posts again.

#include <malloc.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>

#include "server/batch/batch.hpp"
#include "server/parsing/experiment/read_experiment.hpp"

namespace cohort {
namespace {

struct Options {
  std::size_t worlds = 256;
  double seconds = 1.0;  // duration of each measurement
  std::uint64_t resets = 1'000'000;
};

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double heap_kib() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / 1024.0;
}

description::Experiment experiment_of(const std::string& name, description::Fidelity fidelity) {
  description::Experiment experiment =
      parsing::read_experiment(COHORT_SOURCE_DIR "/tests/data/batch/" + name + ".yaml");
  experiment.world.physics.fidelity = fidelity;
  experiment.duration = std::chrono::hours(1000);
  return experiment;
}

// Makes all robots drive in wide circles.
void drive(Batch& batch) {
  for (std::size_t i = 0; i < batch.commands().size(); i += batch.command_size()) {
    batch.commands()[i] = 0.08;
    batch.commands()[i + 1] = 0.06;
  }
}

// Returns the ticks of all worlds together per second of CPU time, with `ticks` in each call of `step`.
double rate(Batch& batch, std::uint64_t ticks, double seconds) {
  drive(batch);
  batch.step(ticks);
  const double begin = cpu_seconds();
  std::uint64_t count = 0;
  double passed = 0.0;
  while ((passed = cpu_seconds() - begin) < seconds) {
    batch.step(ticks);
    count += ticks * batch.worlds();
  }
  return static_cast<double>(count) / passed;
}

// Time of one reset [us], and the growth of the heap over all resets except the first tenth [KiB].
struct ResetCost {
  double microseconds = 0.0;
  double growth = 0.0;
};
ResetCost reset_cost(Batch& batch, std::uint64_t resets) {
  double heap = 0.0;
  double begin = cpu_seconds();
  for (std::uint64_t i = 0; i < resets; ++i) {
    if (i == resets / 10) heap = heap_kib();
    if (i % 4096 == 4095) batch.step();  // step every world
    batch.reset(i % batch.worlds(), i);
  }
  return {(cpu_seconds() - begin) * 1e6 / static_cast<double>(resets), heap_kib() - heap};
}

void measure(const std::string& name, description::Fidelity fidelity, const Options& options) {
  const description::Experiment experiment = experiment_of(name, fidelity);
  const bool is_planar = fidelity == description::Fidelity::planar;
  Batch one(experiment, 1, 1);
  const double before = heap_kib();
  Batch many(experiment, options.worlds, 1);
  drive(many);
  many.step(100);
  const double each = (heap_kib() - before) / static_cast<double>(options.worlds);
  for (std::size_t world = 0; world < many.worlds(); ++world) many.reset(world, world);
  const double of_one = rate(one, 1, options.seconds);
  const double of_many = rate(many, 1, options.seconds);
  const double ten_at_once = rate(many, 10, options.seconds);
  const ResetCost cost = reset_cost(many, options.resets);
  std::printf("| %-7s | %-6s | %7.1f | %7.1f (%.2f) | %7.1f (%.2f) | %6.1f | %6.1f | %6.1f |\n", name.c_str(),
              is_planar ? "planar" : "treel", of_one / 1e3, of_many / 1e3, of_many / of_one, ten_at_once / 1e3,
              ten_at_once / of_one, each, cost.microseconds, cost.growth);
  std::fflush(stdout);
}

}  // namespace
}  // namespace cohort

int main(int count, char** arguments) {
  cohort::Options options;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string name = arguments[i];
    if (name == "--worlds") options.worlds = std::strtoull(arguments[i + 1], nullptr, 10);
    if (name == "--seconds") options.seconds = std::strtod(arguments[i + 1], nullptr);
    if (name == "--resets") options.resets = std::strtoull(arguments[i + 1], nullptr, 10);
  }
  std::printf(
      "| world   | physics | 1 world [k ticks/CPU-s] | %zu worlds, 1 tick a visit | 10 ticks a visit | KiB a world | "
      "us a reset | KiB that %llu resets leave |\n|---|---|---|---|---|---|---|---|\n",
      options.worlds, static_cast<unsigned long long>(options.resets));
  for (const char* name : {"alone", "posts"})
    for (const auto fidelity : {cohort::description::Fidelity::treel, cohort::description::Fidelity::planar})
      cohort::measure(name, fidelity, options);
}
