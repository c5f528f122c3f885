// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "tools/view/sources/live_source.hpp"
#include "tools/view/sources/recording_source.hpp"

namespace cohort::view {

/// A running server. After its end, the request `replay` shows the recording that it wrote instead. The request `again`
/// repeats the run, if the options say how.
class FollowedRun final : public Source {
 public:
  /// `recording` is empty if there is none. `threads` is the number of threads that replay it. `topics` must outlive
  /// this. Throws wire::WireError like LiveSource.
  FollowedRun(LiveOptions options, std::filesystem::path recording, unsigned threads, Topics& topics);

  void ask(const ViewRequest& request, std::function<void(const Answer&)> answer) override;
  void watch(const std::vector<std::uint32_t>& robots) override;
  void leave(std::uint64_t visitor) override;
  /// Returns whether the server has ended. Any thread.
  bool has_ended() const;
  /// Starts a run that waits for its first visitor. Any thread.
  void play_unseen();

 private:
  Answer replay();
  Answer run_again() const;
  Source& shown() { return replayed_ ? static_cast<Source&>(*replayed_) : *live_; }

  const std::filesystem::path file_;
  const bool may_control_;
  const std::function<void()> run_again_;
  const unsigned threads_;
  Topics& topics_;
  mutable std::mutex mutex_;
  std::unique_ptr<LiveSource> live_;  // null once the recording is shown
  std::optional<recording::Recording> recording_;
  std::unique_ptr<RecordingSource> replayed_;
};

}  // namespace cohort::view
