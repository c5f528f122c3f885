// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/recording/mcap/format/mcap.hpp"

namespace cohort::view {

enum class Topic : std::uint8_t { scene, frame, signals, contacts, status, robots, events, transforms, markers };
inline constexpr std::size_t topic_count = 9;

/// A topic as it is advertised to clients. Its number is its index in `topic_table()`.
struct TopicInfo {
  std::string name;
  std::string schema_name;
  std::string schema;
};
const std::array<TopicInfo, topic_count>& topic_table();

/// A published message, which is never changed.
struct Published {
  std::uint64_t version = 0;  ///< version of its topic, counted from 1
  std::chrono::nanoseconds time{0};
  recording::Bytes data;  ///< CDR
};

/// The latest message of each topic, for exchange between the source and the clients. A new message replaces the
/// previous one, so memory does not grow without readers. Thread-safe.
class Topics {
 public:
  /// `published` is called on the publisher's thread after each message.
  explicit Topics(std::function<void()> published = {}) : published_(std::move(published)) {}

  void publish(Topic topic, std::chrono::nanoseconds time, recording::Bytes data);
  /// Returns the latest message; nullptr if there is none yet.
  std::shared_ptr<const Published> newest(Topic topic) const;

  /// Adds or removes a reader of a topic.
  void add_reader(Topic topic);
  void remove_reader(Topic topic);
  bool is_read(Topic topic) const { return readers_[index_of(topic)] > 0; }
  /// Returns whether any topic has a reader.
  bool is_read() const {
    return std::ranges::any_of(readers_, [](int readers) { return readers > 0; });
  }
  /// Returns how often a topic has got a reader.
  std::uint64_t arrivals() const { return arrivals_; }

 private:
  static std::size_t index_of(Topic topic) { return static_cast<std::size_t>(topic); }

  std::function<void()> published_;
  mutable std::mutex mutex_;
  std::array<std::shared_ptr<const Published>, topic_count> newest_;
  std::array<std::atomic<int>, topic_count> readers_{};
  std::atomic<std::uint64_t> arrivals_{0};
};

}  // namespace cohort::view
