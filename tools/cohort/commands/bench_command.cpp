#include <fmt/format.h>

#include <iostream>

#include "tools/bench/bench.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/cli/output_file.hpp"

namespace cohort::tool {
namespace {

int measure_scenes(const BenchCommand& command, Log& log, const bench::Surroundings& surroundings) {
  constexpr const char* what = "the results";
  try {
    bench::check_engines(command.options);
    if (!command.json.empty()) check_writable(what, command.json);
  } catch (const std::exception& error) {
    log.error(error.what());
    return exit_usage;
  }
  std::cout << bench::missing_engines() << std::flush;
  const auto print = [&](const std::string& table) {
    log.clear_progress();
    std::cout << '\n' << table << std::flush;
  };
  const auto results = command.thesis ? bench::measure_thesis(*command.thesis, surroundings, print)
                                      : bench::measure_all(command.options, surroundings, print);
  if (!command.json.empty()) write_file(what, command.json, results.dump(2) + "\n");
  return exit_ok;
}

int measure_lockstep(const BenchCommand& command, Log& log, const bench::Surroundings& surroundings) {
  constexpr const char* what = "the results";
  constexpr const char* graph = "the graph";
  try {
    if (!command.json.empty()) check_writable(what, command.json);
    if (!command.svg.empty()) check_writable(graph, command.svg);
  } catch (const std::exception& error) {
    log.error(error.what());
    return exit_usage;
  }
  const auto results = bench::measure_lockstep(*command.lockstep, surroundings, [&](const std::string& line) {
    log.clear_progress();
    std::cout << line << std::flush;
  });
  if (!command.json.empty()) write_file(what, command.json, results.json.dump(2) + "\n");
  if (!command.svg.empty()) write_file(graph, command.svg, results.graph);
  return exit_ok;
}

}  // namespace

int bench(const BenchCommand& command, Log& log, const std::atomic<bool>& stop) {
  const bench::Surroundings surroundings{[&](const std::string& message) { log.progress(message); }, stop};
  try {
    if (command.client) return bench::run_bench_client(*command.client, stop);
    if (command.lockstep) return measure_lockstep(command, log, surroundings);
    return measure_scenes(command, log, surroundings);
  } catch (const bench::Interrupted&) {
    return exit_interrupted;
  } catch (const std::exception& error) {
    log.error(error.what());
    return exit_failed;
  }
}

}  // namespace cohort::tool
