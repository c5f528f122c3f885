// SPDX-License-Identifier: Apache-2.0

// A long run in lockstep that measures the resources of server and clients: soak TICKS CONTROLLERS. Prints a table;
// exit code 1 if memory, open files or threads grew after the first tenth.

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "idl/dds/transport.hpp"
#include "tests/support/worlds/field_of_robots.hpp"

namespace {

using namespace cohort;
using namespace cohort::test;

constexpr int rows = 10;

struct Held {
  double memory = 0.0;  // resident [MB]
  std::size_t files = 0;
  std::size_t threads = 0;

  Held& operator+=(const Held& other) {
    memory += other.memory;
    files += other.files;
    threads += other.threads;
    return *this;
  }
};

std::size_t entries(const std::filesystem::path& folder) {
  std::error_code gone;
  const std::filesystem::directory_iterator all(folder, gone);
  return gone ? 0 : static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

Held held_by(pid_t pid) {
  const std::filesystem::path folder = "/proc/" + std::to_string(pid);
  constexpr double megabyte = 1024.0 * 1024.0;
  const double memory = static_cast<double>(cohort::test::resident_bytes(pid)) / megabyte;
  return {memory, entries(folder / "fd"), entries(folder / "task")};
}

// Tolerates a tenth of the memory and some megabytes, as the memory kept by allocators varies.
bool has_grown(const Held& before, const Held& after) {
  return after.memory > 1.1 * before.memory + 4.0 || after.files > before.files || after.threads > before.threads;
}

void print(std::uint64_t tick, const Held& server, const Held& clients) {
  std::printf("%9lu  %9.1f %5zu %7zu  %9.1f %5zu %7zu\n", static_cast<unsigned long>(tick), server.memory, server.files,
              server.threads, clients.memory, clients.files, clients.threads);
  std::fflush(stdout);
}

// Returns the exit code.
int soak(std::uint64_t ticks, int controllers) {
  const FieldOfRobots field(controllers, static_cast<double>(ticks) / 100.0);
  const ReservedDomain domain;
  Process server(field.serve(domain));
  std::vector<std::unique_ptr<Process>> clients;
  clients.reserve(static_cast<std::size_t>(controllers));
  for (int i = 0; i < controllers; ++i)
    clients.push_back(std::make_unique<Process>(FieldOfRobots::host(domain, std::to_string(i))));

  std::atomic<std::uint64_t> now = 0;
  wire::Participant participant = wire::Participant::client(domain.number());
  const wire::Reader<wire::WorldState> reader(
      participant, {[&](const wire::WorldState& state, const wire::Sender&) { now = state.tick; }, {}}, "view");
  std::printf("          server                      clients, together\n");
  std::printf("     tick  memory MB files threads  memory MB files threads\n");
  std::optional<std::pair<Held, Held>> first;
  bool grew = false;
  for (int row = 1; row < rows && server.running(); ++row) {
    while (now < ticks * static_cast<std::uint64_t>(row) / rows && server.running())
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const Held of_server = held_by(server.pid());
    Held of_clients;
    for (const auto& client : clients) of_clients += held_by(client->pid());
    print(now, of_server, of_clients);
    if (!first) first.emplace(of_server, of_clients);
    grew = has_grown(first->first, of_server) || has_grown(first->second, of_clients);
  }
  while (server.running()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (server.wait_for_exit() != 0) {
    std::fputs(server.output().c_str(), stderr);
    return 1;
  }
  const auto summary = field.summary();
  std::printf("%s ticks in %.0f s, p50 %.0f us, p99 %.0f us, %s frames sent again, state hash %s\n",
              summary["ticks"].dump().c_str(), summary["wall_s"].get<double>(),
              summary["barrier_us"]["p50"].get<double>(), summary["barrier_us"]["p99"].get<double>(),
              summary["resent"].dump().c_str(), summary["state_hash"].get<std::string>().c_str());
  std::puts(grew ? "something grew" : "nothing grew");
  return grew || summary["ticks"] != ticks ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    return soak(std::stoull(argv[1]), std::stoi(argv[2]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "soak: %s\n", error.what());
    return 1;
  }
}
