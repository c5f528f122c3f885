#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "tools/view/sources/live_source.hpp"
#include "tools/view/sources/recording_source.hpp"

namespace cohort::view {

/// A running server, and when it has ended the recording that it wrote: `replay` shows that from then on. `again`
/// repeats the run, if the options say how.
class FollowedRun final : public Source {
 public:
  /// `recording` is empty where there is none. `threads` replay it. `topics` must outlive this. Throws wire::WireError
  /// as LiveSource does.
  FollowedRun(LiveOptions options, std::filesystem::path recording, unsigned threads, Topics& topics);

  void ask(const ViewRequest& request, std::function<void(const Answer&)> answer) override;
  void watch(const std::vector<std::uint32_t>& robots) override;
  void leave(std::uint64_t visitor) override;
  /// Any thread, as the next.
  bool has_ended() const;
  /// Starts a run that waits for its first visitor.
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
  std::unique_ptr<LiveSource> live_;  // this, or those below
  std::optional<recording::Recording> recording_;
  std::unique_ptr<RecordingSource> replayed_;
};

}  // namespace cohort::view
