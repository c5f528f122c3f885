// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <span>
#include <string_view>

#include "tools/view/sources/control_requests.hpp"
#include "tools/view/web/client_session.hpp"

namespace {

using namespace cohort::view;

// Nobody makes a session keep more than it may.
void drain(ClientSession& session) {
  std::size_t count = 0;
  while (session.next())
    if (++count > ClientSession::most_replies + ClientSession::most_subscriptions) std::abort();
  if (session.watched().size() > ClientSession::most_watched) std::abort();
}

void ask(const ViewRequest& request) {
  try {
    operation_of(request);
  } catch (const std::invalid_argument&) {
  }
}

}  // namespace

/// Whatever a browser sends, as text or binary, is heeded or answered with a status.
// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer calls it so.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Topics topics;
  topics.publish(Topic::frame, {}, cohort::recording::Bytes(10));
  ClientSession session(topics, "fuzz", "1", {[](const auto&, const ViewRequest& request) { ask(request); }, [] {}});
  drain(session);
  session.take_text({reinterpret_cast<const char*>(data), size});
  drain(session);
  session.take_binary(std::as_bytes(std::span(data, size)));
  drain(session);
  return 0;
}
