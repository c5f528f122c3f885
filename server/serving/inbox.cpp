// SPDX-License-Identifier: Apache-2.0
#include "server/serving/inbox.hpp"

#include "idl/text/printable.hpp"

namespace cohort::session {
namespace {

std::size_t size_of(const wire::Join& join) {
  std::size_t bytes = sizeof join + join.controller.size() + join.host.size();
  for (const std::string& selector : join.robots) bytes += sizeof selector + selector.size();
  return bytes;
}

std::size_t size_of(const wire::Report& report) { return sizeof report + report.reason.size() + report.text.size(); }

// Make a client's texts printable. Documents, which are parsed, stay unchanged.
wire::Join cleaned(wire::Join join) {
  join.controller = printable(join.controller, Inbox::longest_label);
  join.host = printable(join.host, Inbox::longest_label);
  for (std::string& selector : join.robots) selector = printable(selector);
  return join;
}

wire::Report cleaned(wire::Report report) {
  report.reason = printable(report.reason, Inbox::longest_label);
  report.text = printable(report.text, Inbox::longest_text);
  return report;
}

wire::Request cleaned(wire::Request request) {
  request.label = printable(request.label, Inbox::longest_label);
  std::visit([](auto& operation) { wire::for_each_name(operation, [](std::string& name) { name = printable(name); }); },
             request.operation);
  return request;
}

}  // namespace

bool Inbox::add_arrival(const wire::Join& join, const wire::Sender& sender, wire::Participant* participant) {
  const std::size_t bytes = size_of(join);
  if (bytes > largest_join) {
    reject(sender.participant, "malformed", "a Join is larger than 128 KiB");
    return false;
  }
  if (contents_.arrivals.size() >= most_arrivals || arrival_bytes_ + bytes > most_arrival_bytes) {
    reject(sender.participant, "flood", "too many Joins");
    return false;
  }
  arrival_bytes_ += bytes;
  contents_.arrivals.push_back({cleaned(join), sender, participant});
  return has_news_ = true;
}

bool Inbox::add_liveliness(const wire::Sender& sender, bool alive) {
  contents_.liveliness.push_back({sender, alive});
  return has_news_ = true;
}

bool Inbox::add_report(const wire::Report& report, const wire::Sender& sender) {
  const std::size_t bytes = size_of(report);
  if (bytes > largest_report) {
    reject(sender.participant, "malformed", "a Report is larger than 64 KiB");
    return false;
  }
  if (contents_.reports.size() >= most_reports || report_bytes_ + bytes > most_report_bytes) {
    reject(sender.participant, "flood", "too many Reports");
    return false;
  }
  report_bytes_ += bytes;
  contents_.reports.push_back(cleaned(report));
  return has_news_ = true;
}

bool Inbox::add_ended_process(std::uint32_t process) {
  contents_.ended_processes.push_back(process);
  return has_news_ = true;
}

bool Inbox::add_request(const wire::Request& request, const wire::Sender& sender, wire::Participant* participant) {
  const std::size_t bytes = size_of(request);
  if (bytes > largest_request) {
    reject(sender.participant, "malformed", "a Request is larger than 4 MiB");
    return false;
  }
  std::size_t& of_sender = requests_of_[sender.participant];
  if (of_sender >= wire::requests_under_way || contents_.requests.size() >= most_requests ||
      request_bytes_ + bytes > most_request_bytes) {
    reject(sender.participant, "flood", "too many Requests");
    return false;
  }
  ++of_sender;
  request_bytes_ += bytes;
  contents_.requests.push_back({cleaned(request), sender, participant});
  return has_news_ = true;
}

bool Inbox::add_state(const wire::ControllerState& message, const wire::Sender& sender) {
  if (message.kind > wire::StateKind::unsaved) return false;  // from a later minor version
  if (message.data.size() > wire::largest_state_part) {
    reject(sender.participant, "malformed", "a ControllerState is larger than 256 KiB");
    return false;
  }
  if (state_bytes_ + message.data.size() > most_state_bytes) {
    reject(sender.participant, "flood", "too much controller state");
    return false;
  }
  state_bytes_ += message.data.size();
  contents_.states.insert_or_assign({message.client, message.kind}, KeptStateMessage(message));
  return has_news_ = true;
}

bool Inbox::add_gone_requester(const wire::Sender& sender) {
  contents_.gone_requesters.push_back(sender);
  return has_news_ = true;
}

bool Inbox::add_failure(const std::string& error) {
  if (contents_.failure.empty()) contents_.failure = error;
  return has_news_ = true;
}

bool Inbox::add_foreign_version(std::uint32_t major) {
  if (contents_.foreign_versions.size() >= most_foreign_versions || !contents_.foreign_versions.insert(major).second)
    return false;
  return has_news_ = true;
}

void Inbox::reject(std::uint64_t who, const char* reason, std::string_view text, std::optional<std::uint64_t> tick) {
  Rejections& rejections = contents_.rejected[{who, reason}];
  if (rejections.count++ > 0) return;
  rejections.text = text;
  rejections.tick = tick;
}

Inbox::Contents Inbox::take() {
  requests_of_.clear();
  arrival_bytes_ = report_bytes_ = request_bytes_ = state_bytes_ = 0;
  has_news_ = false;
  return std::exchange(contents_, {});
}

}  // namespace cohort::session
