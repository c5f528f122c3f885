// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/control/run_history_query.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "client_sdk/include/cohort/control.hpp"
#include "idl/messages/run_history.hpp"
#include "idl/text/printable.hpp"

namespace cohort {
namespace {

messages::RunHistory decode_part(const wire::HistoryPart& part) {
  try {
    return messages::decode<messages::RunHistory>(std::as_bytes(std::span(part.data)));
  } catch (const messages::CdrError& error) {
    throw ControlError(std::string("the server sent an invalid history: ") + error.what(), ControlResult::bad_reply);
  }
}

void add(RunHistory& history, const messages::RunHistory& part) {
  history.begin_tick = part.begin_tick;
  history.keep_interval = part.keep_interval;
  history.first_kept_tick = part.first_kept_tick;
  history.last_kept_tick = part.last_kept_tick;
  for (const messages::HistoryEvent& event : part.events) {
    RunEvent added{event.tick, event.last_tick, event.count, printable(event.kind), printable(event.text)};
    std::erase_if(history.events,
                  [&](const auto& known) { return known.kind == added.kind && known.text == added.text; });
    history.events.push_back(std::move(added));
  }
}

}  // namespace

RunHistory query_history(std::uint64_t since, const std::function<wire::Reply(const wire::GetHistory&)>& ask) {
  RunHistory history;
  history.revision = since;
  for (;;) {
    const wire::Reply reply = ask({history.revision});
    const auto* const part = reply.get<wire::HistoryPart>();
    if (part == nullptr) throw ControlError("the server's reply lacks the history", ControlResult::bad_reply);
    if (reply.run != history.run) {  // each run counts its revisions from 0
      const bool was_asked_of_it = history.run == 0;
      history.events.clear();
      history.run = reply.run;
      if (!was_asked_of_it) {
        history.revision = 0;
        continue;
      }
    }
    add(history, decode_part(*part));
    const bool is_complete = part->revision <= history.revision || part->revision >= part->newest;
    history.revision = part->revision;
    if (is_complete) return history;
  }
}

}  // namespace cohort
