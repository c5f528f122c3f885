// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/keys/details.hpp"

namespace cohort::parsing {

std::span<const Explanation> actuator_explanations() {
  static constexpr Explanation all[] = {
      {"actuators", "", R"md(
The name of an actuator is unique among all devices of the model that have commands. Its command channels are
called `NAME/INDEX/QUANTITY`.
)md"},
      {"treel_drive", "model", R"md(
A treel is the s-bot's combination of tracks and wheels. Commands `NAME/left/velocity` and
`NAME/right/velocity` [m/s].

A wheel joint is revolute, connects the wheel to the link that carries the tracks, and has no motor of its own.
With the fidelity `articulated`, the track motors turn the wheels. With the other fidelities, the wheels are
rigidly fixed to this link, and their collisions are ignored.
)md"},
      {"velocity_motor", "model", R"md(
Command `NAME/0/velocity` [rad/s, or m/s for a prismatic joint].

The motor of a universal joint turns its first axis. A ball joint has no single axis, so it can have neither a
motor nor an encoder. A rotor with inertia J and a gear ratio of n:1 has the reflected inertia J n².
)md"},
      {"position_motor", "model", R"md(
Command `NAME/0/position` [rad, or m for a prismatic joint].

The motor limits its velocity so that it can always brake in time. It stops at the commanded position without
overshoot.
)md"},
      {"effort_motor", "model", R"md(
Command `NAME/0/effort` [N m, or N for a prismatic joint].
)md"},
      {"differential_drive", "model", R"md(
Commands `NAME/0/linear` [m/s], forward, and `NAME/0/angular` [rad/s], counter-clockwise.

The wheels turn at the rolling-without-slip velocities (linear ∓ angular × `wheel_separation` / 2) /
`wheel_radius`. The sign − is for the left side. A positive joint velocity drives the vehicle forward. The
wheels are simulated like any other links. With the fidelity `planar`, they turn but do not move the vehicle;
use a [`treel_drive`](#cohorttreel_drive-name-in-model) instead.
)md"},
      {"ackermann_drive", "model", R"md(
Commands `NAME/0/linear` [m/s], forward, and `NAME/0/angular` [rad/s], counter-clockwise. Both refer to the
midpoint of the unsteered axle.

The curvature κ = angular / linear is limited to tan(`steering_limit`) / `wheel_base`. The steering angles are
atan(κ `wheel_base` / (1 ∓ κ `kingpin_width` / 2)). The driven wheels turn at linear (1 ∓ κ `wheel_separation` /
2) / `wheel_radius`. The sign − is for the left side. At a linear velocity of 0, the wheels steer to their limit
in the direction of the turn. As with a [`differential_drive`](#cohortdifferential_drive-name-in-model), the
wheels are simulated like any other links.
)md"},
      {"belt", "model", R"md(
Command `NAME/0/velocity` [m/s].

The surface of every collision of the link moves. At a contact with normal n, which points out of the link, the
surface moves at `velocity` along axis × n. If the velocity is positive and the axis points to the left, the
link carries an object on top of it forward. Under a vehicle, the link is a track that drives the vehicle
forward. The link itself does not move.

Friction opposes the slip relative to the moving surface. The friction coefficient is that of the contact
between the two surfaces, and the contact slips if the load exceeds the friction limit. If two belts touch,
their velocities add up. A belt carries a [`treel_drive`](#cohorttreel_drive-name-in-model) along, and the
drive's encoder measures only its motion relative to the belt. Belt contacts are compliant by a fraction of a
millimetre, so that they share the load. A robot's [battery](sensors.md#cohortbattery-name-in-model) also powers
its belts, including those of a `tracked_drive`. Belts cannot be simulated with the fidelity `planar`.

To model a conveyor, connect a model to the world by a fixed joint, because a `<static>` model has no devices.
With the key `velocity`, the conveyor runs without a controller:

```xml
<model name="conveyor">
  <link name="belt">
    <collision name="top"><geometry><box><size>3 0.6 0.2</size></box></geometry></collision>
  </link>
  <joint name="tie" type="fixed"><parent>world</parent><child>belt</child></joint>
  <cohort:belt name="belt">
    <cohort:link>belt</cohort:link>
    <cohort:max_velocity>1</cohort:max_velocity>
    <cohort:velocity>0.4</cohort:velocity>
  </cohort:belt>
</model>
```
)md"},
      {"tracked_drive", "model", R"md(
Commands `NAME/0/linear` [m/s], forward, and `NAME/0/angular` [rad/s], counter-clockwise.

The tracks run at the velocities linear ∓ angular × `track_separation` / (2 `steering_efficiency`), as
[belts](#cohortbelt-name-in-model). In a turn they slip sideways, and longer tracks slip more. The turn rate
depends on friction and load, and `steering_efficiency` compensates for the slip. For example, the efficiency is
0.38 for tracks that are 0.6 m long and 0.4 m apart. With the solver `direct`, sideways slip does not reduce the
friction along a track. A vehicle whose tracks are longer than the distance between them then cannot turn on the
spot.
)md"},
      {"detachable_joint", "model", R"md(
Command `NAME/0/attached`: 1 as long as no controller sets it, or 0 if `initially_attached` is `false`.

While the command is above 0.5, the two links are rigidly connected. The joint preserves the relative pose at
the moment of attachment: at the start of the run, or when the command rises above 0.5. At 0.5 or less,
the joint releases the child.

After the child has left the world or has been moved by an event, the command must fall to 0.5 or less before
the joint can attach it again. A child that an event adds later is attached when it appears. The command returns
to its initial value if the robot's battery is empty or its controller is lost. For a connection that breaks under
load, use a [breakable joint](physics.md#cohortbreakable_joint-name-in-world). To grasp an object wherever the
robot finds it, use a [gripper](#cohortgripper-name-in-model).
)md"},
      {"rotor", "model", R"md(
Command `NAME/0/velocity` [rad/s]. Observation `NAME/0/velocity`, the actual velocity.

The model and its parameter names are those of RotorS and of Gazebo's MulticopterMotorModel. The source is
Furrer et al., "RotorS – A modular Gazebo MAV simulator framework", 2016. ω is the angular velocity of the
propeller. v⊥ is the component of its velocity relative to the air that is perpendicular to its axis. The upper
sign is for `ccw`, the lower sign for `cw`.

- Thrust along z: `motor_constant` ω |ω|.
- Reaction torque about z: ∓ `moment_constant` × thrust.
- Drag: −`drag_coefficient` |ω| v⊥.
- Rolling moment: −`rolling_moment_coefficient` |ω| v⊥.
- Velocity: a first-order response to the command, 1 − exp(−t / `time_constant_up`), with `time_constant_down`
  while the velocity decreases.

A marine thruster is also a rotor. For a propeller with thrust coefficient K and diameter D, `motor_constant` is
density × K D⁴ / 4π². Set `density` to the density of water; the thrust in air is then almost 0.

The `link` is the body that carries the motor, because the reaction torque acts on that body. Do not use a link
that spins only for display. Forces act in every simulation step. The rotor draws the power thrust ×
`moment_constant` × ω from a battery; thrust is that in the rotor's own fluid.
)md"},
      {"led_ring", "model", R"md(
Commands `NAME/I/color`: red, green and blue, each from 0 to 1.

Cameras see an LED as a coloured spot unless it is black. Light sensors see it as a lamp if `intensity` is above
0.
)md"},
      {"loudspeaker", "model", R"md(
Commands `NAME/0/frequency` [Hz] and `NAME/0/intensity`.

The intensity falls with the square of the distance. Sound is neither reflected nor blocked.
)md"},
      {"gripper", "model", R"md(
Command `NAME/0/opening`, from 0 (closed) to 1. The observation `NAME/0/opening` is the actual opening. Further
observations are `NAME/0/gripping` and `NAME/0/grippable`, 0 or 1, and `NAME/0/force` [N].

When the opening falls below 0.5, the gripper grasps the nearest grip ring or grippable collision of another
object within its depth, angle and height. If there is none, the gripper grasps the first one that enters this
region while it is closed.

A closed gripper holds the object rigidly up to the holding force and the holding torque, measured about the
centre of the ring. The holding torque about the axis of the ring falls to 0 when the gripper is half open. If
it opens further, it holds nothing. If the object is torn away or leaves the world, the gripper must open before
it can grasp again. Two robots can grip each other.
)md"},
      {"action", "model", R"md(
An action represents anything that a robot does other than moving a joint, such as pressing a button. Example:
`<cohort:action name="open_gate"/>`. Command `NAME/0/value`, from 0 to 1. The robot performs the action while
the value is above 0.5.

The effect is defined elsewhere. [Events with `on`](events.md#on-in-an-event) react to an action. A program that
uses `Simulation` as a library can handle it with `simulation.on_action("open_gate", handler)`. After every
step, Cohort calls the handler with the robot and the value. A robot that is not in the world performs no
action.
)md"},
      {"grip_ring", "link", R"md(
The s-bot has a grip ring with a T-shaped profile around its turret.

A gripper detects the ring only if the object also has a collision near the jaw. The collision must be within
the depth plus the height of the gripper plus the radius of the ring.
)md"},
      {"grippable", "collision", R"md(
For example, `<cohort:grippable>true</cohort:grippable>`.
)md"},
  };
  return all;
}

}  // namespace cohort::parsing
