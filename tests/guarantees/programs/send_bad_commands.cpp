// SPDX-License-Identifier: Apache-2.0

// A stranger on the network: `send_bad_commands DOMAIN CLIENT [FOLDER OF AN IDENTITY]`. Sends every kind of bad
// command, Join and Report with the id of the given client, about a thousand a second, until it is killed.

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "idl/dds/transport.hpp"
#include "tests/support/worlds/sbot_layout.hpp"

int main(int argc, char** argv) {
  using namespace cohort;
  if (argc != 3 && argc != 4) return 2;
  const std::uint64_t client = std::stoull(argv[2]);
  std::optional<wire::Identity> identity;
  if (argc == 4) identity = wire::read_identity(argv[3]);
  auto participant = wire::Participant::client(static_cast<std::uint32_t>(std::stoul(argv[1])), "127.0.0.1", identity);
  std::atomic<std::uint64_t> tick = 0;
  std::optional<wire::Reader<wire::WorldState>> states;  // an identity may not know what others do
  if (!identity)
    states.emplace(participant,
                   wire::Reader<wire::WorldState>::Callbacks{
                       [&](const wire::WorldState& state, const wire::Sender&) { tick = state.tick; }, {}},
                   "view");
  wire::Writer<wire::Command> commands(participant);
  wire::Writer<wire::Join> joins(participant);
  wire::Writer<wire::Report> reports(participant);
  while (commands.matched() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::puts("sending");
  std::fflush(stdout);

  std::vector<std::uint32_t> all(16);
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<std::uint32_t> first = {0}, nonsense = {99, 3, 3}, none;
  constexpr std::size_t all_values = 16 * cohort::test::sbot_command_size;
  const std::vector<double> nan(all_values, std::nan("")),
      infinite(all_values, std::numeric_limits<double>::infinity()), fast(all_values, 1e9), fitting(all_values, 0.1),
      fitting_one(cohort::test::sbot_command_size, 0.1), nothing;
  for (int round = 0;; ++round) {
    for (const std::uint64_t ahead : {0u, 1u, 2u, 1000u}) {
      const std::uint64_t at = tick + ahead;
      commands.write({client, 1, 1, at, all, nan});
      commands.write({client, 1, 1, at, all, infinite});
      commands.write({client, 1, 2, at, first, fast});
      commands.write({client, 1, 1, at, all, fitting});
      commands.write({client, 1, 2, at, first, fitting_one});
      commands.write({client, 1, 1, at, nonsense, fitting_one});
      commands.write({client, 1, 1, at, none, nothing});
      commands.write({client, 1, 1, at, first, fitting_one});
      commands.write({client, 2, 1, 0, all, fitting});
    }
    if (round == 1000 / (4 * 9)) {
      std::puts("sent a thousand");
      std::fflush(stdout);
    }
    wire::Join join;
    join.client = client;
    join.controller = "stranger";
    join.robots = {"explorers/nobody"};
    joins.write(join);
    reports.write({client, 1, wire::ReportKind::failed, tick, "exception", "forged"});
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
}
