// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace cohort::session {

/// The clients that hold the time of a run: the run advances past a tick only when each of them has requested a later
/// tick. Requests and grants are as in the High Level Architecture (IEEE 1516). Pure logic. Not thread-safe.
class TimeHolders {
 public:
  /// Adds a client, which holds the run at its current tick.
  void add(std::uint64_t client) { holders_.try_emplace(client); }
  /// Removes a client. Returns true if it held the time.
  bool remove(std::uint64_t client) { return holders_.erase(client) > 0; }
  bool has(std::uint64_t client) const { return holders_.contains(client); }

  /// Starts another run: each client is granted the first tick that it reaches.
  void begin_run() {
    for (auto& [client, holder] : holders_) holder.granted.reset();
  }

  /// Requests the tick that is `steps` after the client's last grant. `number`: number of the request.
  void ask(std::uint64_t client, std::uint64_t number, std::uint64_t steps) {
    Holder& holder = holders_.at(client);
    holder.request = number;
    holder.steps = steps;
  }

  struct Grant {
    std::uint64_t client = 0;
    std::uint64_t number = 0;
  };
  /// Returns the requests that are granted once the frames of `tick` are sent.
  std::vector<Grant> take_grants(std::uint64_t tick) {
    std::vector<Grant> grants;
    for (auto& [client, holder] : holders_) {
      if (!holder.request || holder.wants_later(tick)) continue;
      grants.push_back({client, *holder.request});
      holder.request.reset();
      holder.granted = tick;
    }
    return grants;
  }

  /// Returns a client that holds the run at `tick`, if there is one.
  std::optional<std::uint64_t> awaited(std::uint64_t tick) const {
    for (const auto& [client, holder] : holders_)
      if (!holder.request || !holder.wants_later(tick)) return client;
    return std::nullopt;
  }

  /// Removes and returns all requests that were not granted.
  std::vector<Grant> take_requests() {
    std::vector<Grant> requests;
    for (auto& [client, holder] : holders_) {
      if (holder.request) requests.push_back({client, *holder.request});
      holder.request.reset();
    }
    return requests;
  }

 private:
  struct Holder {
    std::optional<std::uint64_t> granted{};  // tick; none yet in this run
    std::optional<std::uint64_t> request{};  // number of the pending request
    std::uint64_t steps = 0;

    bool wants_later(std::uint64_t tick) const { return granted && *granted + steps > tick; }
  };
  std::map<std::uint64_t, Holder> holders_;  // by client
};

}  // namespace cohort::session
