// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/serving.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <thread>
#include <utility>

#include "server/core/thread_room.hpp"
#include "server/description/select_robots.hpp"
#include "tools/cli/common/exit_codes.hpp"
#include "tools/cli/common/wording.hpp"
#include "tools/cli/running/controller_processes.hpp"

namespace cohort::tool {
namespace {

// Domains among which a run chooses its own, for controllers that it starts itself.
constexpr std::uint32_t first_own_domain = 1;
constexpr std::uint32_t own_domain_count = 59;
// The server has writers for each client of a domain and announces all of them to all clients: matching time grows with
// the square of their number.
constexpr std::size_t processes_per_domain = 64;
// Two files for each process that is started here: one for its end, one for its output.
constexpr std::size_t files_per_process = 2;
constexpr std::size_t files_besides = 200;
// The threads that Cyclone DDS starts for a participant. It ends the process if it cannot start one of them.
constexpr std::size_t threads_per_participant = 6;
// The threads of the run: its watchdog, the one that watches its processes, and the one that reads models.
constexpr std::size_t threads_of_run = 3;

std::size_t process_count(const RunCommand& command, const description::Experiment& experiment) {
  if (command.controllers == Controllers::external) return 0;
  return command.controllers == Controllers::per_robot ? experiment.world.robots.size() : experiment.teams.size();
}

// Returns how many more processes may be started for robots that events add.
std::size_t later_process_count(const RunCommand& command, const description::Experiment& experiment) {
  std::size_t count = 0;
  if (command.controllers == Controllers::external) return count;
  for (const description::Spawner& spawner : experiment.spawners)
    if (experiment.world.models[spawner.model].is_robot()) count += spawner.most;
  return count;
}

// Returns the server's identities; without security, one that is none.
std::vector<std::optional<wire::Identity>> identities_of(const RunCommand& command) {
  if (command.secure.empty()) return {std::nullopt};
  std::vector<std::optional<wire::Identity>> identities;
  for (wire::Identity& identity : wire::read_server_identities(command.secure))
    identities.emplace_back(std::move(identity));
  return identities;
}

// Creates the participants of all identities in a domain, or none.
void open_domain(std::uint32_t domain, const RunCommand& command,
                 const std::vector<std::optional<wire::Identity>>& identities,
                 std::vector<wire::Participant>& participants) {
  std::vector<wire::Participant> opened;
  opened.reserve(identities.size());
  for (const auto& identity : identities)
    opened.push_back(wire::Participant::server(domain, command.network, identity));
  std::ranges::move(opened, std::back_inserter(participants));
}

// Clients that are started elsewhere must know the domains: those given, or 0. Otherwise only child processes use the
// domains: they are any free ones, so that several runs on one machine do not meet.
void open_domains(const RunCommand& command, bool has_outsiders, std::size_t processes,
                  std::vector<std::uint32_t>& domains, std::vector<wire::Participant>& participants) {
  const std::vector<std::optional<wire::Identity>> identities = identities_of(command);
  const std::size_t first_count = std::max<std::size_t>(1, command.domains.size()) * identities.size();
  expect_room_for_threads(
      static_cast<unsigned>(threads_of_run + threads_per_participant * (first_count + processes) + processes));
  if (!command.domains.empty() || has_outsiders) {
    domains = command.domains.empty() ? std::vector<std::uint32_t>{0} : command.domains;
    for (const std::uint32_t domain : domains) open_domain(domain, command, identities, participants);
    return;
  }
  const std::size_t wanted = std::max<std::size_t>(1, (processes + processes_per_domain - 1) / processes_per_domain);
  const auto start = static_cast<std::uint32_t>(getpid());
  for (std::uint32_t i = 0; domains.size() < wanted && i < own_domain_count; ++i) {
    const std::uint32_t domain = first_own_domain + (start + i) % own_domain_count;
    try {
      open_domain(domain, command, identities, participants);
      domains.push_back(domain);
    } catch (const wire::DomainTaken&) {
      if (i + 1 == own_domain_count && domains.empty()) throw;
    } catch (const wire::WireError& error) {
      throw wire::WireError(std::string(error.what()) + ". '--controllers inprocess' needs no network");
    }
  }
}

// Raises the limit of open files to the number that these processes need.
void raise_file_limit(std::size_t processes, Log& log) {
  const rlim_t needed = files_besides + files_per_process * processes;
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= needed) return;
  const rlim_t wanted = limit.rlim_max == RLIM_INFINITY ? needed : std::min<rlim_t>(needed, limit.rlim_max);
  limit.rlim_cur = wanted;
  if (setrlimit(RLIMIT_NOFILE, &limit) != 0 || wanted < needed)
    log.warning(fmt::format(
        "{} need {} open files, but only {} are allowed; as root, run 'ulimit -Hn {}' in the shell that starts Cohort",
        counted(processes, "process"), needed, limit.rlim_cur, needed));
}

std::string domains_text(const std::vector<std::uint32_t>& domains) {
  if (domains.size() == 1) return fmt::format("domain {}", domains.front());
  return fmt::format("domains {}", fmt::join(domains, ", "));
}

// Returns the command line of this process.
std::vector<std::string> own_words() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  return words;
}

// Returns the command line of this process, quoted for a shell.
std::string own_command_line() {
  std::string line = "cohort";
  std::vector<std::string> words = own_words();
  words.erase(words.begin());  // the program's path
  for (std::string& word : words) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=+@%";
    const bool is_plain = !word.empty() && word.find_first_not_of(plain) == std::string::npos;
    for (std::size_t at = 0; !is_plain && (at = word.find('\'', at)) != std::string::npos; at += 4)
      word.replace(at, 1, "'\\''");
    line += is_plain ? " " + word : " '" + word + "'";
  }
  return line;
}

// Returns whether an event of the experiment has added the object, judged by its name.
bool is_spawned(const std::string& name, const description::Experiment& experiment) {
  return std::ranges::any_of(experiment.spawners, [&](const description::Spawner& spawner) {
    const std::string start = spawner.name + "_";
    return name.starts_with(start) && name.find_first_not_of("0123456789", start.size()) == std::string::npos;
  });
}

// Adds the identities of the view: one that observes and, if the view may control, one that controls and one that
// drives the robots of people.
void add_identities_of_view(const RunCommand& command, const description::Experiment& experiment,
                            std::vector<std::string>& arguments) {
  const auto add = [&](const char* option, const std::filesystem::path& identity) {
    arguments.insert(arguments.end(), {option, identity.string()});
  };
  add("--secure", command.secure / "clients" / "observer");
  if (!command.view_controls && !command.view_opens) return;
  const std::vector<wire::Identity> identities = wire::read_server_identities(command.secure);
  const auto controls = std::ranges::find_if(identities, &wire::Identity::may_control);
  if (controls != identities.end()) add("--secure-control", command.secure / "clients" / controls->name);
  if (!command.view_controls) return;
  const auto driven = std::ranges::find(experiment.teams, keyboard_controller, &description::Team::controller);
  if (driven != experiment.teams.end()) add("--secure-drive", identity_for(experiment, *driven, command.secure));
}

}  // namespace

Serving::Serving(const RunCommand& command, const description::Experiment& experiment, Log& log)
    : command_(command), log_(log) {
  const std::size_t processes = process_count(command, experiment);
  raise_file_limit(processes + later_process_count(command, experiment), log);
  const bool external = command.controllers == Controllers::external;
  open_domains(command, external || has_keyboard(experiment), processes, domains_, participants_);
  server_.emplace(participants_);
  if (command.secure.empty() && !command.network.starts_with("127.") && command.network != "localhost")
    log.warning(fmt::format(
        "no security: anyone who can reach {} can drive robots, control this run and end it. 'cohort security init "
        "DIR' creates identities for '--secure DIR'; without them, use a private network only",
        command.network));
  const std::string serving =
      fmt::format("serving {} on {}, {}{}", counted(experiment.world.robots.size(), "robot"), command.network,
                  domains_text(domains_), command.secure.empty() ? "" : ", secure");
  const LogFields where = {{"address", command.network}, {"domain", domains_.front()}};
  if (external)
    log.notice(serving, where);
  else
    log.info(serving, where);
}

Serving::~Serving() = default;

void Serving::start_controllers(const description::Experiment& experiment,
                                const std::vector<TeamController>& controllers) {
  std::vector<Children::Command> processes;
  if (command_.ros2)
    processes.push_back(ros2_bridge_process(experiment,
                                            description::select_robots(experiment.world, experiment.ros2.robots),
                                            command_.network, domains_.front(), command_.secure));
  if (command_.controllers != Controllers::external) {
    controllers_ = &controllers;
    tell_of_keyboard(experiment);
    std::ranges::move(
        controller_processes(without_ros2(experiment), controllers, command_.controllers == Controllers::per_robot,
                             domains_, command_.secure, log_),
        std::back_inserter(processes));
  }
  if (!processes.empty())
    children_ = std::make_unique<Children>(std::move(processes), listener_of_controllers(*server_, log_));
}

// Returns the experiment without the robots that ROS 2 nodes drive.
description::Experiment Serving::without_ros2(const description::Experiment& experiment) const {
  description::Experiment others = experiment;
  if (!command_.ros2) return others;
  const std::vector<std::uint32_t> theirs = description::select_robots(experiment.world, experiment.ros2.robots);
  for (description::Team& team : others.teams)
    std::erase_if(team.robots, [&](std::uint32_t robot) { return std::ranges::binary_search(theirs, robot); });
  return others;
}

void Serving::tell_of_keyboard(const description::Experiment& experiment) {
  for (const description::Team& team : experiment.teams)
    if (team.controller == keyboard_controller)
      log_.notice(fmt::format(
          "to drive team '{}', {}in another terminal: cohort teleop --robots {} --domain {}{}", team.name,
          command_.view && command_.view_controls ? "choose one of its robots in the browser and press 'drive'; or "
                                                  : "",
          selectors_of(team.robots), domains_.front(),
          command_.secure.empty() ? "" : " --secure " + identity_for(experiment, team, command_.secure).string()));
}

void Serving::start_view(const description::Experiment& experiment, const std::filesystem::path& recording,
                         const std::atomic<bool>& stop) {
  Children::Command view;
  view.arguments = {std::filesystem::read_symlink("/proc/self/exe"),
                    "view",
                    "--server",
                    command_.network,
                    "--domain",
                    std::to_string(domains_.front())};
  view.arguments.insert(view.arguments.end(), {"--while-watched", "--again", own_command_line()});
  if (!recording.empty()) view.arguments.insert(view.arguments.end(), {"--written", recording.string()});
  if (command_.view_port) view.arguments.insert(view.arguments.end(), {"--port", std::to_string(*command_.view_port)});
  if (command_.view_opens) view.arguments.emplace_back("--open");
  if (command_.view_opens && !command_.paused) view.arguments.emplace_back("--play-when-seen");
  if (command_.view_controls) view.arguments.push_back("--control");
  if (!command_.secure.empty()) add_identities_of_view(command_, experiment, view.arguments);
  view.name = "the view";
  view.restarts = false;
  view.is_controller = false;
  Children::Listener listener;
  listener.gave_up = [this](const std::string& text) {
    if (page_port_ != 0) return log_.warning(text + "; the run continues without it");
    view_failure_ = text;
    has_failed_view_ = true;
  };
  listener.wrote = [this](const Children::Command&, const std::string& line) { note_page(line); };
  listener.ended = [this](pid_t, int exit_code) {
    is_asked_again_ = exit_code == exit_run_again;
    has_view_ = false;
  };
  has_view_ = true;
  view_ = std::make_unique<Children>(std::vector{std::move(view)}, std::move(listener));
  constexpr std::chrono::milliseconds interval{10};
  while (!has_failed_view_ && page_port_ == 0 && !stop) std::this_thread::sleep_for(interval);
  if (has_failed_view_) throw std::runtime_error(view_failure_ + "; the run is not started");
}

// Passes a line of the view on, and reads the port of its page from it.
void Serving::note_page(const std::string& line) {
  std::fprintf(stderr, "%s\n", line.c_str());
  static const std::string scheme = "http://";
  const std::size_t colon = line.find(':', scheme.size());
  if (line.starts_with(scheme) && colon != std::string::npos) page_port_ = std::atoi(line.c_str() + colon + 1);
}

std::vector<std::string> Serving::command_line_to_run_again() const {
  if (!is_asked_again_) return {};
  std::vector<std::string> words = own_words();
  if (!command_.view_port) words.insert(words.end(), {"--port", std::to_string(page_port_)});
  return words;
}

void Serving::let_look(const std::atomic<bool>& stop) {
  constexpr std::chrono::seconds before_saying{3};
  constexpr std::chrono::milliseconds interval{50};
  using Clock = std::chrono::steady_clock;
  Clock::time_point say_at = Clock::now() + before_saying;
  for (; has_view_ && !stop; std::this_thread::sleep_for(interval)) {
    if (Clock::now() < say_at) continue;
    log_.notice("the run has ended; the view stays open until its pages are closed, or until Ctrl-C");
    say_at = Clock::time_point::max();
  }
}

// Starts processes for added robots, given by ascending ids.
void Serving::drive(const description::Experiment& experiment, const std::vector<std::uint32_t>& robots) {
  if (controllers_ == nullptr || robots.empty()) return;
  description::Experiment theirs = experiment;
  for (description::Team& team : theirs.teams)
    std::erase_if(team.robots, [&](std::uint32_t robot) { return !std::ranges::binary_search(robots, robot); });
  const bool per_robot = command_.controllers == Controllers::per_robot;
  newcomers_.push_back(std::make_unique<Children>(
      controller_processes(theirs, *controllers_, per_robot, domains_, command_.secure, log_),
      listener_of_controllers(*server_, log_)));
}

session::RunResult Serving::run(const description::Experiment& experiment, Simulation& simulation,
                                const session::RunOptions& options, const session::RunListener& listener,
                                const std::atomic<bool>& stop, bool is_last) {
  const auto spawned_since = [&](std::uint32_t first) {
    std::vector<std::uint32_t> robots;
    for (std::uint32_t robot = first; robot < simulation.robot_count(); ++robot)
      if (is_spawned(simulation.robot_name(robot), experiment)) robots.push_back(robot);
    return robots;
  };
  // Objects that events add exist when a step is done. A client that adds a robot later decides itself how it is
  // driven.
  std::uint32_t known = simulation.robot_count();
  session::RunListener with_newcomers = listener;
  with_newcomers.boundary = [&] {
    known = simulation.robot_count();
    if (listener.boundary) listener.boundary();
  };
  with_newcomers.stepped = [&] {
    try {
      drive(simulation.experiment(), spawned_since(known));
    } catch (const std::exception& error) {
      server_->fail(error.what());
    }
    if (listener.stepped) listener.stepped();
  };
  drive(simulation.experiment(), spawned_since(static_cast<std::uint32_t>(experiment.world.robots.size())));
  session::RunResult result = server_->run(experiment, simulation, options, with_newcomers, stop);
  for (const auto& each : newcomers_) each->stop_restarting();
  if (result.next || (!is_last && result.end == session::RunResult::End::finished)) {
    newcomers_.clear();  // the next world has none of their robots; `drive` starts processes for new ones
    return result;
  }
  if (view_) view_->stop_restarting();
  if (children_) children_->stop_restarting();
  server_->dismiss(result);
  if (children_) children_->let_finish();
  for (const auto& each : newcomers_) each->let_finish();
  newcomers_.clear();
  return result;
}

}  // namespace cohort::tool
