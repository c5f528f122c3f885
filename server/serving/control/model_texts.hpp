// SPDX-License-Identifier: Apache-2.0
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

#include "idl/wire/control_messages.hpp"
#include "server/description/parsed_model.hpp"

namespace cohort::session {

/// Reads the model texts of requests, one at a time on a thread of its own, so that neither ticks nor other requests
/// wait. It keeps only a few models, and takes no more texts while too many results have not been fetched. All
/// functions are for the thread of the run.
class ModelTexts {
 public:
  /// The client and the number of a request.
  using Key = std::pair<std::uint64_t, std::uint64_t>;
  /// The result of reading a text.
  struct Reading {
    description::ParsedModelPtr model;  ///< null on failure
    wire::ResultCode result = wire::ResultCode::ok;
    std::string why_not{};  ///< the reason of the failure
    std::chrono::nanoseconds took{0};
  };

  /// `on_read` is called on the other thread after each text.
  explicit ModelTexts(std::function<void()> on_read);
  /// Waits until the current text is read.
  ~ModelTexts();

  /// Starts a run and forgets everything of the previous one. `read_model`: reads texts for the experiment; null: texts
  /// are not accepted.
  void begin(description::ModelReader read_model);
  /// Returns true if the next text may be taken.
  bool is_free();
  /// Takes the text of a request, if `is_free`. Returns false if it was read before: then its result is available.
  bool take(const Key& key, const std::string& text);
  /// Stores a finished result and returns the key of its text.
  std::optional<Key> collect();
  /// Returns null until the text is read.
  const Reading* find(const Key& key) const;
  void forget(const Key& key) { readings_.erase(key); }

 private:
  static constexpr std::size_t most_readings = 16;  // limit of unfetched results, and of kept models

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
  std::deque<description::ParsedModelPtr> last_;  // newest first

  std::function<void()> on_read_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<Job> job_;  // guarded by the lock, like the next member
  bool ends_ = false;
  std::thread thread_;  // last, so that it is destroyed first
};

}  // namespace cohort::session
