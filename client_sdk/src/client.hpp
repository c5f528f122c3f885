#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client_sdk/hosting/controller_host.hpp"

namespace cohort {

enum class Severity { info, warning, error };

/// For a controller that blocks in `step` until something else than the run lets it go on: whether anybody still wants
/// its answer. Any thread.
class RunWatch {
 public:
  /// The server has ended the run or the lease, or has been away for too long: the controller throws LeaveRun, and
  /// `run_client` returns what has happened.
  bool is_over() const;

  /// By the client.
  void note_end();
  void note_server(bool there);

 private:
  mutable std::mutex mutex_;
  bool ended_ = false;
  std::optional<std::chrono::steady_clock::time_point> away_since_;
};

struct ClientOptions {
  std::string server = "127.0.0.1";
  std::uint32_t domain = 0;
  std::vector<std::string> robots{"all"};  ///< selectors, see docs/protocol.md
  std::string name;                        ///< shown by the server; the controller's if empty
  std::string secure{};                    ///< folder of an identity (docs/security.md); empty: without security
  /// Runs `step` on the thread of DDS that brings the frame: no hand-over to the calling thread, so less CPU and
  /// latency. `step` then runs on either thread, on one at a time. DDS stands still meanwhile: after eight frames in a
  /// row that take more than a millisecond, all further ones are the calling thread's.
  bool inline_step = false;
  /// Whether a controller that fails in `start` ends the run, as one does that fails later; else the server refuses
  /// this client, and the run goes on.
  bool start_must_succeed = false;
  /// Told when the run is over; outlives the client.
  RunWatch* watch = nullptr;
  /// Receives what people should know, one text at a time, on any thread of the client. If empty it goes to standard
  /// error, after the name.
  std::function<void(Severity severity, const std::string& text)> tell{};
};

/// Selectors of robots that stand in one text with commas between.
std::vector<std::string> split_selectors(std::string_view list);

enum class ClientEnd {
  finished,     ///< the server ended the run
  refused,      ///< the claim was refused
  superseded,   ///< another process took these robots over
  failed,       ///< a controller threw, or the server rejected an answer for good
  server_lost,  ///< the server died or left
  interrupted,  ///< `stop` was set, or a controller threw LeaveRun
};

/// Attaches to a server, drives robots until the run ends, and says why it ended; tells what anything but `finished` is
/// about. Waits for a server that is not there yet. Blocks; controllers run on the calling thread, unless
/// `inline_step`. `stop` may be set from a signal handler. Throws wire::WireError if the server's address or the
/// identity cannot be used.
ClientEnd run_client(const ControllerKind& kind, const ClientOptions& options, const std::atomic<bool>& stop);

inline ClientEnd run_client(const Plugin& plugin, const ClientOptions& options, const std::atomic<bool>& stop) {
  return run_client(kind_of(plugin), options, stop);
}

}  // namespace cohort
