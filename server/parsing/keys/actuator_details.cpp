#include "server/parsing/keys/details.hpp"

namespace cohort::parsing {

std::span<const Explanation> actuator_explanations() {
  static constexpr Explanation all[] = {
      {"actuators", "", R"md(
An actuator has a name, which is unique among the devices of the model that take commands. Its command
channels are called `NAME/INDEX/QUANTITY`.
)md"},
      {"treel_drive", "model", R"md(
A treel is the s-bot's combination of tracks and wheels. Commands `NAME/left/velocity` and
`NAME/right/velocity` [m/s].

The joint of a wheel is revolute, connects the wheel to the body of the tracks, and has no motor of its own.
With the fidelity `articulated` the wheels turn, driven by the motors of the tracks. With the other fidelities
they are part of the body and touch nothing.
)md"},
      {"velocity_motor", "model", R"md(
Command `NAME/0/velocity` [rad/s, or m/s for a prismatic joint].

The motor of a universal joint turns its first axis. A ball joint has no single axis, so it has neither motor
nor encoder. A rotor with the inertia J behind a gear n:1 has the reflected inertia J n².
)md"},
      {"position_motor", "model", R"md(
Command `NAME/0/position` [rad, or m for a prismatic joint].

The motor never moves faster than it can brake in time, and it stops at the position without overshoot.
)md"},
      {"effort_motor", "model", R"md(
Command `NAME/0/effort` [N m, or N for a prismatic joint].
)md"},
      {"differential_drive", "model", R"md(
Commands `NAME/0/linear` [m/s], forward, and `NAME/0/angular` [rad/s], counter-clockwise.

The wheels turn as if they rolled without slip, at
(linear ∓ angular × `wheel_separation` / 2) / `wheel_radius`. A positive velocity of their joints drives the
vehicle forward. The wheels are simulated like any other links. With the fidelity `planar` they turn but do
not move the vehicle; there, use a [`treel_drive`](#cohorttreel_drive-name-in-model).
)md"},
      {"ackermann_drive", "model", R"md(
Commands `NAME/0/linear` [m/s], forward, and `NAME/0/angular` [rad/s], counter-clockwise. They refer to the
middle of the axle that does not steer.

The curvature is κ = angular / linear, at most tan(`steering_limit`) / `wheel_base`. The steering joints go to
the angles atan(κ `wheel_base` / (1 ∓ κ `kingpin_width` / 2)). The driven wheels turn at
linear (1 ∓ κ `wheel_separation` / 2) / `wheel_radius`. The sign − is for the left side. At a linear velocity
of 0 the wheels steer to the limit on the side of the turn. The wheels are simulated as those of a
[`differential_drive`](#cohortdifferential_drive-name-in-model).
)md"},
      {"belt", "model", R"md(
Command `NAME/0/velocity` [m/s].

All collisions of the link have a running surface. At a contact with the normal n, which points out of the
link, the surface runs at `velocity` along axis × n. With a positive velocity and the axis to the left, an
object on the link is carried forward, and a vehicle that stands on the link drives forward. The link itself
does not move.

Friction acts towards the velocity of the surface instead of towards rest. Its coefficient is that of the two
surfaces, and beyond it the contact slips. The velocities of two belts that touch add up. A
[`treel_drive`](#cohorttreel_drive-name-in-model) is carried by a belt and measures what it rolls on it.
Contacts of a belt are compliant by a fraction of a millimetre, so that they share the load. A
[battery](sensors.md#cohortbattery-name-in-model) powers belts, also those of a `tracked_drive`. A belt cannot
be simulated with the fidelity `planar`.

A conveyor is a model that a fixed joint connects to the world, because a `<static>` model has no devices. The
key `velocity` makes it run without a controller:

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

The tracks run at linear ∓ angular × `track_separation` / (2 `steering_efficiency`), as
[belts](#cohortbelt-name-in-model). In a turn they slip sideways, and longer tracks slip more. The turn rate
follows from friction and load, and `steering_efficiency` compensates for the slip. For example, it is 0.38
for tracks of 0.6 m that are 0.4 m apart. With the solver `direct`, sideways slip does not reduce the friction
along a track. A vehicle whose tracks are longer than their distance then cannot turn on the spot.
)md"},
      {"detachable_joint", "model", R"md(
Command `NAME/0/attached`. It is 1 at the start, and 1 as long as no controller commands it.

While the command is above 0.5, the two links are rigidly connected. They keep the relative pose that they had
when the connection began: at the start of the run, or when the command rose again. At 0.5 or less the joint
releases the child.

After the child has left the world or an event has moved it, the joint holds again only once the command has
been at 0.5 or less. A child that an event adds later is held from then on. The command goes back to 1 if the
battery of the robot is empty or its controller is lost. For a connection that breaks under load, use a
[breakable joint](physics.md#cohortbreakable_joint-name-in-world). To hold an object where the robot finds it,
use a [gripper](#cohortgripper-name-in-model).
)md"},
      {"rotor", "model", R"md(
Command `NAME/0/velocity` [rad/s]. Observation `NAME/0/velocity`, the actual velocity.

The model and the names of its parameters are those of RotorS and of Gazebo's MulticopterMotorModel. The
source is Furrer and others, "RotorS – A modular Gazebo MAV simulator framework", 2016. ω is the velocity of
the propeller. v⊥ is the velocity of its origin relative to the air, perpendicular to its axis. The upper sign
is for `ccw`, the lower one for `cw`.

- Thrust along z: `motor_constant` ω |ω|.
- Reaction torque about z: ∓ `moment_constant` × thrust.
- Drag: −`drag_coefficient` |ω| v⊥.
- Rolling moment: −`rolling_moment_coefficient` |ω| v⊥.
- Velocity: it approaches the command by the factor 1 − exp(−t / `time_constant_up`), or with
  `time_constant_down` while it falls.

A marine thruster is a rotor too. With the thrust coefficient K and the diameter D of the propeller,
`motor_constant` is density × K D⁴ / 4π². Set `density` to that of water; the thrust in air is then almost 0.

The `link` is the body that carries the motor, because the reaction turns that body. A link that turns only
for the eye is the wrong one. Forces act in every simulation step. A battery powers the rotor with
thrust × `moment_constant` × ω, computed in the rotor's own fluid.
)md"},
      {"led_ring", "model", R"md(
Commands `NAME/I/color`: red, green and blue, each from 0 to 1.

A LED that is not black is a coloured spot for cameras. With an `intensity` it is also a lamp for light
sensors.
)md"},
      {"loudspeaker", "model", R"md(
Commands `NAME/0/frequency` [Hz] and `NAME/0/intensity`.

The intensity falls with the square of the distance. Sound is neither reflected nor blocked.
)md"},
      {"gripper", "model", R"md(
Command `NAME/0/opening`, from 0 (closed) to 1. The observation `NAME/0/opening` is the actual opening. Further
observations are `NAME/0/gripping` and `NAME/0/grippable`, 0 or 1, and `NAME/0/force` [N].

When the opening falls below one half, the gripper grasps the nearest grip ring or grippable collision of
another object. The candidates are those within its depth, angle and height at that moment. If there is none,
it grasps the first one that enters this region while it is closed.

A closed gripper is rigid up to its holding force and torque, measured about the middle of the ring. The
holding torque about the axis of the ring falls to 0 at half open. From there on the gripper holds nothing.
After the object was torn away or left the world, the gripper must open before it can grasp again. Two robots
may grip each other.
)md"},
      {"action", "model", R"md(
An action is for example the press of a button: `<cohort:action name="open_gate"/>`. Command `NAME/0/value`,
from 0 to 1. The robot performs the action while the value is above 0.5.

The effect is defined elsewhere. [Events with `on`](events.md#on-in-an-event) react to an action. A program
that uses `Simulation` as a library can handle it with `simulation.on_action("open_gate", handler)`. The
handler receives the robot and the value after every step. A robot that is not in the world performs no
action.
)md"},
      {"grip_ring", "link", R"md(
The s-bot has such a ring, with a T-shaped profile, around its turret.

A gripper finds the ring if a solid part of the ring's object is within the gripper's reach plus the width of
the ring, measured from the jaw.
)md"},
      {"grippable", "collision", R"md(
Grippers can grasp the collision anywhere: `<cohort:grippable>true</cohort:grippable>`.
)md"},
  };
  return all;
}

}  // namespace cohort::parsing
