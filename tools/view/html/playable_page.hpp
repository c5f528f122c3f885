// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "server/recording/replay.hpp"
#include "tools/view/html/html_file.hpp"
#include "tools/view/html/message_block.hpp"
#include "tools/view/sources/replay_publisher.hpp"

namespace cohort::view {

struct PlayableOptions {
  double frame_rate = 20.0;  ///< frames per second of log time; at most one per tick boundary
  std::chrono::nanoseconds from{0};
  std::chrono::nanoseconds to = std::chrono::nanoseconds::max();
  std::vector<std::uint32_t> robots{};  ///< ids of robots whose observations and commands are included
  bool has_contacts = false;
};

/// A recording in an HTML file, as the messages that a view publishes. The page decodes them block by block. All blocks
/// except the last contain messages; the last is their table of contents, as JSON. Used on the thread of the replay.
class PlayablePage {
 public:
  /// All arguments must outlive this.
  PlayablePage(const recording::Recording& recording, const recording::Replay& replay, const PlayableOptions& options,
               HtmlFile& file);

  /// Adds the state of the replay if a frame is due. Must be called at each tick boundary.
  void visit();
  /// Writes the remaining frames, the events and the table. The file is not committed.
  void finish();

  std::size_t frame_count() const { return frame_count_; }
  /// Returns the time from the first frame to the last.
  std::chrono::nanoseconds duration() const { return last_ - first_; }

 private:
  struct Chunk {
    std::size_t block = 0;
    std::size_t scene = 0;              // block of its scene
    std::vector<std::int64_t> times{};  // log time of each frame [ns]
    std::vector<std::uint64_t> ticks{};
  };

  bool is_due(std::chrono::nanoseconds log_time);
  void add_scene();
  void add_frame(std::chrono::nanoseconds log_time);
  void add_newest(Topic topic);
  void close_chunk();

  const recording::Recording& recording_;
  const recording::Replay& replay_;
  const PlayableOptions& options_;
  HtmlFile& file_;
  Topics topics_;
  ReplayPublisher publisher_;
  const std::chrono::nanoseconds end_;  // log time of the last boundary to show

  MessageBlock block_;
  Chunk chunk_;
  std::vector<Chunk> chunks_;
  std::size_t scene_ = 0;
  std::uint64_t scene_version_ = 0;
  std::uint64_t signals_version_ = 0;
  std::uint64_t due_frames_ = 0;  // frames due so far at frame_rate
  std::size_t frame_count_ = 0;
  std::chrono::nanoseconds first_{0};
  std::chrono::nanoseconds last_{0};
};

}  // namespace cohort::view
