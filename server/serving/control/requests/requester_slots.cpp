// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/requests/requester_slots.hpp"

#include <algorithm>
#include <utility>

namespace cohort::session {

template <class Condition>
std::size_t RequesterSlots::count(const Condition& condition) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(holders_, [&](const auto& each) { return condition(each.second); }));
}

template <class Condition>
RequesterSlots::Admission RequesterSlots::replace_idle(std::uint64_t client, const Holder& holder,
                                                       const Condition& may_go) {
  auto oldest = holders_.end();
  for (auto each = holders_.begin(); each != holders_.end(); ++each)
    if (may_go(each->second) && (oldest == holders_.end() || each->second.used < oldest->second.used)) oldest = each;
  if (oldest == holders_.end() || holder.used - oldest->second.used < idle_after) return {};
  const std::uint64_t leaves = oldest->first;
  holders_.erase(oldest);
  holders_[client] = holder;
  return {true, leaves};
}

RequesterSlots::Admission RequesterSlots::use(std::uint64_t client, const std::string& identity, bool may_control,
                                              Time now) {
  if (const auto known = holders_.find(client); known != holders_.end()) {
    known->second.used = now;
    return {true};
  }
  const Holder holder{identity, may_control, now};
  const auto is_of_identity = [&](const Holder& other) { return other.identity == identity; };
  const auto is_of_role = [&](const Holder& other) { return other.may_control == may_control; };
  if (!identity.empty()) {
    if (count(is_of_identity) >= most_of_identity) return replace_idle(client, holder, is_of_identity);
    if (count(is_of_role) >= most - kept_for_role) return replace_idle(client, holder, is_of_role);
  }
  if (holders_.size() >= most) return replace_idle(client, holder, [](const Holder&) { return true; });
  holders_[client] = holder;
  return {true};
}

}  // namespace cohort::session
