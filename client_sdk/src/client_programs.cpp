// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <csignal>

#include "client_sdk/include/cohort/client.hpp"

namespace cohort {
namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a signal handler reaches nothing but globals.
std::atomic<bool> stop_requested{false};

}  // namespace

std::atomic<bool>& stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop_requested = true; };
  action.sa_flags = SA_RESETHAND;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangup {};
  ::sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr);
  return stop_requested;
}

int exit_code_of(ClientEnd end) {
  switch (end) {
    case ClientEnd::finished: return 0;
    case ClientEnd::refused: return 2;
    case ClientEnd::interrupted: return 130;
    case ClientEnd::failed:
    case ClientEnd::superseded:
    case ClientEnd::server_lost: break;
  }
  return 1;
}

}  // namespace cohort
