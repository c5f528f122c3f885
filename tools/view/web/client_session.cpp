// SPDX-License-Identifier: Apache-2.0
#include "tools/view/web/client_session.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace cohort::view {
namespace {

using Json = nlohmann::json;

Topic topic_of(std::uint32_t channel) { return static_cast<Topic>(channel); }

// Throws protocol::ProtocolError.
ViewRequest read_request(const std::string& payload) {
  constexpr std::size_t longest_list = 64;
  const Json json = Json::parse(payload, nullptr, false);
  if (!json.is_object()) throw protocol::ProtocolError("expected a request as a JSON object");
  ViewRequest request;
  for (const auto& [key, value] : json.items()) {
    if (key == "operation" && value.is_string()) {
      request.operation = value.get<std::string>();
    } else if (key == "number" && value.is_number()) {
      request.number = value.get<double>();
    } else if (key == "name" && value.is_string()) {
      request.name = value.get<std::string>();
    } else if (key == "text" && value.is_string()) {
      request.text = value.get<std::string>();
    } else if (key == "numbers" && value.is_array() && value.size() <= longest_list &&
               std::ranges::all_of(value, [](const Json& each) { return each.is_number(); })) {
      request.numbers = value.get<std::vector<double>>();
    } else if (key == "names" && value.is_array() && value.size() <= longest_list &&
               std::ranges::all_of(value, [](const Json& each) { return each.is_string(); })) {
      request.names = value.get<std::vector<std::string>>();
    } else if (key == "from" && value.is_number()) {
      request.from = value.get<double>();
    } else if (key == "to" && value.is_number()) {
      request.to = value.get<double>();
    } else {
      throw protocol::ProtocolError(
          "invalid request: expected operation, name and text as strings, number, from and to as numbers, and numbers "
          "and names as lists of at most 64 elements");
    }
  }
  if (request.operation.empty()) throw protocol::ProtocolError("a request needs an operation");
  return request;
}

// JSON has no infinity and no NaN: such values are null.
Json json_of(const ValueHistory& history) {
  Json list = Json::array();
  for (const ValueSeries& each : history.series)
    list.push_back({{"robot", each.robot},
                    {"name", each.name},
                    {"unit", each.unit},
                    {"times", each.times},
                    {"values", each.values}});
  return list;
}

}  // namespace

ClientSession::ClientSession(Topics& topics, const std::string& name, const std::string& session, Callbacks callbacks)
    : topics_(topics), callbacks_(std::move(callbacks)) {
  reply(Text{protocol::server_info(name, session)});
  reply(Text{protocol::advertise_channels()});
  reply(Text{protocol::advertise_services()});
}

ClientSession::~ClientSession() {
  for (const auto& [id, slot] : subscriptions_) topics_.remove_reader(topic_of(slot.channel));
}

void ClientSession::reply(Outgoing outgoing) {
  if (replies_.size() < most_replies) replies_.push_back(std::move(outgoing));
}

void ClientSession::complain(const std::string& text) {
  reply(Text{protocol::status(protocol::StatusLevel::error, text)});
}

void ClientSession::take_text(std::string_view text) {
  try {
    std::visit([this](const auto& message) { take(message); }, protocol::parse_text(text));
  } catch (const protocol::ProtocolError& error) {
    complain(error.what());
  }
}

void ClientSession::take_binary(std::span<const std::byte> bytes) {
  try {
    std::visit([this](const auto& message) { take(message); }, protocol::parse_binary(bytes));
  } catch (const protocol::ProtocolError& error) {
    complain(error.what());
  }
}

void ClientSession::take(const protocol::Subscribe& subscribe) {
  for (const protocol::Subscription& each : subscribe.subscriptions) {
    if (each.channel >= topic_count) {
      complain("no channel " + std::to_string(each.channel));
    } else if (subscriptions_.size() >= most_subscriptions) {
      complain("a client has at most " + std::to_string(most_subscriptions) + " subscriptions");
    } else if (!subscriptions_.try_emplace(each.id, Slot{each.channel}).second) {
      complain("duplicate subscription " + std::to_string(each.id));
    } else {
      topics_.add_reader(topic_of(each.channel));
    }
  }
}

void ClientSession::take(const protocol::Unsubscribe& unsubscribe) {
  for (const std::uint32_t id : unsubscribe.ids) {
    const auto found = subscriptions_.find(id);
    if (found == subscriptions_.end()) {
      complain("no subscription " + std::to_string(id));
      continue;
    }
    topics_.remove_reader(topic_of(found->second.channel));
    subscriptions_.erase(found);
  }
}

void ClientSession::take(const protocol::NotOffered& refused) {
  complain("the operation '" + refused.operation + "' is not offered");
}

void ClientSession::take(const protocol::ServiceCall& call) {
  if (call.service != protocol::control_service || call.encoding != "json") {
    reply(Text{protocol::service_failure(call, "unknown service: expected /cohort/control, in json")});
    return;
  }
  try {
    const ViewRequest request = read_request(call.payload);
    if (request.operation == "watch")
      watch(call, request);
    else
      callbacks_.ask(call, request);
  } catch (const protocol::ProtocolError& error) {
    reply(Text{protocol::service_failure(call, error.what())});
  }
}

void ClientSession::watch(const protocol::ServiceCall& call, const ViewRequest& request) {
  const auto is_id = [](double number) { return number >= 0.0 && number < 4294967295.0; };
  if (request.numbers.size() > most_watched || !std::ranges::all_of(request.numbers, is_id)) {
    respond(call, {false, "at most " + std::to_string(most_watched) + " robots can be watched, by their ids"});
    return;
  }
  watched_.assign(request.numbers.size(), 0);
  std::ranges::transform(request.numbers, watched_.begin(),
                         [](double number) { return static_cast<std::uint32_t>(number); });
  callbacks_.watched_changed();
  respond(call, {true, "watched"});
}

void ClientSession::respond(const protocol::ServiceCall& call, const Answer& answer) {
  Json json{{"done", answer.is_done}, {"text", answer.text}};
  if (answer.history != nullptr) {
    if (histories_ == most_histories)
      return respond(call, {false, "earlier histories have not been read: request one at a time"});
    json["series"] = json_of(*answer.history);
    json["reduced"] = answer.history->is_reduced;
    if (answer.history->next) json["next"] = *answer.history->next;
    ++histories_;
  }
  reply(protocol::service_response(call, json.dump(-1, ' ', false, Json::error_handler_t::replace)));
}

// In turns, so that a topic that changes all the time does not keep others back.
std::optional<ClientSession::Outgoing> ClientSession::next() {
  if (!replies_.empty()) {
    Outgoing first = std::move(replies_.front());
    replies_.pop_front();
    if (replies_.empty()) histories_ = 0;
    return first;
  }
  const auto after = subscriptions_.upper_bound(last_served_);
  if (auto found = next_of(after, subscriptions_.end())) return found;
  return next_of(subscriptions_.begin(), after);
}

std::optional<ClientSession::Outgoing> ClientSession::next_of(std::map<std::uint32_t, Slot>::iterator begin,
                                                              std::map<std::uint32_t, Slot>::iterator end) {
  for (auto each = begin; each != end; ++each) {
    auto& [id, slot] = *each;
    auto published = topics_.newest(topic_of(slot.channel));
    if (published == nullptr || published->version == slot.sent) continue;
    slot.sent = published->version;
    last_served_ = id;
    return Data{protocol::message_head(id, published->time), std::move(published)};
  }
  return std::nullopt;
}

}  // namespace cohort::view
