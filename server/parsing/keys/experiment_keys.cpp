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
    {"world", uri, "", "", "the world's file, relative to this one"},
    {"duration", positive, "s", "", "simulated time, at the most"},
    {"seed", whole, "", "1", "whole number of at most 64 bits: placement and noise"},
    {"step", positive, "s", "the world's", "simulated time of a tick"},
    {"threads", count, "1", "the cores", "that step the world; results do not depend on it"},
    {"physics", group, "", "the world's",
     "map with keys of [`<cohort:physics>`](#cohortphysics-in-world), each in place of the world's"},
    {"teams", group, "", "", "list; every robot of the world is in exactly one team"},
    {"events", group, "", no_value, "list of what happens at a time, or when a robot does something"},
    {"stop", group, "", no_value, "list of conditions; the run ends when one of them holds"},
    {"print", group, "", no_value, "list of quantities that `cohort run` prints"},
    {"history", group, "", no_value, "whose last poses are kept"},
    {"record", group, "", "its defaults", "what a recording holds, if there is one"},
};

constexpr std::string_view modes[] = {"lockstep", "free"};
constexpr std::string_view restarts[] = {"on_failure", "never"};
constexpr std::string_view losses[] = {"go_on", "rewind"};

constexpr ExtensionKey team[] = {
    {"name", name, "", "", "unique"},
    {"robots", name, "", "", "a selector or a list of selectors", true},
    {"controller", name, "", "",
     "the name of a controller, or a path to a plugin (`….so`) or to Python (`….py`), relative to this file"},
    {"parameters", group, "", no_value, "what the controller is given; see below"},
    {"period", count, "ticks", "1", "asked every so many ticks"},
    {"phase", whole, "ticks", "0", "first asked at this tick; less than the period"},
    {"delay", whole, "ticks", "0", "the answer to tick k acts at k + delay"},
    {"mode", choice, "", "lockstep", "`lockstep`, or `free`: never waited for, for people and hardware; see below",
     false, modes},
    {"on_late", choice, "", "wait", "`wait`, `hold`, `zero`, `detach` or `stop`; `hold` by default if free", false,
     late_policies},
    {"deadline", positive, "s", no_value,
     "wall-clock patience per tick; required unless `wait`, under which it has no place. If free, since the last "
     "answer"},
    {"required", flag, "", "true",
     "whether the run waits for a controller to begin, and for a new one when it is lost; `false` by default if free"},
    {"on_lost", choice, "", "go_on",
     "when a new process takes over from a controller that is lost: the run goes on with a controller that starts "
     "without state (`go_on`), or goes back to its last snapshot and has the bits of an undisturbed run (`rewind`, "
     "with `--keep-snapshots`)",
     false, losses},
    {"restart", choice, "", "on_failure",
     "a controller process of `cohort run` that dies is started again, up to three times (`on_failure`), or ends the "
     "run (`never`)",
     false, restarts},
};

constexpr ExtensionKey add[] = {
    {"model", uri, "", "", "`model://NAME`, or a path relative to the world's file"},
    {"name", name, "", "", "of the object, unique; may be scoped, as in `team/late_1`"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "in the world"},
};
constexpr ExtensionKey spawn[] = {
    {"model", uri, "", "", "`model://NAME`, or a path relative to the world's file"},
    {"name", name, "", "", "what names begin with: `team/late` makes `team/late_1`, `team/late_2` …"},
    {"pose", pose, "m, rad", "0 0 0 0 0 0", "in the world"},
    {"area", point, "m", "0 0", "edges of a rectangle about the pose, in which the seed draws x and y of each"},
    {"team", name, "", no_value, "whose controllers drive it; has to be there if there are several teams"},
    {"every", positive, "s", no_value, "beside `at`: comes again and again, so much time apart"},
    {"most", count, "1", "100", "how many may come in a run"},
};
constexpr ExtensionKey objects_only[] = {
    {"objects", name, "", "", "names, in which `*` stands for any characters", true},
};
constexpr ExtensionKey move[] = {
    {"objects", name, "", "", "names, in which `*` stands for any characters", true},
    {"pose", pose, "m, rad", "", "of the model in the world"},
};
constexpr ExtensionKey set_velocity[] = {
    {"objects", name, "", "", "names, in which `*` stands for any characters", true},
    {"linear", vector, "m/s", "0 0 0", "of the origin of the root link"},
    {"angular", vector, "rad/s", "0 0 0", "of the root link"},
};
constexpr ExtensionKey apply_force[] = {
    {"objects", name, "", "", "names, in which `*` stands for any characters", true},
    {"link", name, "", no_value, "the root link if absent"},
    {"force", vector, "N", "0 0 0", "at the centre of mass of the link, in the axes of the world"},
    {"torque", vector, "N m", "0 0 0", "in the axes of the world"},
    {"for", positive, "s", "", "how long it acts"},
};

constexpr ExtensionKey set_emitter[] = {
    {"objects", name, "", "", "names, in which `*` stands for any characters", true},
    {"emitter", name, "", "*", "names of their emitters, the same way", true},
    {"on", flag, "", no_value, "whether it emits"},
    {"intensity", non_negative, "1", no_value, "of a light or a sound: what arrives at 1 m"},
    {"frequency", positive, "Hz", no_value, "of a sound"},
    {"color", vector, "1", no_value, "of a light or a marker: red, green and blue, from 0 to 1"},
    {"temperature", real, "K", no_value, "of a climate source: added in its middle"},
    {"humidity", real, "1", no_value, "of a climate source: relative, added in its middle"},
};
constexpr ExtensionKey on[] = {
    {"action", name, "", "", "the name of a `cohort:action`"},
    {"robots", name, "", "all", "a selector or a list of selectors: whose action it is", true},
};

constexpr ExtensionKey inside[] = {
    {"objects", name, "", "", "names, in which `*` stands for any characters", true},
    {"min", point, "m", "", "corner of a rectangle with the least x and y"},
    {"max", point, "m", "", "corner with the greatest x and y"},
    {"for", non_negative, "s", "0", "how long it has to hold"},
};
constexpr ExtensionKey beyond[] = {
    {"objects", name, "", "", "names, in which `*` stands for any characters", true},
    {"point", point, "m", "", "of the line"},
    {"direction", point, "1", "", "in which the line is crossed, at right angles to it"},
    {"for", non_negative, "s", "0", "how long it has to hold"},
};
constexpr ExtensionKey at_rest[] = {
    {"objects", name, "", "*", "names, in which `*` stands for any characters", true},
    {"speed", positive, "m/s", "0.001", "what is slower is at rest"},
    {"turn_rate", positive, "rad/s", "0.01", "the same of turning"},
    {"for", non_negative, "s", "1", "how long it has to hold"},
};
constexpr ExtensionKey quarantined[] = {
    {"objects", name, "", "*", "names, in which `*` stands for any characters", true},
};

constexpr ExtensionKey print[] = {
    {"quantity", choice, "", "",
     "`position`, `pose`, `heading`, `velocity`, `count`, `quarantined`, `joint_force` or `joint_torque`", false,
     quantities},
    {"objects", name, "", "*", "names, in which `*` stands for any characters", true},
    {"joints", name, "", "*", "of `joint_force` and `joint_torque`: names of breakable joints, the same way", true},
    {"every", positive, "s", "1", "of simulated time, in whole ticks"},
};

constexpr ExtensionKey history[] = {
    {"objects", name, "", "*", "names, in which `*` stands for any characters", true},
    {"length", count, "1", "", "how many poses are kept of each, the newest ones"},
    {"every", positive, "s", no_value, "of simulated time, in whole ticks; a tick if absent"},
};

constexpr ExtensionKey record[] = {
    {"poses", non_negative, "Hz", "10", "how often the poses of all that moves"},
    {"joints", non_negative, "Hz", "0", "how often the states of all joints, and the poses of all links"},
    {"observations", non_negative, "Hz", "0", "how often what robots observe, at the most as often as they are asked"},
    {"robots", name, "", "all", "a selector or a list of selectors: whose observations", true},
    {"snapshots", non_negative, "s", "30", "from one snapshot of the world to the next; 0: none"},
};

constexpr Extension table[] = {
    {"experiment", "", false, "A world, a seed, a duration, and who controls which robot.", experiment, "experiment"},
    {"teams", "experiment", false, "Robots that share a controller.", team, "experiment"},
    {"add", "events", false, "An object or a robot comes into the world.", add, "events"},
    {"spawn", "events", false, "A new object or robot comes into the world, another one each time.", spawn, "events"},
    {"remove", "events", false, "Objects leave the world for good.", objects_only, "events"},
    {"disable", "events", false, "Objects leave the world and may come back as they were.", objects_only, "events"},
    {"enable", "events", false, "Objects come back.", objects_only, "events"},
    {"move", "events", false, "Objects are put somewhere else, at rest, with their joints as they are.", move,
     "events"},
    {"set_velocity", "events", false, "Objects get a velocity.", set_velocity, "events"},
    {"apply_force", "events", false, "A force and a torque act for some time.", apply_force, "events"},
    {"set_emitter", "events", false, "Emitters of objects change.", set_emitter, "events"},
    {"on", "an event", false, "What makes it happen in place of a time: a robot does something.", on, "events"},
    {"inside", "stop", false, "All of the objects are within a rectangle.", inside, "stop"},
    {"beyond", "stop", false, "One of the objects is beyond a line.", beyond, "stop"},
    {"at_rest", "stop", false, "None of the objects moves.", at_rest, "stop"},
    {"quarantined", "stop", false, "One of the objects broke or left the world.", quarantined, "stop"},
    {"print", "experiment", false, "A quantity of some objects, printed at times.", print, "print"},
    {"history", "experiment", false, "Poses of some objects that are kept.", history, "history"},
    {"record", "experiment", false, "What a recording holds beside what replays the run.", record, "record"},
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
