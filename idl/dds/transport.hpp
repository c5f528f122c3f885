// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "idl/dds/participant.hpp"
#include "idl/wire/control_messages.hpp"
#include "idl/wire/messages.hpp"

namespace cohort::wire {

/// Writes messages of one type. Not copyable. Call `write` from any thread, one at a time. Do not call it inside a
/// reader's callback unless the quality of service of the message is KEEP_LAST (all of ours are).
template <class Message>
class Writer {
 public:
  /// `partition` is empty for the default one. `depth` is the number of frames kept for slow readers (KEEP_LAST), for
  /// Observation and Command; the depth of other messages is fixed. Throws WireError.
  explicit Writer(Participant& participant, const std::string& partition = "", int depth = 1);
  Writer(Writer&&) noexcept;
  Writer& operator=(Writer&&) noexcept;
  ~Writer();

  /// Writes a message. Returns false if DDS did not accept it in time (100 ms): the message counts as lost. Throws
  /// WireError for other errors.
  bool write(const Message& message);
  /// Waits until every matched reader has received everything. Returns false if this takes longer than `at_most`.
  bool wait_until_received(std::chrono::milliseconds at_most);
  /// Returns the number of matched readers.
  std::uint32_t matched() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The origin of a message.
struct Sender {
  std::uint64_t writer = 0;  ///< identifies the DDS writer within this process
  std::uint64_t participant =
      0;  ///< identifies the participant of the writer, likewise; set by DDS, so that the sender cannot forge it
};

/// Reads messages of one type. All callbacks run on a DDS thread, one at a time for each reader, and possibly before
/// the constructor returns. They must not throw, block for long, or create or destroy DDS entities. They are set at
/// construction, so nothing is missed. The destructor waits until no callback is running, so do not call it while
/// holding a mutex that a callback locks.
template <class Message>
class Reader {
 public:
  struct Callbacks {
    std::function<void(const Message&, const Sender&)> message;
    /// Called when a writer of this topic appeared, was lost (lease over, unmatched) or returned; may repeat. May be
    /// empty.
    std::function<void(const Sender&, bool alive)> liveliness;
  };
  Reader(Participant& participant, Callbacks callbacks, const std::string& partition = "", int depth = 1);
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;
  ~Reader();

  /// Returns the number of matched writers.
  std::uint32_t matched() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

extern template class Writer<Join>;
extern template class Writer<Admit>;
extern template class Writer<RobotDescription>;
extern template class Writer<RobotTree>;
extern template class Writer<Observation>;
extern template class Writer<Command>;
extern template class Writer<WorldState>;
extern template class Writer<SceneDescription>;
extern template class Writer<SceneUpdate>;
extern template class Writer<Report>;
extern template class Writer<ControllerState>;
extern template class Writer<Request>;
extern template class Writer<Reply>;
extern template class Reader<Join>;
extern template class Reader<Admit>;
extern template class Reader<RobotDescription>;
extern template class Reader<RobotTree>;
extern template class Reader<Observation>;
extern template class Reader<Command>;
extern template class Reader<WorldState>;
extern template class Reader<SceneDescription>;
extern template class Reader<SceneUpdate>;
extern template class Reader<Report>;
extern template class Reader<ControllerState>;
extern template class Reader<Request>;
extern template class Reader<Reply>;

}  // namespace cohort::wire
