#include "tools/cohort/commands/ctl/ctl_options.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/core/text.hpp"
#include "tools/cohort/cli/wording.hpp"

namespace cohort::tool {
namespace {

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

Vector3 vector_in(const std::string& text) {
  const std::vector<double> numbers = numbers_in(text);
  if (numbers.size() != 3) throw UsageError("expected three numbers, \"x y z\", not '" + text + "'");
  return {numbers[0], numbers[1], numbers[2]};
}

// As in SDF: roll about x, then pitch about y, then yaw about z, all of the world.
WorldPose pose_in(const std::string& text) {
  const std::vector<double> numbers = numbers_in(text);
  if (numbers.size() != 3 && numbers.size() != 6)
    throw UsageError("expected \"x y z\" or \"x y z roll pitch yaw\", not '" + text + "'");
  WorldPose pose;
  pose.position = {numbers[0], numbers[1], numbers[2]};
  if (numbers.size() == 3) return pose;
  const double cr = std::cos(numbers[3] / 2), sr = std::sin(numbers[3] / 2);
  const double cp = std::cos(numbers[4] / 2), sp = std::sin(numbers[4] / 2);
  const double cy = std::cos(numbers[5] / 2), sy = std::sin(numbers[5] / 2);
  pose.orientation = {sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
                      cr * cp * cy + sr * sp * sy};
  return pose;
}

std::string printed(const ControlReply& reply) { return reply.message + "\n"; }
std::string printed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += name + "\n";
  return text;
}

// A subcommand that is one request, and what its options fill in.
template <class Asked>
struct RequestLine {
  CommandLine line;
  Asked& asked;
};

struct Nothing {};

// Subcommands that are one request.
class Requests {
 public:
  // `command` must outlive the command line.
  Requests(CommandLine line, CtlCommand& command) : line_(std::move(line)), command_(command) {}

  // `ask` takes the control and what was asked for, and returns what is printed.
  template <class Asked, class Ask>
  RequestLine<Asked> add(const std::string& name, const std::string& text, Ask ask) {
    const auto asked = std::make_shared<Asked>();
    CommandLine sub = line_.add_subcommand(name, text);
    sub.callback([&command = command_, asked, ask] {
      command.request = [asked, ask](Control& control) { return printed(ask(control, *asked)); };
    });
    return {sub, *asked};
  }

 private:
  CommandLine line_;
  CtlCommand& command_;
};

void add_name(CommandLine sub, std::string& entity) {
  sub.add_option("NAME", entity, "Of an object, with its scope").required().type_name("");
}

Option add_vector(CommandLine sub, const std::string& name, Vector3& vector, const std::string& text) {
  return sub
      .add_option_function<std::string>(
          name, [&vector](const std::string& value) { vector = vector_in(value); }, text)
      .type_name("\"X Y Z\"");
}

void add_pose(CommandLine sub, WorldPose& pose) {
  sub.add_option_function<std::string>(
         "--pose", [&pose](const std::string& value) { pose = pose_in(value); }, "Metres and radians, in the world")
      .type_name("\"X Y Z [ROLL PITCH YAW]\"")
      .required();
}

void add_time_commands(Requests& requests) {
  requests.add<Nothing>("pause", "Hold the run at the next boundary",
                        [](Control& control, const Nothing&) { return control.pause(); });
  requests.add<Nothing>("resume", "Let it go on", [](Control& control, const Nothing&) { return control.play(); });
  auto [step, steps] =
      requests.add<std::uint64_t>("step", "Let a paused run make so many ticks, and wait for them",
                                  [](Control& control, std::uint64_t count) { return control.step(count); });
  steps = 1;
  step.add_option("N", steps, "How many; 1 if it is not said")
      .check(whole_number(1, std::uint64_t{1} << 62))
      .type_name("");
  auto [speed, set_speed] =
      requests.add<double>("speed", "Simulated seconds per second at the most",
                           [](Control& control, double factor) { return control.set_speed(factor); });
  speed
      .add_option_function<std::string>(
          "X", [&set = set_speed](const std::string& text) { set = text == "max" ? 0.0 : *parse_real(text); },
          "max, or a number")
      .required()
      .check(max_or_number_above_zero(1e9))
      .type_name("");
  using Seed = std::optional<std::uint64_t>;
  auto [reset, to_reset] = requests.add<Seed>("reset", "Begin anew, the controllers attached",
                                              [](Control& control, const Seed& seed) { return control.reset(seed); });
  reset
      .add_option_function<std::uint64_t>(
          "--seed", [&to = to_reset](const std::uint64_t& seed) { to = seed; }, "Another seed")
      .check(whole_number(0, most))
      .type_name("N");
  auto [back, go_back] =
      requests.add<double>("back", "Go back to the last kept snapshot at or before a time",
                           [](Control& control, double seconds) { return control.back(nanoseconds(seconds)); });
  back.add_option("T", go_back, "Simulated seconds from the run's beginning")
      .required()
      .check(number_from_zero(most_seconds))
      .type_name("");
  requests.add<Nothing>("shutdown", "End the run and the server",
                        [](Control& control, const Nothing&) { return control.quit(); });
}

// Reads the file of that name, if there is one; else a model of the world is meant.
void take_model(Spawn& spawn) {
  if (!std::filesystem::is_regular_file(spawn.model)) return;
  const std::vector<char> text = read_file(spawn.model);
  spawn.text.assign(text.begin(), text.end());
  spawn.model.clear();
}

void add_spawn_commands(Requests& requests) {
  auto [spawn, to_spawn] =
      requests.add<Spawn>("spawn", "Add an object or a robot to the world", [](Control& control, Spawn what) {
        take_model(what);
        control.spawn(what);
        return control.last_reply();
      });
  spawn.add_option("MODEL", to_spawn.model, "A model of the world, or a file with one (.sdf, .urdf, .yaml)")
      .required()
      .type_name("");
  spawn.add_option("--name", to_spawn.name, "Its name in the world").required().type_name("NAME");
  spawn.add_option("--team", to_spawn.team, "That a robot joins, where several could be meant").type_name("NAME");
  spawn.add_flag("--rename", to_spawn.allow_renaming, "Take another name where this one is taken");
  add_pose(spawn, to_spawn.pose);
  auto [remove, to_remove] =
      requests.add<std::string>("remove", "Take an object out of the world",
                                [](Control& control, const std::string& entity) { return control.remove(entity); });
  add_name(remove, to_remove);
}

void add_motion_commands(Requests& requests) {
  auto [pose, new_pose] = requests.add<EntityState>(
      "set-pose", "Put an object elsewhere, at rest",
      [](Control& control, const auto& state) { return control.set_pose(state.entity, state.pose); });
  add_name(pose, new_pose.entity);
  add_pose(pose, new_pose.pose);
  auto [velocity, new_twist] = requests.add<EntityState>(
      "set-velocity", "Give an object a velocity",
      [](Control& control, const auto& state) { return control.set_twist(state.entity, state.twist); });
  add_name(velocity, new_twist.entity);
  add_vector(velocity, "--linear", new_twist.twist.linear, "Metres per second, in the world").required();
  add_vector(velocity, "--angular", new_twist.twist.angular, "Radians per second, in the world");
  struct Push {
    std::string entity;
    AppliedForce force;
  };
  auto [force, to_push] = requests.add<Push>(
      "apply-force", "Push an object for a while",
      [](Control& control, const Push& push) { return control.apply_force(push.entity, push.force); });
  AppliedForce& push = to_push.force;
  add_name(force, to_push.entity);
  add_vector(force, "--force", push.force, "Newtons, in the world");
  add_vector(force, "--torque", push.torque, "Newton metres, in the world");
  force
      .add_option_function<double>(
          "--duration", [&push](const double& seconds) { push.duration = nanoseconds(seconds); },
          "Simulated seconds (default: one step)")
      .check(number_above_zero(9e9))
      .type_name("S");
  force.add_option("--link", push.link, "Of the object (default: its root)").type_name("LINK");
}

void add_light_command(Requests& requests) {
  struct Switched {
    std::string light;
    LightSetting setting;
  };
  auto [light, switched] = requests.add<Switched>(
      "set-light", "Switch a light",
      [](Control& control, const Switched& to) { return control.set_light(to.light, to.setting); });
  LightSetting& set = switched.setting;
  add_name(light, switched.light);
  light
      .add_option_function<std::string>(
          "STATE", [&set](const std::string& state) { set.on = state == "on"; }, "on or off")
      .required()
      .check(one_of({"on", "off"}))
      .type_name("on|off");
  light
      .add_option_function<double>(
          "--intensity", [&set](const double& intensity) { set.intensity = intensity; }, "Its intensity")
      .type_name("X");
  light
      .add_option_function<std::string>(
          "--color",
          [&set](const std::string& value) {
            const Vector3 color = vector_in(value);
            set.color = Color{color.x, color.y, color.z};
          },
          "Red, green and blue from 0 to 1")
      .type_name("\"X Y Z\"");
}

}  // namespace

std::vector<char> read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<char> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.is_open() || in.bad()) throw std::runtime_error("cannot read " + file.string());
  return bytes;
}

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
  Requests requests(line, command);
  add_time_commands(requests);
  add_spawn_commands(requests);
  add_motion_commands(requests);
  add_light_command(requests);

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
  auto [entities, filter] = requests.add<std::string>(
      "entities", "List what is in the world",
      [](Control& control, const std::string& expression) { return control.entities(expression); });
  entities.add_option("FILTER", filter, "POSIX extended regular expression").type_name("");
  line.footer(
      "Examples: cohort ctl pause; cohort ctl step 10; cohort ctl spawn box --name crate_1 --pose \"1 0 0.1\";\n"
      "cohort ctl --server 10.0.0.5 --domain 7 status --watch");
}

}  // namespace cohort::tool
