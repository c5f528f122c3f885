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

/// What a recording holds of one boundary.
struct RecordedTick {
  std::uint64_t tick = 0;
  std::chrono::nanoseconds log_time{0};
  std::optional<WorldBegins> begins{};         ///< a world begins with it
  std::optional<RecordedSnapshot> snapshot{};  ///< after the actions
  std::vector<ActionTaken> actions{};          ///< in their order
  std::optional<std::uint64_t> state_hash{};   ///< after the actions; none where the recording ends in the midst
  Commands commands{};                         ///< of the robots whose commands changed
};

/// The boundaries of a recording, in their order. One thread at a time.
class TickStream {
 public:
  TickStream(const McapReader& reader, const std::filesystem::path& file, Timestamp from);

  /// The next one; none at the end. Throws McapError for what cannot be read, or is not what a recorder writes.
  std::optional<RecordedTick> next();

 private:
  const McapReader* reader_;
  std::filesystem::path file_;
  MessageStream messages_;
  std::optional<RecordedTick> waiting_;
};

/// A recording of Cohort's. Any thread, but for its streams.
class Recording {
 public:
  /// Throws FileError if the file cannot be opened, McapError if it is no recording of Cohort's.
  explicit Recording(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  const McapReader& reader() const { return reader_; }
  /// A sentence, if not everything can be read.
  const std::string& damage() const { return reader_.damage(); }
  /// Of `facts_of`.
  const StringMap& facts() const { return facts_; }
  /// How the run ended, in a word; empty if the file does not know.
  std::string end() const;

  /// A world that begins.
  struct World {
    WorldBegins begins;
    std::chrono::nanoseconds log_time{0};
  };
  /// In their order, at least one.
  const std::vector<World>& worlds() const { return worlds_; }
  /// The experiment of a world, read from what the recording keeps. Throws McapError, or InputError if another version
  /// of Cohort takes it for wrong.
  description::Experiment experiment(const World& world) const;

  /// Log times of the snapshots, ascending.
  const std::vector<std::chrono::nanoseconds>& snapshots() const { return snapshots_; }

  /// From the first boundary on whose log time is not before this.
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
