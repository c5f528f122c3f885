// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client_sdk/hosting/state_parts.hpp"
#include "idl/dds/transport.hpp"
#include "idl/wire/messages.hpp"
#include "server/serving/control/requests/received_request.hpp"

namespace cohort::session {

/// Messages that the threads of DDS leave for the thread of the run. Its size is bounded: messages beyond the limits
/// are counted as rejected and dropped. Texts from clients enter here, and are made printable. Pure logic. Not
/// thread-safe: use it under the server's lock.
class Inbox {
 public:
  static constexpr std::size_t most_arrivals = 4096;
  static constexpr std::size_t most_arrival_bytes = std::size_t{16} << 20;
  static constexpr std::size_t largest_join = std::size_t{128} << 10;
  static constexpr std::size_t most_reports = 4096;
  static constexpr std::size_t most_report_bytes = std::size_t{16} << 20;
  static constexpr std::size_t largest_report = std::size_t{64} << 10;
  static constexpr std::size_t most_foreign_versions = 100;
  // Limits of requests between two readings of the inbox. Each participant may have wire::requests_under_way.
  static constexpr std::size_t most_requests = 1024;
  static constexpr std::size_t most_request_bytes = std::size_t{64} << 20;
  static constexpr std::size_t largest_request = std::size_t{4} << 20;

  // Limits of human-readable texts [bytes].
  static constexpr std::size_t longest_label = 100;
  static constexpr std::size_t longest_text = 4096;

  static constexpr std::size_t most_state_bytes = std::size_t{64} << 20;

  struct Arrival {
    wire::Join join;
    wire::Sender sender;
    wire::Participant* participant = nullptr;  ///< the server's participant that received it
  };
  struct Liveliness {
    wire::Sender sender;
    bool alive = false;
  };
  struct Rejections {
    std::string text;                     ///< text of the first one
    std::optional<std::uint64_t> tick{};  ///< tick of the frame that the first one answers, if it is an answer
    std::uint64_t count = 0;
  };
  /// By client or participant, and by reason.
  using Rejected = std::map<std::pair<std::uint64_t, std::string>, Rejections>;
  /// By client and kind: the last of each, as both sides repeat their messages.
  using States = std::map<std::pair<std::uint64_t, wire::StateKind>, KeptStateMessage>;
  /// Each list is in the order of arrival.
  struct Contents {
    std::vector<Arrival> arrivals{};
    std::vector<Liveliness> liveliness{};
    std::vector<wire::Report> reports{};
    std::vector<std::uint32_t> ended_processes{};
    std::vector<ReceivedRequest> requests{};
    std::vector<wire::Sender> gone_requesters{};
    States states{};
    std::string failure{};                       ///< the first error of another component
    std::set<std::uint32_t> foreign_versions{};  ///< other major versions of the protocol
    Rejected rejected{};
  };

  // These functions return true if the thread of the run has to read the inbox. `participant`: the server's participant
  // that received the message.
  bool add_arrival(const wire::Join& join, const wire::Sender& sender, wire::Participant* participant);
  bool add_liveliness(const wire::Sender& sender, bool alive);
  bool add_report(const wire::Report& report, const wire::Sender& sender);
  bool add_ended_process(std::uint32_t process);
  bool add_request(const wire::Request& request, const wire::Sender& sender, wire::Participant* participant);
  bool add_state(const wire::ControllerState& message, const wire::Sender& sender);
  bool add_gone_requester(const wire::Sender& sender);
  bool add_failure(const std::string& error);
  bool add_foreign_version(std::uint32_t major);
  /// Notes news that is stored elsewhere, so that `has_news` returns true.
  bool note_news() { return has_news_ = true; }
  /// Counts a rejected message, for the next reading of the inbox: a flood must not wake the thread of the run for each
  /// message. `tick`: tick of the frame, if the message is an answer.
  void reject(std::uint64_t who, const char* reason, std::string_view text, std::optional<std::uint64_t> tick = {});

  /// Returns true if anything but rejections was added since `take`.
  bool has_news() const { return has_news_; }
  /// Removes and returns everything.
  Contents take();
  bool has_liveliness() const { return !contents_.liveliness.empty(); }
  /// Removes and returns only the liveliness changes.
  std::vector<Liveliness> take_liveliness() { return std::exchange(contents_.liveliness, {}); }

 private:
  Contents contents_;
  std::map<std::uint64_t, std::size_t> requests_of_;  // by participant
  std::size_t arrival_bytes_ = 0;
  std::size_t report_bytes_ = 0;
  std::size_t request_bytes_ = 0;
  std::size_t state_bytes_ = 0;
  bool has_news_ = false;
};

}  // namespace cohort::session
