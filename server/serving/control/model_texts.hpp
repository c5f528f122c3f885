#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "server/description/parsed_model.hpp"

namespace cohort::session {

/// Reads the texts of models that requests bring, one at a time on a thread of its own: neither ticks nor other
/// requests wait for it. It keeps few models, and takes no more texts while requests have not fetched theirs. All
/// functions are for the thread of the run.
class ModelTexts {
 public:
  /// The client and the number of a request.
  using Key = std::pair<std::uint64_t, std::uint64_t>;
  /// What came of a text.
  struct Reading {
    description::ParsedModelPtr model;  ///< null if there is none
    std::string why_not{};              ///< in that case
    std::chrono::nanoseconds took{0};
  };

  /// `on_read` is called on the other thread, whenever a text has been read.
  explicit ModelTexts(std::function<void()> on_read);
  /// Waits for the text that is being read.
  ~ModelTexts();

  /// A run begins, whose experiment reads texts so; null: not at all. Nothing is left of another run.
  void begin(description::ModelReader read_model);
  /// Whether the next text may be taken.
  bool is_free();
  /// Takes the text of a request, where `is_free`. Returns false if it was read before: then its reading is there.
  bool take(const Key& key, const std::string& text);
  /// Notes what has been read since, and returns whose text that was.
  std::optional<Key> collect();
  /// Null as long as the text is not read.
  const Reading* find(const Key& key) const;
  void forget(const Key& key) { readings_.erase(key); }

 private:
  static constexpr std::size_t most_readings = 16;  // that nobody has fetched, and as many of the last texts

  struct Job {
    std::uint64_t run = 0;
    Key key;
    std::string text;
    description::ModelReader read_model;
    std::optional<Reading> reading{};
  };
  void read_texts();
  static Reading read(const Job& job);
  void keep(const Key& key, const Reading& reading);

  std::uint64_t run_ = 0;
  description::ModelReader read_model_;
  std::map<Key, Reading> readings_;
  std::deque<description::ParsedModelPtr> last_;  // the newest first

  std::function<void()> on_read_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<Job> job_;  // under the lock, like the next
  bool ends_ = false;
  std::thread thread_;  // last
};

}  // namespace cohort::session
