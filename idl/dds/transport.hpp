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

/// Writes messages of one type. Not copyable. `write` may be called from any one thread at a time, and never from
/// inside a reader's callback unless the message's quality of service is KEEP_LAST (all of ours are).
template <class Message>
class Writer {
 public:
  /// `partition`: empty for the default one. `depth`: frames kept for readers that are behind (KEEP_LAST); for
  /// Observation and Command, the depth of the other messages is fixed. Throws WireError.
  explicit Writer(Participant& participant, const std::string& partition = "", int depth = 1);
  Writer(Writer&&) noexcept;
  Writer& operator=(Writer&&) noexcept;
  ~Writer();

  /// False if DDS could not take the message in time (100 ms): the message counts as lost. Throws WireError otherwise.
  bool write(const Message& message);
  /// Waits until every matched reader has all that was written; false if that took too long.
  bool wait_until_received(std::chrono::milliseconds at_most);
  /// Readers matched now.
  std::uint32_t matched() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What came with a message.
struct Sender {
  std::uint64_t writer = 0;       ///< identifies the DDS writer within this process
  std::uint64_t participant = 0;  ///< identifies its participant likewise: DDS says it, the sender cannot choose it
};

/// Reads messages of one type. All callbacks run on a thread of DDS, one at a time for each reader and perhaps before
/// the constructor returns: they must not throw, block for long, or create or destroy entities. Set at construction, so
/// nothing is missed; the destructor waits until none runs, so it must not be called with a lock that a callback takes.
template <class Message>
class Reader {
 public:
  struct Callbacks {
    std::function<void(const Message&, const Sender&)> message;
    /// A writer of this topic appeared, or was found dead (lease over, unmatched) or alive again; may repeat. May be
    /// empty.
    std::function<void(const Sender&, bool alive)> liveliness;
  };
  Reader(Participant& participant, Callbacks callbacks, const std::string& partition = "", int depth = 1);
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;
  ~Reader();

  /// Writers matched now.
  std::uint32_t matched() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

extern template class Writer<Join>;
extern template class Writer<Admit>;
extern template class Writer<RobotDescription>;
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
