#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "client_sdk/src/control_client.hpp"
#include "server/recording/mcap/disk_file.hpp"
#include "server/recording/mcap/recover.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/cli/output_file.hpp"

namespace cohort::tool {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds for_ever{std::chrono::hours{24 * 365}};
constexpr milliseconds for_a_reply{30'000};
constexpr milliseconds until_it_knows{1'000};
constexpr milliseconds poll_interval{50};
constexpr milliseconds until_a_notice{2'000};

// As an experiment would say it; JSON is YAML too.
std::string recorded_text(const RecordOptions& options) {
  nlohmann::json text;
  if (options.pose_rate) text["poses"] = *options.pose_rate;
  if (options.joint_rate) text["joints"] = *options.joint_rate;
  if (options.observation_rate) text["observations"] = *options.observation_rate;
  if (options.snapshot_interval) text["snapshots"] = *options.snapshot_interval;
  if (!options.robots.empty()) text["robots"] = options.robots;
  return text.empty() ? "" : text.dump();
}

// One call of the command.
class LiveRecording {
 public:
  LiveRecording(const RecordCommand& command, Log& log, const std::atomic<bool>& stop)
      : command_(command),
        log_(log),
        stop_(stop),
        client_({.server = command.server,
                 .domain = domain(),
                 .secure = command.secure.string(),
                 .label = "cohort record"}) {}

  int run() {
    if (!find_server()) return exit_interrupted;
    std::string text;
    try {
      text = client_.start_recording(recorded_text(command_.record), for_ever, stop_);
    } catch (const std::exception&) {
      if (stop_) return exit_interrupted;
      throw;
    }
    file_.emplace(command_.record.file);
    log_.notice(fmt::format("{}: {}", command_.record.file.string(), text));
    return fetch();
  }

 private:
  std::uint32_t domain() const { return command_.domains.empty() ? 0 : command_.domains.front(); }

  bool find_server() {
    if (!client_.wait_for_server(until_a_notice, stop_) && !stop_)
      log_.notice(fmt::format("waiting for a server at {}, domain {}", command_.server, domain()));
    return client_.wait_for_server(for_ever, stop_);
  }

  // All of the file, to its end; a signal brings that about.
  int fetch() {
    try {
      for (;;) {
        if (stop_ && !std::exchange(is_stopped_, true)) client_.stop_recording(for_a_reply, never_);
        const ControlClient::RecordingPart part = client_.get_recording(size_, for_a_reply, never_);
        file_->write(std::as_bytes(std::span(part.bytes)));
        size_ += part.bytes.size();
        if (part.is_last) return finish(part);
        if (part.bytes.empty()) std::this_thread::sleep_for(poll_interval);
      }
    } catch (const recording::FileError& error) {
      log_.error(fmt::format("{}. 'cohort recover' closes what is there", error.what()));
    } catch (const std::exception& error) {
      log_.error(fmt::format("the recording ended before its run: {}. {}", error.what(), close_what_came()));
    }
    return exit_failed;
  }

  int finish(const ControlClient::RecordingPart& last) {
    file_->finish();
    try {
      client_.get_recording(size_, until_it_knows, never_);  // so that the server may go
    } catch (const ControlError&) {                          // it has gone already
    }
    log_.notice(fmt::format("{}: {:.1f} MB, {}", command_.record.file.string(), 1e-6 * static_cast<double>(size_),
                            is_stopped_ ? "stopped" : "to the end of the run"));
    if (last.problem.empty()) return exit_ok;
    log_.warning(last.problem);
    return exit_failed;
  }

  std::string close_what_came() {
    try {
      file_.reset();
      return recording::recover(command_.record.file, command_.record.file).text();
    } catch (const std::exception& error) {
      return error.what();
    }
  }

  const RecordCommand& command_;
  Log& log_;
  const std::atomic<bool>& stop_;
  const std::atomic<bool> never_{false};
  ControlClient client_;
  std::optional<recording::DiskFile> file_;
  std::uint64_t size_ = 0;
  bool is_stopped_ = false;
};

}  // namespace

int record(const RecordCommand& command, Log& log, const std::atomic<bool>& stop) {
  try {
    check_writable("the recording", command.record.file);
    recording::check_not_being_written(command.record.file);
    LiveRecording recording(command, log, stop);
    try {
      return recording.run();
    } catch (const std::exception& error) {
      log.error(error.what());
      return exit_failed;
    }
  } catch (const std::exception& error) {
    log.error(error.what());
  }
  return exit_usage;
}

}  // namespace cohort::tool
