// SPDX-License-Identifier: Apache-2.0
#include "tools/view/html/playable_page.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "idl/messages/scene_messages.hpp"

namespace cohort::view {
namespace {

using Nanoseconds = std::chrono::nanoseconds;

// A chunk is decoded as a whole when a frame in it is wanted.
constexpr std::size_t most_frames = 64;
constexpr std::size_t largest_chunk = std::size_t{2} << 20;  // before compression [bytes]

// Rounds to 17 significant bits (5 digits), by adding half of the last one that remains.
double rounded(double value) {
  if (!std::isfinite(value)) return value;
  constexpr int cleared = 36;  // number of bits, in a mantissa of 52
  const auto bits = std::bit_cast<std::uint64_t>(value) + (std::uint64_t{1} << (cleared - 1));
  return std::bit_cast<double>(bits >> cleared << cleared);
}

// Rounds the values, which are only displayed: most of their last bits are noise, which does not compress.
recording::Bytes rounded(const recording::Bytes& data) {
  auto robots = messages::decode<messages::SceneRobots>(data);
  for (messages::SceneRobot& robot : robots.robots)
    for (std::vector<double>* const values : {&robot.observation, &robot.command})
      std::ranges::transform(*values, values->begin(), [](double value) { return rounded(value); });
  return messages::encode(robots);
}

}  // namespace

PlayablePage::PlayablePage(const recording::Recording& recording, const recording::Replay& replay,
                           const PlayableOptions& options, HtmlFile& file)
    : recording_(recording),
      replay_(replay),
      options_(options),
      file_(file),
      publisher_(recording, replay, topics_),
      end_(std::min(options.to, end_of(recording))) {
  if (options.has_contacts) topics_.add_reader(Topic::contacts);
  if (!options.robots.empty()) topics_.add_reader(Topic::robots);
}

void PlayablePage::visit() {
  const recording::RecordedTick& recorded = replay_.recorded();
  if (recorded.begins || frame_count_ == 0) publisher_.begin_world();
  if (!is_due(recorded.log_time) && !recorded.begins) return;
  publisher_.show(recorded.log_time, recorded.state_hash.value_or(0), options_.robots);
  add_scene();
  add_frame(recorded.log_time);
}

// Frames are due at multiples of the frames' interval, and at the last boundary.
bool PlayablePage::is_due(Nanoseconds log_time) {
  if (frame_count_ == 0) return true;
  const double elapsed = std::chrono::duration<double>(log_time - options_.from).count();
  constexpr double slack = 1e-6;  // share of the interval, for the rounding of times
  const auto frames = static_cast<std::uint64_t>(std::max(0.0, elapsed * options_.frame_rate + slack));
  const bool is_next = frames > due_frames_;
  due_frames_ = frames;
  return is_next || log_time + replay_.experiment().world.step > end_;
}

void PlayablePage::add_scene() {
  const auto scene = topics_.newest(Topic::scene);
  if (scene->version == scene_version_) return;
  close_chunk();
  scene_version_ = scene->version;
  MessageBlock block;
  block.add(Topic::scene, scene->data);
  scene_ = file_.add(block.take_text());
}

void PlayablePage::add_frame(Nanoseconds log_time) {
  if (chunk_.times.size() == most_frames || block_.raw_size() > largest_chunk) close_chunk();
  const bool begins_chunk = block_.is_empty();
  add_newest(Topic::frame);
  const std::uint64_t signals = topics_.newest(Topic::signals)->version;
  if (begins_chunk || signals != signals_version_) add_newest(Topic::signals);
  signals_version_ = signals;
  if (options_.has_contacts) add_newest(Topic::contacts);
  if (!options_.robots.empty()) block_.add(Topic::robots, rounded(topics_.newest(Topic::robots)->data));
  chunk_.times.push_back(log_time.count());
  chunk_.ticks.push_back(replay_.recorded().tick);
  if (frame_count_++ == 0) first_ = log_time;
  last_ = log_time;
}

void PlayablePage::add_newest(Topic topic) { block_.add(topic, topics_.newest(topic)->data); }

void PlayablePage::close_chunk() {
  if (block_.is_empty()) return;
  chunk_.scene = scene_;
  chunk_.block = file_.add(block_.take_text());
  chunks_.push_back(std::move(chunk_));
  chunk_ = {};
}

void PlayablePage::finish() {
  close_chunk();
  std::string note = publish_events(recording_, topics_);
  if (note.empty()) note = recording_.damage();
  MessageBlock events;
  events.add(Topic::events, topics_.newest(Topic::events)->data);
  nlohmann::json table = {{"version", 1},
                          {"name", recording_.file().filename().string()},
                          {"seed", std::to_string(recording_.worlds().front().begins.seed)},
                          {"note", note},
                          {"events", file_.add(events.take_text())},
                          {"contacts", options_.has_contacts},
                          {"robots", options_.robots},
                          {"topics", nlohmann::json::array()},
                          {"chunks", nlohmann::json::array()}};
  for (const TopicInfo& topic : topic_table())
    table["topics"].push_back({{"name", topic.name}, {"schema", topic.schema}});
  for (const Chunk& chunk : chunks_)
    table["chunks"].push_back(
        {{"block", chunk.block}, {"scene", chunk.scene}, {"times", chunk.times}, {"ticks", chunk.ticks}});
  file_.add(packed_text(table.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
}

}  // namespace cohort::view
