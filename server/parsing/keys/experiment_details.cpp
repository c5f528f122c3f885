// SPDX-License-Identifier: Apache-2.0
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
`mode: free` is for hardware in the loop, human operators, and programs that read observations only now and
then. The run never waits for such a team, and runs in real time unless `--speed` is given. The server sends
only the newest observation, and the newest command takes effect at the next tick. If no command arrives for
`deadline` seconds of wall time, `on_late` defines the response: `zero`, `detach` or `stop`. The results of such
a run depend on the wall clock. [Hardware in the loop](../bridges/hardware.md) has an example.

A team with `required: false` may run without a controller. Until a controller attaches, all commands of its
robots are neutral. They become neutral again when the controller leaves or is lost. A controller that attaches
late drives its robots from the next tick on. The run's list of events contains that tick.
)md"},
      {"selectors", "", R"md(
A selector selects robots. It is one of:

- `all`;
- an id, such as `7`;
- an inclusive range of ids, such as `0..7`;
- a name in which `*` matches any characters, such as `explorers/*` or `*_7`.

A selector that matches nothing is an error. Objects are robots and everything else in the world that has a
name. They are selected by a name or a list of names, in which `*` matches any characters. `objects` and
`robots` match the objects that are in the world at the start and those that the event `add` adds, but not
spawned ones.
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

Each event has one of the maps below, and either `at`, in seconds of simulated time, or [`on`](#on-in-an-event).
An event with `at` occurs at the first tick at or after that time, before the sensors are read. Events at the
same tick occur in the order of the file, and before those with `on`.

A robot that an event adds belongs to a team from the start. Its id follows the ids of the robots in the world
file. Its controller starts with the run and first acts at the tick at which the robot appears. A robot that is
not in the world can be neither sensed nor touched, and its controller does not act.

`add` adds an object once, and an object that `remove` has removed does not return. An event that is not
possible does nothing, and the run's list of events gives the reason. Examples are adding an object twice, and
moving an object that has been removed or has not been added yet. If a force is applied again while it acts, its
duration starts again.
)md"},
      {"on", "an event", R"md(
The event occurs at the tick after a robot's command for its [action](actuators.md#cohortaction-name-in-model)
has risen above 0.5. It can occur again after the command has fallen to 0.5 or less. It occurs at most once per
tick, even if several robots begin the action. Robots without the action are ignored, but at least one robot
must have it. The run's list of events names the robot: `open_gate of 'explorers/sbot_3': disable 'gate'`.
)md"},
      {"spawn", "events", R"md(
```yaml
events:
  - at: 5
    spawn: {model: model://sbot, name: explorers/late, pose: [0, 1, 0, 0, 0, 0], area: [1, 1], every: 2, most: 20}
  - on: {action: call_for_help}
    spawn: {model: model://sbot, name: helpers/sbot, team: helpers, most: 5}
```

The model is read with the world, before the run begins. The names are numbered: a number whose name is taken is
skipped, and no name is used twice in a run. A robot gets the next unused id and the policy of its team. Unlike
a robot that is added with `add`, it has no controller before it is spawned. `cohort run` then starts its
controller; with `process` and `per-robot`, in a separate process. With `cohort serve`, the run waits until a
controller attaches, as after `cohort ctl spawn`.

- Nothing is spawned at 0 s.
- After `most` objects, no more are spawned, and the run's list of events says so. All `spawn` events of an
  experiment together may create at most 10,000 objects.
- Free space is not checked: an object that appears inside another one is pushed out of it.
- A batch of worlds (`cohort.Batch` in Python) rejects experiments with `spawn`, because its worlds share one
  description and its arrays have fixed shapes.
)md"},
      {"remove", "events", R"md(
Connections to other objects are released.
)md"},
      {"disable", "events", R"md(
Connections to other objects are released. [`enable`](#enable-in-events) brings the objects back.
)md"},
      {"set_emitter", "events", R"md(
Emitters are the lights, sounds, markers and climate sources of the world, of objects and of robots. LEDs and
loudspeakers are not affected, because controllers command them.

Properties whose keys are absent stay unchanged. A key applies to those selected emitters that have the
property. It is an error if none of them has it.
)md"},
      {"stop", "", R"md(
```yaml
stop:
  - inside: {objects: explorers/*, min: [1, -1], max: [2, 1], for: 2}
  - at_rest: {}
```

A run ends at the first tick at which one of the conditions under `stop` is met. The summary names this
condition. Objects that are not in the world are ignored. The position of an object is that of the origin of its
root link.
)md"},
      {"print", "experiment", R"md(
```yaml
print:
  - {quantity: position, objects: explorers/*, every: 0.5}
  - {quantity: count, objects: explorers/*}
```

`cohort run` prints a CSV table to standard output, and the summary of the run to standard error. With `--csv
FILE`, it writes the table to a file and prints the summary to standard output. The first line contains the
names of the columns, and the first column is the simulated time. The table has a line for each time at which a
quantity is due. A cell is empty if its quantity is not due or its object is not in the world.

- `position`: position of the root link, x, y, z.
- `pose`: position and orientation of the root link, the latter as a quaternion x, y, z, w.
- `heading`: direction of the root link's x axis in the xy plane.
- `velocity`: velocity of the root link's origin.
- `count`: number of selected objects that are in the world.
- `quarantined`: number of selected objects that have an invalid state or have left the world.
- `joint_force`: forces of a [breakable joint](physics.md#cohortbreakable_joint-name-in-world) on its first and
  its second link over the last step, x, y, z of each in the world frame.
- `joint_torque`: torques of the joint about its origin, in the same format. Forces and torques are 0 from the
  step after the joint has broken.
)md"},
      {"history", "experiment", R"md(
C++ programs that use Cohort as a library read these poses with `simulation.objects().history(…)`. The poses are
part of snapshots.
)md"},
      {"record", "experiment", R"md(
The keys apply to `cohort run --record FILE`. The `--record-…` options take precedence over them. Rates are
rounded to whole ticks.
)md"},
      {"ros2", "", R"md(
The key `ros2` configures the [ROS 2 bridge](../ros2.md), a program between ROS 2 nodes and a server. The server
only checks the key.

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

[turtlebot3.yaml](../../worlds/experiments/turtlebot3.yaml) uses the topics and frames of a real TurtleBot3, as
nav2 and slam_toolbox expect. [model.sdf](../../worlds/robots/turtlebot3/model.sdf) contains the model and the
sources of its data.
)md"},
      {"ros2", "experiment", R"md(
The namespace of a robot's topics is `/` and the robot's scoped name, such as `/explorers/sbot_7`. The key
`namespace` requires a single robot. The keys from `sync` on may also be set for one team: in `teams`, under the
name of the team. `domain`, `robots` and `teams` may not.
)md"},
  };
  return all;
}

}  // namespace cohort::parsing
