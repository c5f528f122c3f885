// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/recording/mcap/writing/spool.hpp"
#include "server/recording/recorder.hpp"
#include "server/run/run.hpp"
#include "server/serving/control/requests/kept_for_client.hpp"

namespace cohort::session {

/// Recordings that clients make of a run in progress. Each has a thread that produces the bytes of its file, which the
/// client fetches in parts. Data that is not fetched in time is bounded in memory, and exceeding the bound ends that
/// recording only. For the thread of the run.
class LiveRecordings {
 public:
  /// Starts a world: active recordings continue with it. Both arguments must outlive their recording.
  void begin(const description::Experiment& experiment, const Simulation& simulation, bool is_restored);
  /// Returns a listener that passes all events to `listener` and to the recordings.
  RunListener listening(RunListener listener) const;
  /// Ends all recordings, as the run has ended and no world follows. The world may be destroyed afterwards.
  void end(RunResult::End how, const std::string& reason);

  /// Starts a recording at this boundary, which has not been reported to any listener yet. `recorded`: the content to
  /// record, in YAML (parsing::read_recorded); if empty, that of the experiment. Throws RequestRefusal.
  void start(std::uint64_t client, const std::string& recorded);
  /// Ends the client's recording here, at its request.
  void stop(std::uint64_t client);
  /// Handles the departure of the client.
  void leave(std::uint64_t client);

  /// Adds the memory that is kept for clients: unfetched bytes, and messages that wait to be written.
  void list(std::vector<KeptForClient>& kept) const;
  /// Ends the client's recording and forgets it; the client learns the reason when it fetches the next part.
  void drop(std::uint64_t client, const std::string& why);

  struct Part {
    recording::Spool::Part bytes;
    std::string problem;  ///< why the recording is incomplete, with the last part
  };
  /// Returns the part from `offset` on; nothing if the client has no recording, or none from there on. Throws
  /// std::runtime_error if it was dropped.
  std::optional<Part> fetch(std::uint64_t client, std::uint64_t offset);
  /// Returns true if all recordings that have ended were fetched.
  bool are_fetched() const;
  /// Returns the number of bytes that were fetched since the start.
  std::uint64_t fetched() const { return fetched_; }

 private:
  struct One {
    One(std::uint64_t client, const description::Experiment& experiment, description::Recorded recorded);
    One(const One&) = delete;
    One& operator=(const One&) = delete;
    ~One() { spool->abandon(); }  // the thread may be waiting for room
    std::uint64_t client;
    KeptForClient::Time since = std::chrono::steady_clock::now().time_since_epoch();
    std::shared_ptr<recording::Spool> spool;
    recording::Recorder recorder;
    bool has_ended = false;
  };
  One* find(std::uint64_t client);
  void end(One& one, const std::string& word, const std::string& reason);
  void forget(std::uint64_t client, const std::string& why);
  void forget_the_gone();

  const description::Experiment* experiment_ = nullptr;
  const Simulation* simulation_ = nullptr;
  std::list<One> ones_;
  std::list<One> gone_;                           // the threads are about to end
  std::map<std::uint64_t, std::string> dropped_;  // reason, by client
  std::vector<recording::Recorder*> telling_;     // active recordings
  std::uint64_t fetched_ = 0;
};

}  // namespace cohort::session
