// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/measuring/build_cost.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <string_view>

#include "tests/benchmarks/comparison/measuring/clocks.hpp"

namespace cohort::bench {
namespace {

// The result that a child process sends to its parent.
struct Built {
  double cpu = 0.0;               // [s]
  double resident = 0.0;          // resident memory of the whole process [bytes]
  std::array<char, 200> error{};  // reason of a failure; empty if there was none
};

double resident_bytes() {
  std::ifstream statm("/proc/self/statm");  // in pages: total, then resident
  double whole = 0.0;
  double resident = 0.0;
  statm >> whole >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

Built build_here(const EngineKind& kind, std::uint32_t robots, std::uint64_t seed) {
  const double before = cpu_seconds();
  const Scene scene = crowd(robots, seed);
  const std::unique_ptr<Engine> engine = kind.make(scene, 1);
  engine->step();
  return {cpu_seconds() - before, resident_bytes(), {}};
}

// The child process, which exits without cleaning up: that is left to the parent.
[[noreturn]] void build_and_report(const EngineKind& kind, std::uint32_t robots, std::uint64_t seed, int report) {
  Built built;
  try {
    built = build_here(kind, robots, seed);
  } catch (const std::exception& error) {
    const std::string_view text = error.what();
    std::copy_n(text.begin(), std::min(text.size(), built.error.size() - 1), built.error.begin());
  }
  _exit(write(report, &built, sizeof built) == sizeof built ? 0 : 1);
}

Built build_in_child(const EngineKind& kind, std::uint32_t robots, std::uint64_t seed) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("cannot create a pipe to a child process");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot start a child process");
  if (child == 0) {
    close(ends[0]);
    build_and_report(kind, robots, seed, ends[1]);
  }
  close(ends[1]);
  Built built;
  const bool reported = read(ends[0], &built, sizeof built) == sizeof built;
  close(ends[0]);
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  if (!reported) throw std::runtime_error("the process that builds the world ended without a result");
  if (built.error[0] != '\0') throw std::runtime_error(built.error.data());
  return built;
}

}  // namespace

BuildResult measure_build(const std::string& name, std::uint32_t robots, const std::vector<EngineKind>& engines,
                          const Options& options, const Surroundings& surroundings) {
  BuildResult result{name, robots, {}, {}};
  for (const EngineKind& kind : engines) {
    if (const auto reason = kind.limitation(crowd(robots, options.seed))) {
      result.left_out.push_back({kind.name, *reason});
      continue;
    }
    std::vector<double> cpu;
    std::vector<double> bytes;
    try {
      for (unsigned repetition = 0; repetition < options.repetitions; ++repetition) {
        if (surroundings.stop) throw Interrupted();
        surroundings.progress(fmt::format("{}, {} robots: {}, repetition {} of {}", name, robots, kind.name,
                                          repetition + 1, options.repetitions));
        const Built one = build_in_child(kind, 1, options.seed);
        const Built all = build_in_child(kind, robots, options.seed);
        cpu.push_back(all.cpu);
        bytes.push_back((all.resident - one.resident) / std::max(1u, robots - 1));
      }
      result.costs.push_back({kind.name, spread_of(cpu), spread_of(bytes).median});
    } catch (const std::runtime_error& error) {  // a signal may also have interrupted the read
      if (surroundings.stop) throw Interrupted();
      result.left_out.push_back({kind.name, error.what()});
    }
  }
  return result;
}

}  // namespace cohort::bench
