#include "tools/cohort/commands/ctl/ctl_options.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "server/core/text.hpp"
#include "tools/cohort/cli/wording.hpp"

namespace cohort::tool {
namespace {

using wire::Operation;
using wire::SimulationState;

constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();

// Numbers with spaces or commas between.
std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  std::size_t at = 0;
  while ((at = text.find_first_not_of(" ,\t", at)) != std::string::npos) {
    const std::size_t end = std::min(text.find_first_of(" ,\t", at), text.size());
    const auto number = parse_real(text.substr(at, end - at));
    if (!number || !std::isfinite(*number)) throw UsageError("'" + text.substr(at, end - at) + "' is no number");
    numbers.push_back(*number);
    at = end;
  }
  return numbers;
}

wire::Vector3 vector_in(const std::string& text) {
  const std::vector<double> numbers = numbers_in(text);
  if (numbers.size() != 3) throw UsageError("expected three numbers, \"x y z\", not '" + text + "'");
  return {numbers[0], numbers[1], numbers[2]};
}

// As in SDF: roll about x, then pitch about y, then yaw about z, all of the world.
wire::Pose pose_in(const std::string& text) {
  const std::vector<double> numbers = numbers_in(text);
  if (numbers.size() != 3 && numbers.size() != 6)
    throw UsageError("expected \"x y z\" or \"x y z roll pitch yaw\", not '" + text + "'");
  wire::Pose pose;
  pose.position = {numbers[0], numbers[1], numbers[2]};
  if (numbers.size() == 3) return pose;
  const double cr = std::cos(numbers[3] / 2), sr = std::sin(numbers[3] / 2);
  const double cp = std::cos(numbers[4] / 2), sp = std::sin(numbers[4] / 2);
  const double cy = std::cos(numbers[5] / 2), sy = std::sin(numbers[5] / 2);
  pose.orientation = {sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
                      cr * cp * cy + sr * sp * sy};
  return pose;
}

// Subcommands that are one request.
class Requests {
 public:
  // `request` must outlive the command line.
  Requests(CommandLine line, wire::Request& request) : line_(std::move(line)), request_(request) {}

  CommandLine add(const std::string& name, const std::string& text, Operation operation,
                  SimulationState state = SimulationState::stopped) {
    CommandLine sub = line_.add_subcommand(name, text);
    sub.callback([&request = request_, operation, state] {
      request.operation = operation;
      request.state = state;
    });
    return sub;
  }
  void add_name(CommandLine sub) {
    sub.add_option("NAME", request_.entity, "Of an object, with its scope").required().type_name("");
  }
  Option add_vector(CommandLine sub, const std::string& name, wire::Vector3& vector, const std::string& text) {
    return sub
        .add_option_function<std::string>(
            name, [&vector](const std::string& value) { vector = vector_in(value); }, text)
        .type_name("\"X Y Z\"");
  }
  Option add_pose(CommandLine sub) {
    return sub
        .add_option_function<std::string>(
            "--pose",
            [&request = request_](const std::string& value) {
              request.pose = pose_in(value);
              request.set_pose = true;
            },
            "Metres and radians, in the world")
        .type_name("\"X Y Z [ROLL PITCH YAW]\"");
  }

 private:
  CommandLine line_;
  wire::Request& request_;
};

void add_time_commands(Requests& requests, CtlCommand& command) {
  requests.add("pause", "Hold the run at the next boundary", Operation::set_simulation_state, SimulationState::paused);
  requests.add("resume", "Let it go on", Operation::set_simulation_state, SimulationState::playing);
  CommandLine step =
      requests.add("step", "Let a paused run make so many ticks, and wait for them", Operation::step_simulation);
  command.request.steps = 1;
  step.add_option("N", command.request.steps, "How many; 1 if it is not said")
      .check(whole_number(1, std::uint64_t{1} << 62))
      .type_name("");
  CommandLine speed = requests.add("speed", "Simulated seconds per second at the most", Operation::set_speed);
  speed
      .add_option_function<std::string>(
          "X", [&](const std::string& text) { command.request.speed = text == "max" ? 0.0 : *parse_real(text); },
          "max, or a number")
      .required()
      .check(max_or_number_above_zero(1e9))
      .type_name("");
  CommandLine reset = requests.add("reset", "Begin anew, the controllers attached", Operation::reset_simulation);
  reset
      .add_option_function<std::uint64_t>(
          "--seed",
          [&](const std::uint64_t& seed) {
            command.request.set_seed = true;
            command.request.seed = seed;
          },
          "Another seed")
      .check(whole_number(0, most))
      .type_name("N");
  CommandLine back = requests.add("back", "Go back to the last kept snapshot at or before a time", Operation::go_back);
  back.add_option_function<double>(
          "T", [&](const double& seconds) { command.request.duration_ns = nanoseconds(seconds).count(); },
          "Simulated seconds from the run's beginning")
      .required()
      .check(number_from_zero(most_seconds))
      .type_name("");
  requests.add("shutdown", "End the run and the server", Operation::set_simulation_state, SimulationState::quitting);
}

void add_world_commands(Requests& requests, CtlCommand& command) {
  wire::Request& request = command.request;
  CommandLine spawn = requests.add("spawn", "Add an object or a robot to the world", Operation::spawn_entity);
  spawn.add_option("MODEL", command.model, "A model of the world, or a file with one (.sdf, .urdf, .yaml)")
      .required()
      .type_name("");
  spawn.add_option("--name", request.entity, "Its name in the world").required().type_name("NAME");
  spawn.add_option("--team", request.filter, "That a robot joins, where several could be meant").type_name("NAME");
  spawn.add_flag("--rename", request.allow_renaming, "Take another name where this one is taken");
  requests.add_pose(spawn).required();
  CommandLine remove = requests.add("remove", "Take an object out of the world", Operation::delete_entity);
  requests.add_name(remove);
  CommandLine pose = requests.add("set-pose", "Put an object elsewhere, at rest", Operation::set_entity_state);
  requests.add_name(pose);
  requests.add_pose(pose).required();
  CommandLine velocity = requests.add("set-velocity", "Give an object a velocity", Operation::set_entity_state);
  requests.add_name(velocity);
  const auto twist_is_set = [&request](const std::string&) { request.set_twist = true; };
  requests.add_vector(velocity, "--linear", request.twist.linear, "Metres per second, in the world")
      .required()
      .each(twist_is_set);
  requests.add_vector(velocity, "--angular", request.twist.angular, "Radians per second, in the world");
  CommandLine light = requests.add("set-light", "Switch a light", Operation::set_light);
  requests.add_name(light);
  light
      .add_option_function<std::string>(
          "STATE", [&](const std::string& state) { request.on = state == "on"; }, "on or off")
      .required()
      .check(one_of({"on", "off"}))
      .type_name("on|off");
  light
      .add_option_function<double>(
          "--intensity",
          [&](const double& intensity) {
            request.set_intensity = true;
            request.intensity = intensity;
          },
          "Its intensity")
      .type_name("X");
  requests.add_vector(light, "--color", request.color, "Red, green and blue from 0 to 1").each([&request](const auto&) {
    request.set_color = true;
  });
  CommandLine force = requests.add("apply-force", "Push an object for a while", Operation::apply_force);
  requests.add_name(force);
  requests.add_vector(force, "--force", request.force, "Newtons, in the world");
  requests.add_vector(force, "--torque", request.torque, "Newton metres, in the world");
  force
      .add_option_function<double>(
          "--duration", [&](const double& seconds) { request.duration_ns = std::llround(seconds * 1e9); },
          "Simulated seconds (default: one step)")
      .check(number_above_zero(9e9))
      .type_name("S");
  force.add_option("--link", request.link, "Of the object (default: its root)").type_name("LINK");
}

}  // namespace

void add_ctl_options(CommandLine line, CtlCommand& command) {
  add_domain_option(line, command.connection.domains, domain_of_server);
  add_secure_option(line, command.connection.secure,
                    "Folder of an identity that may control (default: $COHORT_SECURE)");
  line.require_subcommand();
  line.fallthrough();
  add_server_option(line, command.connection.server);
  line.add_option("--timeout", command.timeout,
                  "Seconds to wait (default: 5 for a server, 30 for what is asked, no end for step, reset and load)")
      .check(number_above_zero(9e6))
      .type_name("S");
  Requests requests(line, command.request);
  add_time_commands(requests, command);
  add_world_commands(requests, command);

  const auto add_file = [&](const std::string& name, const std::string& text, CtlCommand::What what) {
    CommandLine sub = line.add_subcommand(name, text);
    sub.add_option("FILE", command.file, "Of the snapshot").required().type_name("");
    sub.callback([&command, what] { command.what = what; });
  };
  add_file("save", "Write a snapshot of the run to a file", CtlCommand::What::save);
  add_file("load", "Let the run go on from a snapshot", CtlCommand::What::load);
  CommandLine status = line.add_subcommand("status", "Say how the run is, and who is awaited");
  status.add_flag("--watch", command.watch, "Again and again, twice a second");
  status.add_flag("--json", command.json, "As JSON; with --watch an object on each line");
  status.callback([&] { command.what = CtlCommand::What::status; });
  CommandLine history = line.add_subcommand("history", "Say what has happened, and how far back the run can go");
  history.add_flag("--json", command.json, "As JSON");
  history.callback([&] { command.what = CtlCommand::What::history; });
  CommandLine entities = line.add_subcommand("entities", "List what is in the world");
  entities.add_option("FILTER", command.request.filter, "POSIX extended regular expression").type_name("");
  entities.callback([&] { command.what = CtlCommand::What::entities; });
  line.footer(
      "Examples: cohort ctl pause; cohort ctl step 10; cohort ctl spawn box --name crate_1 --pose \"1 0 0.1\";\n"
      "cohort ctl --server 10.0.0.5 --domain 7 status --watch");
}

}  // namespace cohort::tool
