// SPDX-License-Identifier: Apache-2.0
#include "server/serving/client_names.hpp"

namespace cohort::session {
namespace {

std::string too_many(std::size_t most, const std::string& of) {
  return "flood: the limit of " + std::to_string(most) + " clients" + of + " is reached";
}

}  // namespace

std::string ClientNames::enter(std::uint64_t client, const wire::Sender& sender,
                               const std::optional<wire::Identity>& identity) {
  if (client == 0) return "malformed: a Join has client id 0, which is invalid";
  const auto known = names_.find(client);
  if (known != names_.end() && known->second.participant != sender.participant)
    return "foreign: a Join has the id of another client";
  const auto last = client_of_participant_.find(sender.participant);
  if (last != client_of_participant_.end() && last->second != client && !names_.at(last->second).gone)
    return "foreign: a participant that has joined sent a Join with another id";
  const std::string name = identity ? identity->name : "";
  if (known == names_.end()) {
    if (names_.size() >= most_clients) return too_many(most_clients, "");
    if (identity && clients_of_identity_[name] >= most_of_one_identity)
      return too_many(most_of_one_identity, " of '" + name + "'");
    ++clients_of_identity_[name];
  } else {
    client_of_writer_.erase(known->second.writer);
  }
  names_[client] = {sender.participant, sender.writer, name, false};
  client_of_participant_[sender.participant] = client;
  client_of_writer_[sender.writer] = client;
  return {};
}

void ClientNames::forget(std::uint64_t client) {
  const auto found = names_.find(client);
  if (found == names_.end()) return;
  const Name& name = found->second;
  client_of_writer_.erase(name.writer);
  const auto last = client_of_participant_.find(name.participant);
  if (last != client_of_participant_.end() && last->second == client) client_of_participant_.erase(last);
  --clients_of_identity_[name.identity];
  names_.erase(found);
}

std::optional<std::uint64_t> ClientNames::client_of_writer(std::uint64_t writer) const {
  const auto found = client_of_writer_.find(writer);
  return found == client_of_writer_.end() ? std::nullopt : std::optional(found->second);
}

bool ClientNames::is_in_own_name(std::uint64_t client, const wire::Sender& sender) const {
  const auto found = names_.find(client);
  return found != names_.end() && found->second.participant == sender.participant;
}

}  // namespace cohort::session
