// SPDX-License-Identifier: Apache-2.0
#include "tools/view/sources/followed_run.hpp"

#include <utility>

namespace cohort::view {
namespace {

LiveOptions with_recording(LiveOptions options, const std::filesystem::path& recording) {
  options.recording = recording.filename().string();
  return options;
}

}  // namespace

FollowedRun::FollowedRun(LiveOptions options, std::filesystem::path recording, unsigned threads, Topics& topics)
    : file_(std::move(recording)),
      may_control_(options.may_control),
      run_again_(options.run_again),
      threads_(threads),
      topics_(topics),
      live_(std::make_unique<LiveSource>(with_recording(std::move(options), file_), topics)) {}

void FollowedRun::ask(const ViewRequest& request, std::function<void(const Answer&)> answer) {
  const std::lock_guard lock(mutex_);
  if (request.operation == "replay") return answer(replay());
  if (request.operation == "again") return answer(run_again());
  shown().ask(request, std::move(answer));
}

void FollowedRun::watch(const std::vector<std::uint32_t>& robots) {
  const std::lock_guard lock(mutex_);
  shown().watch(robots);
}

void FollowedRun::leave(std::uint64_t visitor) {
  const std::lock_guard lock(mutex_);
  shown().leave(visitor);
}

bool FollowedRun::has_ended() const {
  const std::lock_guard lock(mutex_);
  return live_ == nullptr || live_->has_ended();
}

void FollowedRun::play_unseen() {
  const std::lock_guard lock(mutex_);
  if (live_ != nullptr) live_->play_unseen();
}

Answer FollowedRun::run_again() const {
  if (!may_control_) return {false, "this view is read-only: start it with '--control' to run again from the page"};
  if (!run_again_) return {false, "this view was not started by 'cohort run', which can repeat a run"};
  if (live_ && !live_->has_ended()) return {false, "the run has not ended yet"};
  run_again_();
  return {true, "the run is repeated"};
}

Answer FollowedRun::replay() {
  if (replayed_) return {true, "the recording is shown"};
  if (file_.empty()) return {false, "nothing was recorded: use 'cohort run --record FILE'"};
  if (!live_->has_ended()) return {false, "the run has not ended yet"};
  try {
    recording_.emplace(file_);
    if (!recording_->damage().empty()) throw std::runtime_error(recording_->damage());
    auto replayed = std::make_unique<RecordingSource>(*recording_, topics_, threads_);
    live_.reset();
    replayed_ = std::move(replayed);
  } catch (const std::exception& error) {
    recording_.reset();
    return {false, std::string("the recording cannot be shown; it may still be being written: ") + error.what()};
  }
  return {true, "shows " + file_.filename().string()};
}

}  // namespace cohort::view
