#include "tools/lockstep/lockstep_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>

#include "tools/lockstep/lockstep_world.hpp"

namespace cohort::bench {
namespace {

constexpr std::uint32_t first_domain = 1;
constexpr std::uint32_t domains = 59;

// Any that no other server has.
std::pair<wire::Participant, std::uint32_t> open_domain() {
  const auto start = static_cast<std::uint32_t>(getpid());
  for (std::uint32_t i = 0;; ++i) {
    const std::uint32_t domain = first_domain + (start + i) % domains;
    try {
      return {wire::Participant::server(domain), domain};
    } catch (const wire::DomainTaken&) {
      if (i + 1 == domains) throw;
    }
  }
}

std::vector<std::vector<std::string>> arguments_of(const IdleClients& clients, std::uint32_t domain) {
  std::vector<std::vector<std::string>> all;
  for (const auto& [first, end] : clients.shares) {
    all.push_back({"--robots", fmt::format("{}..{}", first, end - 1), "--domain", std::to_string(domain), "--work",
                   fmt::format("{}", clients.work)});
    if (clients.inline_step) all.back().emplace_back("--inline");
  }
  return all;
}

}  // namespace

LockstepRun::LockstepRun(std::uint32_t robots, std::uint32_t delay, const IdleClients& clients)
    : experiment_(idle_robots(robots, delay)), simulation_(experiment_, 1), domain_(open_domain()) {
  session::RunListener listener;
  listener.boundary = [this] {
    if (on_boundary) on_boundary();
  };
  listener.barrier = [this](std::chrono::nanoseconds latency) {
    if (on_barrier) on_barrier(std::chrono::duration<double>(latency).count());
  };
  listener.progress = [this](const session::Progress&) {
    if (*interrupted_) stop_ = true;
  };
  listener.ending = [this] { clients_->may_end(); };
  server_ = std::make_unique<session::Server>(experiment_, simulation_, domain_.first, session::RunOptions{}, listener);
  clients_ = std::make_unique<BenchProcesses>(arguments_of(clients, domain_.second),
                                              [this](const std::string& text) { server_->fail(text); });
}

void LockstepRun::run(const std::atomic<bool>& interrupted) {
  interrupted_ = &interrupted;
  const session::RunResult result = server_->run(stop_);
  if (result.end == session::RunResult::End::failed) throw std::runtime_error(result.error);
  clients_->let_finish();
}

}  // namespace cohort::bench
