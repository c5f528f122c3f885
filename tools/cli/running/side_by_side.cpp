// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/side_by_side.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "server/core/processors.hpp"
#include "tools/cli/common/exit_codes.hpp"
#include "tools/cli/running/summary_file.hpp"
#include "tools/cli/running/team_controllers.hpp"
#include "tools/common/processes/children.hpp"

namespace cohort::tool {
namespace {

// Options whose values differ from run to run.
constexpr std::string_view options_of_runs[] = {"--seeds", "--jobs",   "--summary", "--plot",
                                                "--csv",   "--record", "--repeat"};

// Returns the words of this process's command line without those options, and what comes after `--`.
std::pair<std::vector<std::string>, std::vector<std::string>> shared_arguments() {
  std::ifstream words("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> options;
  std::string word;
  std::getline(words, word, '\0');  // the program's path
  while (std::getline(words, word, '\0') && word != "--") {
    const std::string_view name = std::string_view(word).substr(0, word.find('='));
    if (std::ranges::find(options_of_runs, name) == std::ranges::end(options_of_runs))
      options.push_back(word);
    else if (name == word)
      std::getline(words, word, '\0');  // its value
  }
  std::vector<std::string> operands;
  while (std::getline(words, word, '\0')) operands.push_back(word);
  return {options, operands};
}

// A folder for files that only this run reads, gone with this.
class SummaryFolder {
 public:
  SummaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "cohort-seeds-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw std::runtime_error(
          fmt::format("cannot create the temporary folder {}: {}", pattern, std::generic_category().message(errno)));
    path_ = pattern;
  }
  SummaryFolder(const SummaryFolder&) = delete;
  SummaryFolder& operator=(const SummaryFolder&) = delete;
  ~SummaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct EndedRun {
  std::uint64_t run = 0;
  int exit_code = 0;
  std::string death{};  // if a signal ended it, or it could not be started
};

// The ends of processes, from the threads that watch them.
class EndedRuns {
 public:
  void add(EndedRun ended) {
    const std::lock_guard lock(mutex_);
    ended_.push_back(std::move(ended));
    changed_.notify_all();
  }
  std::deque<EndedRun> take_within(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, patience, [&] { return !ended_.empty(); });
    return std::exchange(ended_, {});
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<EndedRun> ended_;
};

class SideBySide {
 public:
  SideBySide(const RunCommand& command, const description::Experiment& experiment, unsigned jobs, Log& log)
      : command_(command), jobs_(jobs), log_(log), count_(command.seeds.size() * command.repeat) {
    std::tie(options_, operands_) = shared_arguments();
    if (command.threads == 0 && experiment.threads == 0) threads_ = std::max(1U, available_processors() / jobs);
  }

  int run(const std::atomic<bool>& stop, const std::function<void(SeedRow)>& ended) {
    constexpr std::chrono::milliseconds interval{50};
    int code = exit_ok;
    std::uint64_t next = 1;
    for (;;) {
      for (; code == exit_ok && next <= count_ && running_.size() < jobs_; ++next) start(next);
      if (running_.empty()) return code;
      for (const EndedRun& each : ends_.take_within(interval)) {
        running_.erase(each.run);
        if (each.exit_code == exit_ok && each.death.empty()) {
          ended(read_seed_row(each.run, outputs(each.run).summary));
        } else if (code == exit_ok) {
          code = each.death.empty() ? each.exit_code : exit_failed;
          log_.error(fmt::format("run {} of {}, seed {}, failed{}", each.run, count_, seed(each.run),
                                 each.death.empty() ? "" : ": " + each.death));
        }
      }
      if (!stop) continue;
      running_.clear();
      return exit_interrupted;
    }
  }

 private:
  std::uint64_t seed(std::uint64_t run) const { return command_.seeds[(run - 1) % command_.seeds.size()]; }

  Outputs outputs(std::uint64_t run) const {
    Outputs one = numbered_by_seed(command_.outputs, run, count_);
    if (one.summary.empty()) one.summary = scratch_.path() / (std::to_string(run) + ".json");
    return one;
  }

  void start(std::uint64_t run) {
    const Outputs files = outputs(run);
    Children::Command process{.arguments = {std::filesystem::read_symlink("/proc/self/exe")},
                              .name = fmt::format("run {}", run),
                              .restarts = false,
                              .is_controller = false};
    const auto add = [&](const std::string& option, const std::string& value) {
      if (!value.empty()) process.arguments.insert(process.arguments.end(), {option, value});
    };
    process.arguments.insert(process.arguments.end(), options_.begin(), options_.end());
    process.arguments.emplace_back("--is-part");
    add("--seed", std::to_string(seed(run)));
    add("--threads", threads_ == 0 ? "" : std::to_string(threads_));
    add("--summary", files.summary.string());
    add("--plot", files.plot.string());
    add("--csv", files.csv.string());
    add("--record", files.recording.string());
    if (!operands_.empty()) process.arguments.emplace_back("--");
    process.arguments.insert(process.arguments.end(), operands_.begin(), operands_.end());
    Children::Listener listener;
    listener.wrote = [this, run](const Children::Command&, const std::string& line) {
      log_.echo(line, {{"seed", seed(run)}});
    };
    listener.may_end_with = [this, run](int code) {
      ends_.add({run, code});
      return true;
    };
    listener.gave_up = [this, run](const std::string& text) { ends_.add({run, exit_failed, text}); };
    running_[run] = std::make_unique<Children>(std::vector{std::move(process)}, std::move(listener));
  }

  const RunCommand& command_;
  unsigned jobs_;
  Log& log_;
  std::uint64_t count_;
  std::vector<std::string> options_;
  std::vector<std::string> operands_;
  unsigned threads_ = 0;  // threads per run; 0: as requested
  SummaryFolder scratch_;
  EndedRuns ends_;
  std::map<std::uint64_t, std::unique_ptr<Children>> running_;  // by run
};

}  // namespace

std::string what_needs_one_job(const RunCommand& command, const description::Experiment& experiment) {
  if (command.controllers == Controllers::external) return "'--controllers external'";
  if (command.view) return "'--view'";
  if (command.ros2) return "'--ros2'";
  if (command.paused) return "'--paused'";
  if (command.keep_interval > 0.0) return "'--keep-snapshots'";
  if (!command.domains.empty()) return "'--domain'";
  if (has_keyboard(experiment)) return "the controller 'keyboard'";
  return "";
}

unsigned jobs_for(const RunCommand& command, const description::Experiment& experiment, std::size_t count) {
  const std::string obstacle = what_needs_one_job(command, experiment);
  if (command.jobs > 1 && !obstacle.empty())
    throw std::invalid_argument(fmt::format("'--jobs {}' cannot be used with {}", command.jobs, obstacle));
  if (command.jobs > 0) return command.jobs;
  const bool depends_on_speed = std::ranges::any_of(experiment.teams, [](const description::Team& team) {
    return team.policy.mode == description::Mode::free || team.policy.on_late != description::OnLate::wait;
  });
  if (!obstacle.empty() || depends_on_speed) return 1;
  const unsigned threads = std::max({1U, command.threads, experiment.threads});
  const std::size_t most = std::max(1U, available_processors() / threads);
  return static_cast<unsigned>(std::min(most, count));
}

int run_side_by_side(const RunCommand& command, const description::Experiment& experiment, unsigned jobs, Log& log,
                     const std::atomic<bool>& stop, const std::function<void(SeedRow)>& ended) {
  return SideBySide(command, experiment, jobs, log).run(stop, ended);
}

}  // namespace cohort::tool
