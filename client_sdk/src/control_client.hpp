#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "idl/wire/control_messages.hpp"

namespace cohort {

struct ControlOptions {
  std::string server = "127.0.0.1";
  std::uint32_t domain = 0;
  std::string secure{};          ///< folder of an identity that may control (docs/security.md); empty: without security
  std::string label = "client";  ///< what the server calls this one; process and host are added
};

/// The server said no, or did not say what had to come. `result` is its word for programs.
class ControlError : public std::runtime_error {
 public:
  explicit ControlError(const std::string& text, wire::ResultCode code = wire::ResultCode::operation_failed)
      : std::runtime_error(text), result(code) {}
  wire::ResultCode result;
};

/// Controls a run of a server: docs/protocol.md, "Control", the client's side. Requests are asked again until their
/// reply comes; the server does each once. One thread uses it.
class ControlClient {
 public:
  /// Does not wait for the server. Throws wire::WireError if its address or the identity cannot be used.
  explicit ControlClient(const ControlOptions& options);
  ~ControlClient();

  /// Waits until a server is there; false if none is within `at_most`, or `stop` is set.
  bool wait_for_server(std::chrono::milliseconds at_most, const std::atomic<bool>& stop);

  /// Asks and waits for the reply, whatever its result is. Nothing if none comes within `at_most`, `stop` is set, or
  /// the server goes; what was asked for may happen all the same.
  std::optional<wire::Reply> ask(wire::Operation operation, std::chrono::milliseconds at_most,
                                 const std::atomic<bool>& stop);
  /// A server was there, and is there no more.
  bool server_is_gone() const;

  struct SavedSnapshot {
    std::vector<std::byte> bytes;
    std::string text;  ///< what the server says of it, for people
  };
  /// The snapshot of the run as it stands at the next boundary (SaveSnapshot, GetData). Throws ControlError; `at_most`
  /// counts for each of its parts.
  SavedSnapshot save(std::chrono::milliseconds at_most, const std::atomic<bool>& stop);
  /// Lets the run go on from a snapshot (PutData, LoadSnapshot). The reply of the run that does. Throws ControlError.
  wire::Reply load(std::span<const std::byte> snapshot, std::chrono::milliseconds at_most,
                   const std::atomic<bool>& stop);

  /// Begins a recording of the run at its next boundary (StartRecording). `recorded`: what it is to hold, in YAML as
  /// after an experiment's `record`; empty: what the experiment says. The server's sentence about it. Throws
  /// ControlError.
  std::string start_recording(const std::string& recorded, std::chrono::milliseconds at_most,
                              const std::atomic<bool>& stop);
  struct RecordingPart {
    std::vector<std::uint8_t> bytes;  ///< of the file; maybe none yet
    bool is_last = false;
    std::string problem;  ///< with the last: why the file holds less than was asked for
  };
  /// What there is of it from byte `offset` on, which says that all before is safe (GetRecording). Throws ControlError.
  RecordingPart get_recording(std::uint64_t offset, std::chrono::milliseconds at_most, const std::atomic<bool>& stop);
  /// Ends it where it is (StopRecording); the rest of the file is still to be fetched. Throws ControlError.
  void stop_recording(std::chrono::milliseconds at_most, const std::atomic<bool>& stop);

 private:
  struct State;
  wire::Reply expect(wire::Operation operation, std::chrono::milliseconds at_most, const std::atomic<bool>& stop);
  // The data that the operation returns, and the server's sentence about it.
  wire::DataPart fetch(wire::Operation operation, std::chrono::milliseconds at_most, const std::atomic<bool>& stop,
                       std::string& text);
  std::unique_ptr<State> state_;
};

}  // namespace cohort
