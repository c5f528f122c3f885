// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/lockstep/lockstep_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>

#include "tests/benchmarks/comparison/lockstep/lockstep_world.hpp"

namespace cohort::bench {
namespace {

constexpr std::uint32_t first_domain = 1;
constexpr std::uint32_t domains = 59;
constexpr std::size_t processes_per_domain = 64;  // as in `cohort run`

std::vector<std::vector<std::string>> arguments_of(const IdleClients& clients,
                                                   const std::vector<std::uint32_t>& domains_served) {
  std::vector<std::vector<std::string>> all;
  for (const auto& [first, end] : clients.shares) {
    const std::uint32_t domain = domains_served[all.size() % domains_served.size()];
    all.push_back({"--robots", fmt::format("{}..{}", first, end - 1), "--domain", std::to_string(domain), "--work",
                   fmt::format("{}", clients.work)});
    if (clients.inline_step) all.back().emplace_back("--inline");
  }
  return all;
}

}  // namespace

LockstepRun::LockstepRun(std::uint32_t robots, std::uint32_t delay, const IdleClients& clients)
    : experiment_(idle_robots(robots, delay)), simulation_(experiment_, 1) {
  open_domains((clients.shares.size() + processes_per_domain - 1) / processes_per_domain);
  server_ = std::make_unique<session::Server>(participants_);
  clients_ = std::make_unique<BenchProcesses>(arguments_of(clients, domains_),
                                              [this](const std::string& text) { server_->fail(text); });
}

// Opens domains that no other server uses.
void LockstepRun::open_domains(std::size_t wanted) {
  const auto start = static_cast<std::uint32_t>(getpid());
  for (std::uint32_t i = 0; participants_.size() < wanted; ++i) {
    const std::uint32_t domain = first_domain + (start + i) % domains;
    try {
      participants_.push_back(wire::Participant::server(domain));
      domains_.push_back(domain);
    } catch (const wire::DomainTaken&) {
      if (i + 1 == domains) throw;
    }
  }
}

void LockstepRun::run(const LockstepListener& listener, const std::atomic<bool>& interrupted) {
  session::RunListener of_server;
  of_server.stepped = listener.boundary;
  of_server.barrier = [&](std::chrono::nanoseconds latency) {
    if (listener.barrier) listener.barrier(std::chrono::duration<double>(latency).count());
  };
  of_server.progress = [&](const session::Progress&) {
    if (interrupted) stop_ = true;
  };
  const session::RunResult result = server_->run(experiment_, simulation_, {}, of_server, stop_);
  clients_->may_end();
  server_->dismiss(result);
  clients_->let_finish();
  if (result.end == session::RunResult::End::failed) throw std::runtime_error(result.error);
}

}  // namespace cohort::bench
