// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/description/experiment.hpp"
#include "server/recording/facts.hpp"
#include "server/recording/run_messages.hpp"

namespace cohort::recording {

/// The recorded data of one boundary.
struct RecordedTick {
  std::uint64_t tick = 0;
  std::chrono::nanoseconds log_time{0};
  std::optional<WorldBegins> begins{};         ///< a world that begins here
  std::optional<RecordedSnapshot> snapshot{};  ///< after the actions
  std::vector<ActionTaken> actions{};          ///< in the order in which they were taken
  std::optional<std::uint64_t> state_hash{};   ///< after the actions; missing if the recording ends within the tick
  Commands commands{};                         ///< for the robots whose commands changed
};

/// The boundaries of a recording, in order. For one thread at a time.
class TickStream {
 public:
  TickStream(const McapReader& reader, const std::filesystem::path& file, Timestamp from);

  /// Returns the next boundary, or nothing at the end. Throws McapError for data that cannot be read, or that a
  /// recorder does not write.
  std::optional<RecordedTick> next();

 private:
  const McapReader* reader_;
  std::filesystem::path file_;
  MessageStream messages_;
  std::optional<RecordedTick> waiting_;
};

/// A recording made by Cohort. For any thread, except for its streams.
class Recording {
 public:
  /// Throws FileError if the file cannot be opened, and McapError if it is not a recording of Cohort.
  explicit Recording(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  const McapReader& reader() const { return reader_; }
  /// Returns a sentence about the parts that cannot be read; empty if there are none.
  const std::string& damage() const { return reader_.damage(); }
  /// Returns the facts that `facts_of` wrote.
  const StringMap& facts() const { return facts_; }
  /// Returns how the run ended, as a keyword such as `finished`; empty if unknown.
  std::string end() const;

  /// The start of a world.
  struct World {
    WorldBegins begins;
    std::chrono::nanoseconds log_time{0};
  };
  /// Returns the worlds in order; there is at least one.
  const std::vector<World>& worlds() const { return worlds_; }
  /// Returns the experiment of a world, read from the input files in the recording. Throws McapError, or InputError if
  /// another version of Cohort rejects it.
  description::Experiment experiment(const World& world) const;

  /// Returns the log times of the snapshots, ascending.
  const std::vector<std::chrono::nanoseconds>& snapshots() const { return snapshots_; }

  /// Returns the boundaries from the first whose log time is not before `from`.
  TickStream ticks(std::chrono::nanoseconds from = std::chrono::nanoseconds(0)) const;

 private:
  std::filesystem::path file_;
  McapReader reader_;
  StringMap facts_;
  std::shared_ptr<const description::KeptFiles> inputs_;
  std::vector<World> worlds_;
  std::vector<std::chrono::nanoseconds> snapshots_;
};

}  // namespace cohort::recording
