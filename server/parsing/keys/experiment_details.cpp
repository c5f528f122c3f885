#include "server/parsing/keys/details.hpp"

namespace cohort::parsing {

std::span<const Explanation> experiment_explanations() {
  static constexpr Explanation all[] = {
      {"experiment", "", R"md(
An experiment is a YAML file. [Experiment files](../experiment-files.md) explains parameters and controllers
without code.

```yaml
world: ../arenas/obstacles.sdf  # relative to this file
duration: 60
seed: 1
teams:
  - name: explorers
    robots: explorers/*
    controller: obstacle_avoidance
```
)md"},
      {"teams", "experiment", R"md(
`mode: free` is for hardware in the loop, for people, and for programs that only observe from time to time. The
server never waits for such a team. It runs at the speed of the wall clock unless `--speed` is given. It sends
only the newest observation, and the newest command takes effect from the next tick on. If no command arrives
for `deadline` seconds of wall time, `on_late` says what happens: `zero`, `detach` or `stop`. The results of such
a run depend on the wall clock. [Hardware in the loop](../bridges/hardware.md) has an example.

A team with `required: false` may have no controller. Until one attaches, its robots do nothing, with every
channel at its neutral value. When the controller leaves or is lost, they stop again. A controller that attaches
late takes part from the next tick on. The list of events of the run contains that tick.
)md"},
      {"selectors", "", R"md(
A selector of robots is one of these:

- `all`;
- an id, such as `7`;
- a range of ids with both ends, such as `0..7`;
- a name in which `*` matches any characters, such as `explorers/*` or `*_7`.

A selector that matches nothing is an error. Objects are selected by their names, as a text or a list of texts in
which `*` matches any characters. Objects are robots and everything else in the world that has a name. `objects`
and `robots` match what is in the world at the start or comes with the event `add`, and not what is spawned.
)md"},
      {"events", "", R"md(
```yaml
events:
  - at: 5
    add: {model: model://sbot, name: explorers/late, pose: [0, 1, 0, 0, 0, 1.57]}
  - at: 10
    remove: {objects: wall_east}
  - at: 12
    apply_force: {objects: things/box, force: [2, 0, 0], for: 0.5}
  - on: {action: open_gate, robots: explorers/*}
    disable: {objects: gate}
```

Each event has one of the maps below, and either `at`, in seconds of simulated time, or
[`on`](#on-in-an-event). An event with `at` takes place at the first tick that is not before that time, before
the robots sense. Events of the same tick take place in the order of the file, and before those with `on`.

A robot that an event adds belongs to a team from the beginning. Its id comes after those of the robots of the
world. Its controller starts with the run and first acts at the tick at which the robot appears. A robot that
is not in the world cannot be seen or touched, and its controller does not act.

`add` adds an object once, and an object that `remove` takes away does not come back. An event that no longer makes
sense does nothing, and the list of events of the run says why. Examples are to add an object twice, or to move
an object that has been removed or has not come yet. A force that is applied again while it acts starts again.
)md"},
      {"on", "an event", R"md(
The event takes place at the tick after the value that one of the robots commands for its
[action](actuators.md#cohortaction-name-in-model) has risen above 0.5. It takes place again after the value has
fallen to 0.5 or below and risen again. In one tick it takes place once, even if several robots begin the action.
Robots without the action are ignored, but at least one must have it. The list of events of the run names the
robot: `open_gate of 'explorers/sbot_3': disable 'gate'`.
)md"},
      {"spawn", "events", R"md(
```yaml
events:
  - at: 5
    spawn: {model: model://sbot, name: explorers/late, pose: [0, 1, 0, 0, 0, 0], area: [1, 1], every: 2, most: 20}
  - on: {action: call_for_help}
    spawn: {model: model://sbot, name: helpers/sbot, team: helpers, most: 5}
```

The model is read with the world, before the run begins. A number whose name is taken is skipped, and no name
is used twice in a run. A robot gets the next id that was never in use, and the policy of its team. Unlike a
robot that comes with `add`, it has no controller before it comes. `cohort run` starts one then; with `process`
and `per-robot` it starts in a process of its own. With `cohort serve` the run waits until a controller attaches,
as after `cohort ctl spawn`.

- Nothing is spawned at 0 s.
- After `most` objects no more are spawned, and the list of events of the run says so. All `spawn` events of an
  experiment together may create 10,000 objects.
- There is no check for free space: an object that appears inside another one is pushed out of it.
- A batch (`server/batch`) rejects experiments that spawn: its worlds share one description, and the shapes of
  its arrays are fixed.
)md"},
      {"remove", "events", R"md(
Connections to other objects are released.
)md"},
      {"disable", "events", R"md(
Connections to other objects are released. [`enable`](#enable-in-events) brings the objects back.
)md"},
      {"set_emitter", "events", R"md(
The emitters are lights, sounds, markers and climate sources of the world, of objects and of robots. LEDs and
loudspeakers, which controllers command, are not affected.

Properties whose keys are absent stay as they are. A key applies to those selected emitters that have the
property. If none has it, that is an error.
)md"},
      {"stop", "", R"md(
```yaml
stop:
  - inside: {objects: explorers/*, min: [1, -1], max: [2, 1], for: 2}
  - at_rest: {}
```

A run ends at the first tick at which one of the conditions under `stop` holds. The summary names it. Objects
that are not in the world do not count. Positions are those of the origins of root links.
)md"},
      {"print", "experiment", R"md(
```yaml
print:
  - {quantity: position, objects: explorers/*, every: 0.5}
  - {quantity: count, objects: explorers/*}
```

`cohort run` prints a table to standard output, or with `--csv FILE` to a file of comma-separated values. In
the first case the summary of the run goes to standard error. The first line has the names of the columns, and
the first column is the simulated time. There is a line for each time at which a quantity is due. Quantities
that are not due, or not in the world, are empty.

- `position`: x, y and z of the root link.
- `pose`: the same and its quaternion x, y, z, w.
- `heading`: the direction of its x axis in the plane.
- `velocity`: the velocity of its origin.
- `count`: how many of the objects are in the world.
- `quarantined`: how many of them broke or left the world.
- `joint_force`: the force of a [breakable joint](physics.md#cohortbreakable_joint-name-in-world) over the last
  step on its first and on its second link, x, y, z of each in the axes of the world.
- `joint_torque`: its torque about the joint's origin, in the same form. Force and torque are 0 from the step
  after it broke.
)md"},
      {"history", "experiment", R"md(
The poses are for programs that use `Simulation` as a library: `objects().history(…)`. They are part of
snapshots.
)md"},
      {"record", "experiment", R"md(
The keys apply to `cohort run --record FILE`. The options `--record-…` take precedence. Rates are rounded to
whole ticks.
)md"},
      {"ros2", "", R"md(
The key `ros2` is for the [bridge to ROS 2](../ros2.md), a program between the nodes and a server. The server
checks the key and does not use it otherwise.

```yaml
ros2:
  robots: all
  sync: free
  topics:
    scan: {name: /scan, rate: 5}
    image: false
  teams:
    explorers: {sync: command, wait: 1, on_silence: stand}
```

[turtlebot3.yaml](../../worlds/experiments/turtlebot3.yaml) has the topics and frames of a real TurtleBot3, as
nav2 and slam_toolbox expect them. Its model and the sources of its data are in
[model.sdf](../../worlds/robots/turtlebot3/model.sdf).
)md"},
      {"ros2", "experiment", R"md(
The topics of a robot are in the namespace `/TEAM/ROBOT`, given by its scoped name. A `namespace` applies to one
robot only. The keys from `sync` on may also be given in `teams`, under the name of a team of the experiment.
`domain`, `robots` and `teams` may not.
)md"},
  };
  return all;
}

}  // namespace cohort::parsing
