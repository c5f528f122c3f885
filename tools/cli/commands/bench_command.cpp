// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "tools/cli/commands/commands.hpp"
#include "tools/cli/common/become.hpp"

namespace cohort::tool {
namespace {

constexpr const char* bench_name = "bench";

int become_bench(Log& log) {
  const std::string program = "cohort-bench";
  std::vector<std::string> words = own_words();
  // Options before the name of the command are options of cohort-bench too.
  words.erase(std::find(words.begin() + 1, words.end(), bench_name));
  words.front() = program;
  const std::filesystem::path beside = path_beside(program);
  int error = become(beside, words);
  if (error == ENOENT) error = become(program, words);
  if (error == ENOENT)
    log.error(
        fmt::format("'cohort bench' requires the program {}, which is neither in {} nor in PATH; 'cmake --build "
                    "--preset release --target {}' builds it from source",
                    program, beside.parent_path().string(), program));
  else
    log.error(fmt::format("cannot start {}: {}", program, std::system_category().message(error)));
  return exit_usage;
}

}  // namespace

Subcommand add_bench(CommandLine app) {
  CommandLine line = app.add_subcommand(
      bench_name, "Compare the performance of Cohort with that of other physics engines on the same scenes");
  line.take_all();
  line.footer(
      "This command starts the program cohort-bench with the same arguments; 'cohort bench --help' prints its help.\n"
      "Example: cohort bench --scene crowd --robots 128,1000 --json results.json");
  return {line, [](Log& log, const std::atomic<bool>&) { return become_bench(log); }};
}

}  // namespace cohort::tool
