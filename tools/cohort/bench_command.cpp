#include <fmt/format.h>

#include <iostream>

#include "tools/bench/bench.hpp"
#include "tools/cohort/commands.hpp"
#include "tools/cohort/output_file.hpp"

namespace cohort::tool {

int bench(const BenchCommand& command, Log& log, const std::atomic<bool>& stop) {
  constexpr const char* what = "the results";
  try {
    bench::check_engines(command.options);
    if (!command.json.empty()) check_writable(what, command.json);
  } catch (const std::exception& error) {
    log.error(error.what());
    return exit_usage;
  }
  try {
    std::cout << bench::missing_engines() << std::flush;
    const bench::Surroundings surroundings{[&](const std::string& message) { log.progress(message); }, stop};
    const auto print = [&](const std::string& table) {
      log.clear_progress();
      std::cout << '\n' << table << std::flush;
    };
    const auto results = command.thesis ? bench::measure_thesis(*command.thesis, surroundings, print)
                                        : bench::measure_all(command.options, surroundings, print);
    if (!command.json.empty()) write_file(what, command.json, results.dump(2) + "\n");
    return exit_ok;
  } catch (const bench::Interrupted&) {
    return exit_interrupted;
  } catch (const std::exception& error) {
    log.error(error.what());
    return exit_failed;
  }
}

}  // namespace cohort::tool
