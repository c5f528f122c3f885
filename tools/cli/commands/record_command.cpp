// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cohort/control.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/recording/mcap/reading/recover.hpp"
#include "server/recording/mcap/writing/disk_file.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/shown.hpp"
#include "tools/cli/running/run_recording.hpp"

namespace cohort::tool {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds until_it_knows{1'000};
constexpr milliseconds asks_again_after{50};
constexpr milliseconds until_a_notice{2'000};

// Returns the options in the format of an experiment; JSON is valid YAML.
std::string recorded_text(const RecordOptions& options) {
  nlohmann::json text;
  if (options.pose_rate) text["poses"] = *options.pose_rate;
  if (options.joint_rate) text["joints"] = *options.joint_rate;
  if (options.observation_rate) text["observations"] = *options.observation_rate;
  if (options.snapshot_interval) text["snapshots"] = *options.snapshot_interval;
  if (!options.robots.empty()) text["robots"] = options.robots;
  return text.empty() ? "" : json_text(text);
}

struct RecordCommand {
  std::filesystem::path file;
  RecordOptions record{};
  Connection connection{};
};

// One execution of the command.
class LiveRecording {
 public:
  LiveRecording(const RecordCommand& command, Log& log, const std::atomic<bool>& stop)
      : command_(command),
        log_(log),
        stop_(stop),
        control_({.server = command.connection.server,
                  .domain = command.connection.domain(),
                  .secure = command.connection.secure.string(),
                  .label = "cohort record",
                  .time_limit = for_ever}) {
    control_.stop_on(&stop_);
  }

  int run() {
    if (!find_server()) return exit_interrupted;
    std::string text;
    try {
      text = control_.start_recording(recorded_text(command_.record)).message;
    } catch (const std::exception&) {
      if (stop_) return exit_interrupted;
      throw;
    }
    file_.emplace(command_.file);
    log_.notice(fmt::format("{}: {}", command_.file.string(), text));
    return fetch();
  }

 private:
  bool find_server() {
    if (!control_.wait_for_server(until_a_notice) && !stop_)
      log_.notice(fmt::format("waiting for a server at {}, domain {}", command_.connection.server,
                              command_.connection.domain()));
    return control_.wait_for_server(for_ever);
  }

  // Fetches the whole file. A signal makes the server end it.
  int fetch() {
    control_.stop_on(nullptr);
    control_.set_time_limit(for_a_reply);
    try {
      for (;;) {
        if (stop_ && !std::exchange(is_stopped_, true)) control_.stop_recording();
        const cohort::RecordingPart part = control_.fetch_recording(size_);
        file_->write(part.bytes);
        size_ += part.bytes.size();
        sync_if_due();
        if (part.is_last) return finish(part);
        if (part.bytes.empty()) std::this_thread::sleep_for(asks_again_after);
      }
    } catch (const recording::FileError& error) {
      log_.error(fmt::format("{}. 'cohort recover' makes the file readable", error.what()));
    } catch (const std::exception& error) {
      log_.error(fmt::format("the recording ended before the run: {}. {}", text_of(error), close_what_came()));
    }
    return exit_failed;
  }

  // Called from the first part on, which gives the file its name.
  void sync_if_due() {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_sync_) return;
    file_->sync();
    next_sync_ = now + std::chrono::seconds(1);
  }

  int finish(const cohort::RecordingPart& last) {
    file_->finish();
    try {
      control_.set_time_limit(until_it_knows);
      control_.fetch_recording(size_);  // so that the server may end
    } catch (const ControlError&) {     // it has already ended
    }
    log_.notice(fmt::format("{}: {:.1f} MB, {}", command_.file.string(), 1e-6 * static_cast<double>(size_),
                            is_stopped_ ? "stopped" : "to the end of the run"));
    const bool is_bag = !command_.record.makes_rosbag2 || make_bag();
    if (!last.problem.empty()) log_.warning(last.problem);
    return last.problem.empty() && is_bag ? exit_ok : exit_failed;
  }

  bool make_bag() {
    try {
      write_rosbag2_metadata(command_.file);
      return true;
    } catch (const std::exception& error) {
      log_.error(text_of(error));
      return false;
    }
  }

  std::string close_what_came() {
    try {
      file_.reset();
      return recording::recover(command_.file, command_.file).text();
    } catch (const std::exception& error) {
      return error.what();
    }
  }

  const RecordCommand& command_;
  Log& log_;
  const std::atomic<bool>& stop_;
  Control control_;
  std::optional<recording::DiskFile> file_;
  std::uint64_t size_ = 0;
  std::chrono::steady_clock::time_point next_sync_{};
  bool is_stopped_ = false;
};

int record(const RecordCommand& command, Log& log, const std::atomic<bool>& stop) {
  check_writable("the recording", command.file);
  recording::check_not_being_written(command.file);
  if (command.record.makes_rosbag2) check_rosbag2_metadata(command.file);
  LiveRecording recording(command, log, stop);
  try {
    return recording.run();
  } catch (const std::exception& error) {
    log.error(text_of(error));
    return exit_failed;
  }
}

}  // namespace

Subcommand add_record(CommandLine app) {
  const auto command = std::make_shared<RecordCommand>();
  CommandLine line = app.add_subcommand("record", "Record the run of a server from now on");
  line.add_option("-o,--output", command->file, "File to write (MCAP)").required().type_name("FILE");
  add_recorded_options(line, command->record, "--");
  add_server_option(line, command->connection.server);
  add_domain_option(line, command->connection.domains, domain_of_server);
  add_secure_option(line, command->connection.secure,
                    "Folder of an identity that may observe or control the run (default: $COHORT_SECURE)");
  line.footer("Example: cohort record --server 10.0.0.5 --domain 7 -o run.mcap");
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return record(*command, log, stop); }};
}

}  // namespace cohort::tool
