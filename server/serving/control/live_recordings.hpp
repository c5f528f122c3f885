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

/// Recordings of a run that clients make while it goes on. A thread for each makes the bytes of its file, which the
/// client fetches part by part; what nobody fetches in time is bounded in memory and ends that recording only. On the
/// thread of the run.
class LiveRecordings {
 public:
  /// A world begins: recordings that are under way go on with it. Both must outlive what is recorded of them.
  void begin(const description::Experiment& experiment, const Simulation& simulation, bool is_restored);
  /// What they are to be told of, besides `listener`.
  RunListener listening(RunListener listener) const;
  /// The run has ended, and no world follows: so do they, and the world may go.
  void end(RunResult::End how, const std::string& reason);

  /// One begins at this boundary, of which no one has been told yet. `recorded`: what it is to hold, in YAML
  /// (parsing::read_recorded); empty: what the experiment says. Throws std::runtime_error.
  void start(std::uint64_t client, const std::string& recorded);
  /// The client wants no more than there is up to now.
  void stop(std::uint64_t client);
  /// The client is gone.
  void leave(std::uint64_t client);

  /// Adds what is kept for clients: bytes that are not fetched, and what waits to become some.
  void list(std::vector<KeptForClient>& kept) const;
  /// Ends the client's recording and forgets it; the client is told why when it fetches the next part.
  void drop(std::uint64_t client, const std::string& why);

  struct Part {
    recording::Spool::Part bytes;
    std::string problem;  ///< why it is less than was asked for, with the last part
  };
  /// From `offset` on; nothing if the client has no recording, or none from there on. Throws std::runtime_error if it
  /// was dropped.
  std::optional<Part> fetch(std::uint64_t client, std::uint64_t offset);
  /// Whether every recording that has ended is with its client.
  bool are_fetched() const;
  /// Bytes that were fetched since the beginning.
  std::uint64_t fetched() const { return fetched_; }

 private:
  struct One {
    One(std::uint64_t client, const description::Experiment& experiment, description::Recorded recorded);
    One(const One&) = delete;
    One& operator=(const One&) = delete;
    ~One() { spool->abandon(); }  // its thread may wait for room
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
  std::list<One> gone_;                           // whose threads are about to end
  std::map<std::uint64_t, std::string> dropped_;  // why, by client
  std::vector<recording::Recorder*> telling_;     // those that have not ended
  std::uint64_t fetched_ = 0;
};

}  // namespace cohort::session
