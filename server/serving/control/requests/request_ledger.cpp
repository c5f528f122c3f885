// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/requests/request_ledger.hpp"

#include <algorithm>

namespace cohort::session {

bool RequestLedger::is_in_own_name(std::uint64_t client, std::uint64_t who) {
  const auto its_id = client_of_.find(who);
  if (its_id != client_of_.end() && its_id->second != client) return false;
  const auto known = clients_.find(client);
  if (known != clients_.end() && known->second.who != who) return false;
  if (known != clients_.end()) {
    known->second.used = ++uses_;
    return true;
  }
  if (clients_.size() == most_clients) {
    const auto oldest = std::min_element(clients_.begin(), clients_.end(),
                                         [](const auto& a, const auto& b) { return a.second.used < b.second.used; });
    leave(oldest->first);
    client_of_.erase(oldest->second.who);
    clients_.erase(oldest);
  }
  clients_[client] = {.who = who, .used = ++uses_};
  client_of_[who] = client;
  return true;
}

RequestLedger::Receipt RequestLedger::receive(std::uint64_t client, std::uint64_t number) {
  Client& known = clients_[client];
  if (const auto reply = known.replies.find(number); reply != known.replies.end())
    return reply->second ? Receipt::answered : Receipt::under_way;
  if (known.newest >= wire::requests_under_way && number <= known.newest - wire::requests_under_way)
    return Receipt::forgotten;
  const auto under_way =
      std::count_if(known.replies.begin(), known.replies.end(), [](const auto& each) { return !each.second; });
  if (static_cast<std::uint64_t>(under_way) >= wire::requests_under_way) return Receipt::too_many;
  known.newest = std::max(known.newest, number);
  known.replies.emplace(number, std::nullopt);
  // A client may repeat its last requests and those that are in progress, so their replies stay.
  std::erase_if(known.replies, [&](const auto& each) {
    return each.second && each.first <= known.newest - std::min(known.newest, wire::requests_under_way);
  });
  return Receipt::fresh;
}

const wire::Reply& RequestLedger::remembered(std::uint64_t client, std::uint64_t number) const {
  return *clients_.at(client).replies.at(number);
}

void RequestLedger::keep(const wire::Reply& reply) {
  const auto client = clients_.find(reply.client);
  if (client == clients_.end()) return;  // dropped for other clients meanwhile
  const auto place = client->second.replies.find(reply.number);
  if (place != client->second.replies.end()) place->second = reply;
}

void RequestLedger::offer(std::uint64_t client, std::shared_ptr<const std::vector<std::byte>> data,
                          KeptForClient::Time now) {
  dropped_.erase({client, KeptForClient::Kind::saved_snapshot});
  outgoing_[client] = {now, std::move(data)};
}

std::optional<RequestLedger::Part> RequestLedger::part(std::uint64_t client, std::uint64_t offset) const {
  const auto holder = outgoing_.find(client);
  if (holder == outgoing_.end()) return std::nullopt;
  const std::vector<std::byte>& data = *holder->second.bytes;
  const std::uint64_t begin = std::min<std::uint64_t>(offset, data.size());
  const std::uint64_t count = std::min<std::uint64_t>(data.size() - begin, wire::largest_part);
  return Part{data.size(), std::span(data).subspan(begin, count)};
}

std::optional<std::string> RequestLedger::take_part(std::uint64_t client, std::uint64_t size, std::uint64_t offset,
                                                    std::span<const std::uint8_t> bytes, KeptForClient::Time now) {
  if (size > wire::largest_data)
    return "the data has " + std::to_string(size) + " bytes; the maximum is " + std::to_string(wire::largest_data);
  if (bytes.size() > wire::largest_part)
    return "a part has " + std::to_string(bytes.size()) + " bytes; the maximum is " +
           std::to_string(wire::largest_part);
  if (offset > size || bytes.size() > size - offset)
    return "the part at offset " + std::to_string(offset) + " exceeds the data's size of " + std::to_string(size) +
           " bytes";
  if (offset == 0) {
    dropped_.erase({client, KeptForClient::Kind::upload});
    incoming_[client] = {.since = now, .size = size};
  }
  const auto holder = incoming_.find(client);
  if (const std::string why = why_dropped(client, KeptForClient::Kind::upload); !why.empty()) return why;
  if (holder == incoming_.end() || holder->second.size != size)
    return "the part at offset " + std::to_string(offset) +
           " belongs to no upload in progress: the first part must have offset 0";
  std::vector<std::byte>& data = holder->second.bytes;
  if (offset + bytes.size() <= data.size()) return std::nullopt;  // a repeated part
  if (offset != data.size())
    return "the part at offset " + std::to_string(offset) + " is out of order, expected offset " +
           std::to_string(data.size());
  const auto added = std::as_bytes(bytes);
  if (data.capacity() < data.size() + added.size())
    data.reserve(std::min<std::size_t>(size, 2 * (data.size() + added.size())));  // never more than its size
  data.insert(data.end(), added.begin(), added.end());
  return std::nullopt;
}

std::optional<std::vector<std::byte>> RequestLedger::take_all(std::uint64_t client) {
  const auto holder = incoming_.find(client);
  if (holder == incoming_.end() || holder->second.bytes.size() != holder->second.size) return std::nullopt;
  std::vector<std::byte> data = std::move(holder->second.bytes);
  incoming_.erase(holder);
  return data;
}

void RequestLedger::list(std::vector<KeptForClient>& kept) const {
  std::map<const void*, KeptForClient> snapshots;  // each counted once for all clients that share it
  for (const auto& [client, data] : outgoing_) {
    KeptForClient& each = snapshots[data.bytes.get()];
    if (each.since <= data.since) each = {KeptForClient::Kind::saved_snapshot, client, data.since, data.bytes->size()};
  }
  for (const auto& [bytes, each] : snapshots) kept.push_back(each);
  for (const auto& [client, data] : incoming_)
    kept.push_back({KeptForClient::Kind::upload, client, data.since, data.bytes.capacity()});
}

void RequestLedger::drop(const KeptForClient& kept, const std::string& why) {
  if (kept.kind == KeptForClient::Kind::upload) {
    incoming_.erase(kept.client);
    dropped_[{kept.client, kept.kind}] = why;
    return;
  }
  const auto bytes = outgoing_.at(kept.client).bytes;
  std::erase_if(outgoing_, [&](const auto& each) {
    const bool goes = each.second.bytes == bytes;
    if (goes) dropped_[{each.first, kept.kind}] = why;
    return goes;
  });
}

std::string RequestLedger::why_dropped(std::uint64_t client, KeptForClient::Kind kind) const {
  const auto found = dropped_.find({client, kind});
  return found == dropped_.end() ? std::string() : found->second;
}

void RequestLedger::leave(std::uint64_t client) {
  outgoing_.erase(client);
  incoming_.erase(client);
  for (const auto kind : {KeptForClient::Kind::saved_snapshot, KeptForClient::Kind::upload})
    dropped_.erase({client, kind});
}

}  // namespace cohort::session
