// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/ctl/ctl_options.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/core/angle.hpp"
#include "server/core/text.hpp"
#include "tools/cli/commands/ctl/ctl_errors.hpp"
#include "tools/cli/commands/ctl/ctl_spawn.hpp"
#include "tools/cli/common/wording.hpp"

namespace cohort::tool {
namespace {

constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();

// Parses numbers that are separated by spaces or commas.
std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  std::size_t at = 0;
  while ((at = text.find_first_not_of(" ,\t", at)) != std::string::npos) {
    const std::size_t end = std::min(text.find_first_of(" ,\t", at), text.size());
    const auto number = parse_real(text.substr(at, end - at));
    if (!number || !std::isfinite(*number)) throw UsageError("'" + text.substr(at, end - at) + "' is not a number");
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

// Parses a pose. Angles are those of SDF: roll about x, then pitch about y, then yaw about z, all axes of the world.
WorldPose pose_in(const std::string& text) {
  const std::vector<double> numbers = numbers_in(text);
  if (numbers.size() != 3 && numbers.size() != 6)
    throw UsageError("expected \"x y z\" or \"x y z roll pitch yaw\", not '" + text + "'");
  WorldPose pose;
  pose.position = {numbers[0], numbers[1], numbers[2]};
  if (numbers.size() == 3) return pose;
  if (!std::all_of(numbers.begin() + 3, numbers.end(), is_angle))
    throw UsageError(std::string("expected roll, pitch and yaw ") + angle_range + ", not '" + text + "'");
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

// A subcommand that is one request, and the variables that its options write.
template <class Asked>
struct RequestLine {
  CommandLine line;
  Asked& asked;
};

struct Nothing {};

// The subcommands that are one request each.
class Requests {
 public:
  // `command` must outlive the command line.
  Requests(CommandLine line, CtlCommand& command) : line_(std::move(line)), command_(command) {}

  // Adds a subcommand. `ask` takes the control and the parsed options, and returns the text to print.
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
  sub.add_option("NAME", entity, "Name of the object; the scope is needed only if several objects have the same name")
      .required()
      .type_name("");
}

Option add_vector(CommandLine sub, const std::string& name, Vector3& vector, const std::string& text) {
  return sub
      .add_option_function<std::string>(
          name, [&vector](const std::string& value) { vector = vector_in(value); }, text)
      .type_name("\"X Y Z\"");
}

void add_pose(CommandLine sub, WorldPose& pose) {
  sub.add_option_function<std::string>(
         "--pose", [&pose](const std::string& value) { pose = pose_in(value); }, "Pose in the world frame [m, rad]")
      .type_name("\"X Y Z [ROLL PITCH YAW]\"")
      .required();
}

void add_time_commands(Requests& requests) {
  requests.add<Nothing>("pause", "Pause the run at the next tick boundary",
                        [](Control& control, const Nothing&) { return control.pause(); });
  requests.add<Nothing>("resume", "Resume the run", [](Control& control, const Nothing&) { return control.play(); });
  auto [step, steps] =
      requests.add<std::uint64_t>("step", "Advance a paused run by N ticks, and return when they are done",
                                  [](Control& control, std::uint64_t count) { return control.step(count); });
  steps = 1;
  step.add_option("N", steps, "Number of ticks (default: 1)")
      .check(whole_number(1, std::uint64_t{1} << 62))
      .type_name("");
  auto [speed, set_speed] =
      requests.add<double>("speed", "Limit the real-time factor, the simulated seconds per second of wall time",
                           [](Control& control, double factor) { return control.set_speed(factor); });
  speed
      .add_option_function<std::string>(
          "X", [&set = set_speed](const std::string& text) { set = text == "max" ? 0.0 : *parse_real(text); },
          "Real-time factor, or max for no limit")
      .required()
      .check(max_or_number_above_zero(1e9))
      .type_name("");
  using Seed = std::optional<std::uint64_t>;
  auto [reset, to_reset] = requests.add<Seed>("reset", "Restart the run; controllers stay attached",
                                              [](Control& control, const Seed& seed) { return control.reset(seed); });
  reset
      .add_option_function<std::uint64_t>(
          "--seed", [&to = to_reset](const std::uint64_t& seed) { to = seed; }, "New seed (default: the same seed)")
      .check(whole_number(0, most))
      .type_name("N");
  auto [back, go_back] =
      requests.add<double>("back", "Return to the last kept snapshot at or before a simulated time",
                           [](Control& control, double seconds) { return control.back(nanoseconds(seconds)); });
  back.add_option("T", go_back, "Simulated time since the start of the run, in seconds")
      .required()
      .check(number_from_zero(most_seconds, "seconds"))
      .type_name("");
  requests.add<Nothing>("shutdown", "End the run and the server",
                        [](Control& control, const Nothing&) { return control.quit(); });
}

// Returns the scoped names that end in `name`: explorers/sbot_0 for sbot_0.
std::vector<std::string> names_ending_in(Control& control, const std::string& name) {
  std::vector<std::string> names = control.entities();
  std::erase_if(names, [&](const std::string& each) { return !each.ends_with("/" + name); });
  return names;
}

// Returns the scoped names of lights whose object's name ends in that of `light`: hall/lamp/bulb for lamp/bulb. Returns
// none if an object has the name as it is.
std::vector<std::string> lights_ending_in(Control& control, const std::string& light) {
  std::vector<std::string> lights;
  for (const std::string& object : control.entities())
    for (std::size_t end = light.size(); end != std::string::npos && end > 0; end = light.rfind('/', end - 1)) {
      const std::string_view wanted = std::string_view(light).substr(0, end);
      if (object == wanted) return {};
      if (object.ends_with("/" + std::string(wanted))) lights.push_back(object + light.substr(end));
    }
  return lights;
}

// Returns the only one of several full names that a short name can mean; throws std::invalid_argument.
const std::string& only_one_of(const std::vector<std::string>& names, const std::string& name,
                               const std::string& what) {
  if (names.size() > 1)
    throw std::invalid_argument("several " + what + " are called '" + name + "', such as '" + names[0] + "' and '" +
                                names[1] + "': give the name with its scope");
  return names.front();
}

// Sends a request about the object of this name, or about the only object whose scoped name ends in it.
template <class Ask>
ControlReply ask_of_object(Control& control, const std::string& name, Ask ask) {
  try {
    return ask(name);
  } catch (const ControlError& error) {
    if (error.result != ControlResult::not_found) throw;
    const std::vector<std::string> names = names_ending_in(control, name);
    if (names.empty()) throw;
    return ask(only_one_of(names, name, "objects"));
  }
}

// Sets a light of this name, or one of the only object whose scoped name ends in the object's part of it.
ControlReply set_light(Control& control, const std::string& light, const LightSetting& setting) {
  try {
    return control.set_light(light, setting);
  } catch (const ControlError& error) {
    if (!may_mean(error, ControlResult::light_not_found)) throw;
    const std::vector<std::string> lights = lights_ending_in(control, light);
    if (lights.empty()) throw;
    return control.set_light(only_one_of(lights, light, "lights"), setting);
  }
}

void add_spawn_commands(Requests& requests) {
  auto [spawn, to_spawn] = requests.add<Spawn>("spawn", "Add an object or a robot to the world", spawn_model);
  spawn
      .add_option(
          "MODEL", to_spawn.model,
          "Model file (.sdf, .urdf, .yaml), or the name of a model in the world or of a model installed with Cohort")
      .required()
      .type_name("");
  spawn.add_option("--name", to_spawn.name, "Name of the new object in the world").required().type_name("NAME");
  spawn.add_option("--team", to_spawn.team, "Team that the robot joins; needed only if several are possible")
      .type_name("NAME");
  spawn.add_flag("--rename", to_spawn.allow_renaming, "Choose another name if this name is taken");
  add_pose(spawn, to_spawn.pose);
  auto [remove, to_remove] = requests.add<std::string>(
      "remove", "Remove an object from the world", [](Control& control, const std::string& entity) {
        return ask_of_object(control, entity, [&](const std::string& name) { return control.remove(name); });
      });
  add_name(remove, to_remove);
}

void add_motion_commands(Requests& requests) {
  auto [pose, new_pose] = requests.add<EntityState>(
      "set-pose", "Move an object to a pose and stop it", [](Control& control, const auto& state) {
        return ask_of_object(control, state.entity,
                             [&](const std::string& name) { return control.set_pose(name, state.pose); });
      });
  add_name(pose, new_pose.entity);
  add_pose(pose, new_pose.pose);
  auto [velocity, new_twist] = requests.add<EntityState>(
      "set-velocity", "Set the velocity of an object", [](Control& control, const auto& state) {
        return ask_of_object(control, state.entity,
                             [&](const std::string& name) { return control.set_twist(name, state.twist); });
      });
  add_name(velocity, new_twist.entity);
  add_vector(velocity, "--linear", new_twist.twist.linear, "Linear velocity in the world frame [m/s]").required();
  add_vector(velocity, "--angular", new_twist.twist.angular, "Angular velocity in the world frame [rad/s]");
  struct Push {
    std::string entity;
    AppliedForce force;
  };
  auto [force, to_push] = requests.add<Push>(
      "apply-force", "Apply a force and a torque to an object", [](Control& control, const Push& push) {
        return ask_of_object(control, push.entity,
                             [&](const std::string& name) { return control.apply_force(name, push.force); });
      });
  AppliedForce& push = to_push.force;
  add_name(force, to_push.entity);
  add_vector(force, "--force", push.force, "Force at the centre of mass, in the world frame [N]");
  add_vector(force, "--torque", push.torque, "Torque in the world frame [N m]");
  force
      .add_option_function<double>(
          "--duration", [&push](const double& seconds) { push.duration = nanoseconds(seconds); },
          "Duration in simulated time, in seconds (default: one step)")
      .check(number_above_zero(most_seconds, "seconds"))
      .type_name("S");
  force.add_option("--link", push.link, "Link of the object (default: the root link)").type_name("LINK");
}

void add_light_command(Requests& requests) {
  struct Switched {
    std::string light;
    LightSetting setting;
  };
  auto [light, switched] = requests.add<Switched>(
      "set-light", "Switch a light on or off, or set its intensity and color",
      [](Control& control, const Switched& to) { return set_light(control, to.light, to.setting); });
  LightSetting& set = switched.setting;
  light
      .add_option("NAME", switched.light,
                  "Light (OBJECT/LIGHT), object (all of its lights) or light of the world; the scope is needed only if "
                  "several have the same name")
      .required()
      .type_name("");
  light
      .add_option_function<std::string>(
          "STATE", [&set](const std::string& state) { set.on = state == "on"; }, "on or off")
      .required()
      .check(one_of({"on", "off"}))
      .type_name("on|off");
  light
      .add_option_function<double>(
          "--intensity", [&set](const double& intensity) { set.intensity = intensity; },
          "Intensity of the light at 1 m")
      .type_name("X");
  light
      .add_option_function<std::string>(
          "--color",
          [&set](const std::string& value) {
            const Vector3 color = vector_in(value);
            set.color = Color{color.x, color.y, color.z};
          },
          "Red, green and blue, each from 0 to 1")
      .type_name("\"X Y Z\"");
}

}  // namespace

void add_ctl_options(CommandLine line, CtlCommand& command) {
  add_domain_option(line, command.connection.domains, domain_of_server);
  add_secure_option(line, command.connection.secure,
                    "Folder of an identity that may control the run (default: $COHORT_SECURE)");
  line.require_subcommand();
  line.fallthrough();
  add_server_option(line, command.connection.server);
  line.add_option(
          "--timeout", command.timeout,
          "Time limit in seconds (default: 5 to find the server, 30 for a reply, none for step, reset, back and load)")
      .check(number_above_zero(9e6, "seconds"))
      .type_name("S");
  Requests requests(line, command);
  add_time_commands(requests);
  add_spawn_commands(requests);
  add_motion_commands(requests);
  add_light_command(requests);

  const auto add_file = [&](const std::string& name, const std::string& text, CtlCommand::What what) {
    CommandLine sub = line.add_subcommand(name, text);
    sub.add_option("FILE", command.file, "Snapshot file").required().type_name("");
    sub.callback([&command, what] { command.what = what; });
  };
  add_file("save", "Save a snapshot of the run to a file", CtlCommand::What::save);
  add_file("load", "Load a snapshot and continue the run from it", CtlCommand::What::load);
  CommandLine status = line.add_subcommand("status", "Show the state of the run and the controllers that it waits for");
  status.add_flag("--watch", command.watch, "Update the status twice a second");
  status.add_flag("--json", command.json, "Print JSON; with --watch, one object per line");
  status.callback([&] { command.what = CtlCommand::What::status; });
  CommandLine history =
      line.add_subcommand("history", "Show the events of the run and the snapshots to which it can return");
  history.add_flag("--json", command.json, "Print JSON");
  history.callback([&] { command.what = CtlCommand::What::history; });
  auto [entities, filter] = requests.add<std::string>(
      "entities", "List the objects in the world",
      [](Control& control, const std::string& expression) { return control.entities(expression); });
  entities.add_option("FILTER", filter, "POSIX extended regular expression: list only names that contain a match")
      .type_name("");
  line.footer(
      "Examples: cohort ctl step 10\n"
      "          cohort ctl spawn post --name post_1 --pose \"1.6 0 0\"\n"
      "          cohort ctl --server 10.0.0.5 --domain 7 status --watch");
}

}  // namespace cohort::tool
