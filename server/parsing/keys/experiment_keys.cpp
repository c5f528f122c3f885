// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/keys/experiment_keys.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "server/parsing/keys/choices.hpp"

namespace cohort::parsing {
namespace {
namespace of_experiments {

using enum ExtensionValue;

constexpr ExtensionKey experiment[] = {
    {"world", uri, "", "", "path of the world file, relative to this file"},
    {"duration", positive, "s", "", "maximum simulated time of the run"},
    {"seed", whole, "", "1",
     "seed of all random numbers, such as those of placement and noise: a whole number of at most 64 bits"},
    {"step", positive, "s", "the world's", "simulated time of a tick"},
    {"threads", count, "1", "number of cores", "number of threads that step the world; results do not depend on it"},
    {"physics", group, "", "the world's",
     "map with keys of [`<cohort:physics>`](physics.md#cohortphysics-in-world), which override those of the world"},
    {"teams", group, "", "", "list of teams; every robot of the world must be in exactly one team"},
    {"events", group, "", no_value, "list of events, each at a given time or when a robot performs an action"},
    {"stop", group, "", no_value, "list of conditions; the run ends when one of them is met"},
    {"print", group, "", no_value, "list of quantities that `cohort run` prints"},
    {"history", group, "", no_value, "objects whose most recent poses are kept"},
    {"record", group, "", "defaults", "contents of a recording, if the run is recorded"},
    {"ros2", group, "", "defaults",
     "ROS 2 interface of the robots; used by `cohort-ros2-bridge`, ignored by the server"},
};

constexpr std::string_view modes[] = {"lockstep", "free"};
constexpr std::string_view restarts[] = {"on_failure", "never"};
constexpr std::string_view losses[] = {"go_on", "rewind"};

constexpr ExtensionKey team[] = {
    {"name", name, "", "", "unique name of the team"},
    {"robots", name, "", "", "robots of the team: a selector or a list of selectors", true},
    {"controller", name, "", "",
     "name of a controller, or path to a plugin (`….so`) or Python file (`….py`), relative to this file"},
    {"parameters", group, "", no_value, "map of parameters for the controller; see below"},
    {"period", count, "ticks", "1", "number of ticks from one observation to the next"},
    {"phase", whole, "ticks", "0", "tick of the first observation; less than the period"},
    {"delay", whole, "ticks", "0",
     "number of ticks by which commands are delayed: the command for tick k takes effect at tick k + delay"},
    {"mode", choice, "", "lockstep",
     "`lockstep` if the run can wait for commands, or `free` if it never waits, for hardware and human operators; see "
     "below",
     false, modes},
    {"on_late", choice, "", "wait",
     "response to a late command: `wait`, `hold`, `zero`, `detach` or `stop`; default `hold` with `mode: free`", false,
     late_policies},
    {"deadline", positive, "s", no_value,
     "wall time to wait for a command (with `mode: free`, since the last command); required unless `on_late` is "
     "`wait`, which does not allow it"},
    {"required", flag, "", "true",
     "`true` if the run waits for a controller to attach, at the start and after one is lost; default `false` with "
     "`mode: free`"},
    {"on_lost", choice, "", "go_on",
     "response when a new process replaces a lost controller. `go_on`: continue without the state of the lost "
     "controller. `rewind`: return to the last snapshot, so that the results are those of an undisturbed run; requires "
     "`--keep-snapshots`",
     false, losses},
    {"restart", choice, "", "on_failure",
     "response when a controller process of `cohort run` exits: restart it up to three times (`on_failure`), or end "
     "the run (`never`)",
     false, restarts},
};

constexpr ExtensionKey add[] = {
    {"model", uri, "", "", "`model://NAME`, or a path relative to the world file"},
    {"name", name, "", "", "unique name of the object; may be scoped, as in `team/late_1`"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "pose in the world frame"},
};
constexpr ExtensionKey spawn[] = {
    {"model", uri, "", "", "`model://NAME`, or a path relative to the world file"},
    {"name", name, "", "", "prefix of the names: `team/late` gives `team/late_1`, `team/late_2` …"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "pose in the world frame"},
    {"area", point, "m", "0 0",
     "size of a rectangle centred on the pose; the x and y of each object are drawn at random in it"},
    {"team", name, "", no_value, "team of the new robots; required if there are several teams"},
    {"every", positive, "s", no_value, "repetition interval of an event with `at`; no repetition if absent"},
    {"most", count, "1", "100", "maximum number of objects that the event creates in a run"},
};
constexpr ExtensionKey objects_only[] = {
    {"objects", name, "", "", "name or list of names of objects; `*` matches any characters", true},
};
constexpr ExtensionKey move[] = {
    {"objects", name, "", "", "name or list of names of objects; `*` matches any characters", true},
    {"pose", pose, "m, rad", "", "new pose of the model in the world frame"},
};
constexpr ExtensionKey set_velocity[] = {
    {"objects", name, "", "", "name or list of names of objects; `*` matches any characters", true},
    {"linear", vector, "m/s", "0 0 0", "velocity of the origin of the root link, in the world frame"},
    {"angular", vector, "rad/s", "0 0 0", "angular velocity of the root link, in the world frame"},
};
constexpr ExtensionKey apply_force[] = {
    {"objects", name, "", "", "name or list of names of objects; `*` matches any characters", true},
    {"link", name, "", no_value, "name of the link; the root link if absent"},
    {"force", vector, "N", "0 0 0", "force at the centre of mass of the link, in the world frame"},
    {"torque", vector, "N m", "0 0 0", "torque in the world frame"},
    {"for", positive, "s", "", "duration of the force and torque"},
};

constexpr ExtensionKey set_emitter[] = {
    {"objects", name, "", "", "name or list of names of objects; `*` matches any characters", true},
    {"emitter", name, "", "*", "name or list of names of these objects' emitters; `*` matches any characters", true},
    {"on", flag, "", no_value, "`true` switches the emitter on, `false` switches it off"},
    {"intensity", non_negative, "1", no_value, "intensity of a light or a sound at 1 m"},
    {"frequency", positive, "Hz", no_value, "frequency of a sound"},
    {"color", vector, "1", no_value, "colour of a light or a marker: red, green and blue, from 0 to 1"},
    {"temperature", real, "K", no_value, "temperature added at the centre of a climate source"},
    {"humidity", real, "1", no_value, "relative humidity added at the centre of a climate source"},
};
constexpr ExtensionKey on[] = {
    {"action", name, "", "", "name of a `cohort:action`"},
    {"robots", name, "", "all", "robots that can trigger the event: a selector or a list of selectors", true},
};

constexpr ExtensionKey inside[] = {
    {"objects", name, "", "", "name or list of names of objects; `*` matches any characters", true},
    {"min", point, "m", "", "minimum x and y of the rectangle"},
    {"max", point, "m", "", "maximum x and y of the rectangle"},
    {"for", non_negative, "s", "0", "time for which the condition must hold"},
};
constexpr ExtensionKey beyond[] = {
    {"objects", name, "", "", "name or list of names of objects; `*` matches any characters", true},
    {"point", point, "m", "", "any point on the line"},
    {"direction", point, "1", "", "direction perpendicular to the line; it points to the side that is beyond the line"},
    {"for", non_negative, "s", "0", "time for which the condition must hold"},
};
constexpr ExtensionKey at_rest[] = {
    {"objects", name, "", "*", "name or list of names of objects; `*` matches any characters", true},
    {"speed", positive, "m/s", "0.001", "speed below which an object is at rest"},
    {"turn_rate", positive, "rad/s", "0.01", "angular speed below which an object is at rest"},
    {"for", non_negative, "s", "1", "time for which the condition must hold"},
};
constexpr ExtensionKey quarantined[] = {
    {"objects", name, "", "*", "name or list of names of objects; `*` matches any characters", true},
};

constexpr ExtensionKey print[] = {
    {"quantity", choice, "", "",
     "printed quantity: `position`, `pose`, `heading`, `velocity`, `count`, `quarantined`, `joint_force` or "
     "`joint_torque`",
     false, quantities},
    {"objects", name, "", "*", "name or list of names of objects; `*` matches any characters", true},
    {"joints", name, "", "*",
     "name or list of names of breakable joints, for `joint_force` and `joint_torque`; `*` matches any characters",
     true},
    {"every", positive, "s", "1", "interval of simulated time, rounded to whole ticks"},
};

constexpr ExtensionKey history[] = {
    {"objects", name, "", "*", "name or list of names of objects; `*` matches any characters", true},
    {"length", count, "1", "", "number of most recent poses kept for each object"},
    {"every", positive, "s", no_value, "interval of simulated time, rounded to whole ticks; one tick if absent"},
};

constexpr ExtensionKey record[] = {
    {"poses", non_negative, "Hz", "10",
     "rate at which the poses of all objects that can move are recorded; 0 for none"},
    {"joints", non_negative, "Hz", "0",
     "rate at which the states of all joints and the poses of all links are recorded; 0 for none"},
    {"observations", non_negative, "Hz", "0",
     "maximum rate at which robots' observations are recorded, limited by the rate at which their controllers receive "
     "them; 0 for none"},
    {"robots", name, "", "all", "robots whose observations are recorded: a selector or a list of selectors", true},
    {"snapshots", non_negative, "s", "30", "interval between snapshots of the world; 0 for none"},
};

constexpr ExtensionKey ros2[] = {
    {"domain", whole, "", no_value,
     "ROS domain, from 0 to 232; if absent, the environment variable `ROS_DOMAIN_ID`, or 0 if that is not set"},
    {"robots", name, "", "all", "robots that are visible in ROS: a selector or a list of selectors", true},
    {"teams", group, "", no_value,
     "map from names of teams to maps with the keys from `sync` on, which override the keys for all robots"},
    {"sync", choice, "", "free",
     "when the bridge answers observations: immediately, with the newest command (`free`), after a command for their "
     "tick (`command`), or once all nodes wait for the next clock time (`idle`)",
     false, ros_syncs},
    {"wait", positive, "s", no_value, "maximum wall time to wait for the nodes at each tick; unlimited if absent"},
    {"on_silence", choice, "", "wait",
     "response when that time has passed: keep waiting (`wait`), repeat the last command (`hold`) or stand still "
     "(`stand`); `hold` and `stand` require the key `wait`",
     false, ros_silences},
    {"reply_to", name, "", no_value,
     "topic to which each command is a reply, such as `scan`; if absent, the least frequent topic to which the "
     "commanding node subscribes"},
    {"namespace", name, "", no_value,
     "namespace of the topics of a single robot, such as `/`; if absent, `/` and the scoped name of the robot"},
    {"frames", name, "", no_value, "prefix of frame names, such as `left/`; none if absent"},
    {"odometry", choice, "", "encoders",
     "source of `odom`: the wheel encoders (`encoders`), or the true pose of the robot (`truth`)", false,
     ros_odometries},
    {"base_frame", name, "", "base_link", "name of the frame of the root link"},
    {"topics", group, "", no_value,
     "map from topic names, such as `scan`, to `false`, which omits the topic, or to a map with its settings; `*` "
     "matches any characters, and the last matching name applies"},
    {"drive", group, "", no_value,
     "wheels that `cmd_vel` drives, if the model has neither a drive nor wheels with velocity motors"},
};
constexpr std::span<const ExtensionKey> ros2_of_a_team = std::span(ros2).subspan(3);
constexpr ExtensionKey topics[] = {
    {"name", name, "", no_value,
     "topic name in ROS, absolute, as in `/scan`, or relative to the robot's namespace; unchanged if absent"},
    {"rate", positive, "Hz", no_value, "maximum publishing rate; if absent, every new value is published"},
};
constexpr ExtensionKey drive[] = {
    {"left", name, "", "", "command channels for the angular velocities of the left wheels", true},
    {"right", name, "", "", "command channels for the angular velocities of the right wheels", true},
    {"wheel_radius", positive, "m", "", "radius of each wheel"},
    {"wheel_separation", positive, "m", "", "distance between the left and the right wheels"},
};

constexpr Extension table[] = {
    {"experiment", "", false, "A world, a seed, a duration, and teams of robots with their controllers.", experiment,
     "experiment"},
    {"teams", "experiment", false, "Robots that share a controller.", team, "experiment"},
    {"add", "events", false, "Adds an object or a robot to the world.", add, "events"},
    {"spawn", "events", false, "Adds a new object or robot to the world each time the event occurs.", spawn, "events"},
    {"remove", "events", false, "Removes objects from the world permanently.", objects_only, "events"},
    {"disable", "events", false, "Removes objects from the world temporarily; `enable` restores them unchanged.",
     objects_only, "events"},
    {"enable", "events", false, "Restores disabled objects.", objects_only, "events"},
    {"move", "events", false, "Moves objects to a pose and stops them; joint positions stay unchanged.", move,
     "events"},
    {"set_velocity", "events", false, "Sets the velocity of objects.", set_velocity, "events"},
    {"apply_force", "events", false, "Applies a force and a torque to objects for a given time.", apply_force,
     "events"},
    {"set_emitter", "events", false, "Switches emitters of objects or changes their properties.", set_emitter,
     "events"},
    {"on", "an event", false, "The robot action that triggers the event, instead of a time.", on, "events"},
    {"inside", "stop", false, "The condition that all of the objects are inside a rectangle.", inside, "stop"},
    {"beyond", "stop", false, "The condition that one of the objects is beyond a line.", beyond, "stop"},
    {"at_rest", "stop", false, "The condition that all of the objects are at rest.", at_rest, "stop"},
    {"quarantined", "stop", false, "The condition that one of the objects has an invalid state or has left the world.",
     quarantined, "stop"},
    {"print", "experiment", false, "A quantity that is printed for objects at regular intervals.", print, "print"},
    {"history", "experiment", false, "Objects whose most recent poses are kept.", history, "history"},
    {"record", "experiment", false, "Contents of a recording in addition to the data that a replay requires.", record,
     "record"},
    {"ros2", "experiment", false, "ROS 2 interface of the robots.", ros2, "ros2"},
    {"teams", "ros2", false, "ROS 2 interface of the robots of one team.", ros2_of_a_team, "ros2"},
    {"topics", "ros2", false, "Settings of a ROS topic of the robots.", topics, "ros2"},
    {"drive", "ros2", false, "Wheels that are driven by `cmd_vel`.", drive, "ros2"},
};

}  // namespace of_experiments
}  // namespace

std::span<const Extension> experiment_parts() { return of_experiments::table; }

const Extension& experiment_part(std::string_view name, std::string_view parent) {
  using of_experiments::table;
  const auto found = std::find_if(std::begin(table), std::end(table),
                                  [&](const Extension& each) { return each.name == name && each.parent == parent; });
  if (found == std::end(table)) throw std::logic_error("no part " + std::string(name) + " of an experiment");
  return *found;
}

}  // namespace cohort::parsing
