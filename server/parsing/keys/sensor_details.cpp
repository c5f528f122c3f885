// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/keys/details.hpp"

namespace cohort::parsing {

std::span<const Explanation> sensor_explanations() {
  static constexpr Explanation all[] = {
      {"sensors", "", R"md(
The name of a sensor is unique among all devices of the model that have observations. Its observation channels
are called `NAME/INDEX/QUANTITY`. The [sensors of SDFormat](../sdf-sensors.md), such as `<sensor type="lidar">`,
are also supported.

A reading is the measured value plus noise and bias, rounded to the precision and clamped to the range of its
channel. Counts and flags have neither noise nor bias. A sensor with a `rate` measures at multiples of its
period, and its reading stays the same in between. With a `latency`, each reading is reported that much later. If
the period is not a whole number of ticks, each measurement happens at the nearest tick, so that the average rate
is exact: at 30 Hz and 100 ticks per second, at the ticks 0, 3, 7, 10 … A latency is exact on average too. A
drop-out loses the whole report of the sensor. Before the first report, readings are 0. A lidar then reads its
maximum range, and the objects of a logical camera are -1.

Random numbers depend only on the seed of the run, the names of the robot and the device, the tick, and the
index of the value.
)md"},
      {"samples", "", R"md(
A sample file (CSV) contains readings that were measured on a real robot or computed by `cohort samples`. Its
path is relative to the model file.

```text
# anything
distance [m],angle [rad],reading_0 [1],reading_1 [1]
0.01,0,0.9,0.2
0.01,3.14,0.1,0.8
0.05,0,0.5,0.1
0.05,3.14,0.05,0.4
```

The file has one row for each combination of distance and angle, with one reading for each sensor, in the order
of the sensors. Distances are in ascending order. Angles are measured counter-clockwise from the front of the
robot, in ascending order, over less than a full turn. Readings are interpolated bilinearly, and angles wrap
around. At less than the first distance, the readings of the first distance are used. Beyond the last distance,
the readings are 0.
)md"},
      {"joint_encoder", "model", R"md(
Observations `NAME/0/position` and `NAME/0/velocity` [rad and rad/s, or m and m/s for a prismatic joint]. The
encoder of a universal joint measures its first axis.
)md"},
      {"treel_encoder", "model", R"md(
Observations `NAME/left/position` and `NAME/right/position` [m], `NAME/left/velocity` and
`NAME/right/velocity` [m/s].
)md"},
      {"proximity_ring", "model", R"md(
Observations `NAME/I/reading`. A ray that hits something at the distance d contributes 1 − d / `range`.

A real sensor receives reflections from a whole cone. The techniques approximate the mean over that cone:

- `ray`: one ray along the axis.
- `random_ray`: one ray at each tick, in a random direction, uniformly distributed in the cone.
- `five_rays`: the mean of the ray along the axis and four other rays. The angle between these and the axis is
  √(5/8) of half the cone: left, right, up and down.
- `shadow`: 360 rays are cast from the centre of the ring, in its plane. The reading is the mean over the rays
  that leave the sensor's cone through its open end. Each body is replaced by an upright circle or rectangle
  around it. The ground is not detected.
- `samples`: a value from a [sample file](sensors.md#samples). It is looked up by the distance and bearing of
  the nearest point of a body, measured from the centre of the ring. Bodies do not occlude each other, and the
  greatest value counts. The ground is not detected.
)md"},
      {"ground_sensors", "model", R"md(
Observations `NAME/I/reading`: 1 at contact, decreasing linearly to 0 at `range`. Over a hole, the reading is 0.
)md"},
      {"light_sensors", "model", R"md(
Observations `NAME/I/reading`.

The light that arrives from a [lamp](../sdf-sensors.md#lights) is weighted by the cosine of the angle between
the axis of the sensor and the direction of the lamp. A lamp counts only if its line of sight is free: a ray
from the centre of the ring to the lamp may hit only the two bodies that carry them. If x is the sum over all
lamps, times the gain, the reading is 2 / (1 + exp(−x)) − 1.

With [`samples`](sensors.md#samples), a reading from the file replaces the dependence on distance and cosine. It
is looked up by the distance of the lamp and its bearing in the xy plane of the ring, and multiplied by the
light of the lamp at 1 m.
)md"},
      {"microphones", "model", R"md(
Observations `NAME/I/intensity`, with one value for each band.

A source whose frequency is within the band contributes its intensity / d², with the distance d. If x is the sum
over all sources, times the gain, the reading is 2 / (1 + exp(−x)) − 1. A robot does not hear its own sound.

With [`samples`](sensors.md#samples), a reading from the file replaces 1 / d². The reading is looked up in the
file by two values: the distance of the source from the link's origin, and the bearing of the source from the
link's x axis. It is then multiplied by the intensity of the source.
)md"},
      {"range_and_bearing", "model", R"md(
Commands `NAME/0/sending` (0 or 1) and `NAME/0/message`. Observations: `NAME/0/count`, and for each received
message `NAME/I/range` [m], `NAME/I/bearing` [rad], `NAME/I/elevation` [rad] and `NAME/I/message`.

A message arrives at the tick after the command. A robot receives the message if it is within the range of the
message, its device has the same message size, and the line of sight is free. The line of sight is a ray from
one device to the other that hits nothing but these two robots. The message of the nearest sender comes first,
and messages beyond the capacity are lost. If a controller does not act at every tick, messages accumulate until
its next observation, those of the newest tick first.
)md"},
      {"omnidirectional_camera", "model", R"md(
The camera detects [markers](emitters.md#cohortmarker-name-in-link) and the LEDs of other robots. Observations:
`NAME/0/count`, and for each spot `NAME/I/bearing` [rad], `NAME/I/elevation` [rad], `NAME/I/distance` [m] and
`NAME/I/color` (red, green, blue).

The nearest spot comes first. A spot is visible if the ray to a point 2 mm before it hits nothing but the
camera's own body. The LEDs on the far side of a robot are therefore hidden, and a marker inside the body that
carries it is never visible. A camera does not detect the spots of its own robot.
)md"},
      {"panorama", "model", R"md(
Observation `NAME/0/image`: red, green and blue of each pixel, from 0 to 1. Rows are ordered from the highest
elevation to the lowest, and the pixels of a row counter-clockwise from the x axis.

Cohort casts one ray for each pixel. A surface has the colour of its link: the `<diffuse>` colour of the link's
first `<visual>`, or grey. The colour is multiplied by 0.4 + 0.6 max(0, n·l), with the surface normal n and the
light direction l = (2, 1, 3) / √14. The camera sees the shapes of collisions, not of visuals. Lamps do not
illuminate anything. Visible markers and LEDs are drawn on top as spots with a radius of 5 mm, at least one
pixel wide.

At each tick at which the controller acts, it receives the image as float64 values. Keep the image small; a
`rate` saves computation, but the observation still contains the last image.
)md"},
      {"torque_sensor", "model", R"md(
Observation `NAME/0/torque` [N m], or `NAME/0/force` [N] for a prismatic joint.
)md"},
      {"traction_sensor", "model", R"md(
The sensor measures the force that the child link exerts on the parent link, averaged over the last step.
Observations `NAME/0/direction` [rad], `NAME/0/intensity` [N] and `NAME/0/force`, the x and y components [N].
)md"},
      {"climate_sensor", "model", R"md(
The sensor measures the [climate](emitters.md#cohortclimate-in-world) of the world plus the contributions of
nearby climate sources. Observations `NAME/0/temperature` [K] and `NAME/0/humidity`.
)md"},
      {"accelerometer", "model", R"md(
Observation `NAME/0/acceleration` [m/s²], x y z along the axes of the sensor: the acceleration of its origin
minus gravity, at the end of the last step. At rest, the reading is g upwards; in free fall, it is 0.
)md"},
      {"inclinometer", "model", R"md(
Observations `NAME/0/roll` and `NAME/0/pitch` [rad].

Roll is atan2(u_y, u_z), and pitch is atan2(−u_x, √(u_y² + u_z²)), where u is the direction opposite to gravity
in the frame of the sensor. Both are independent of the heading. Without gravity both are 0.
)md"},
      {"battery", "model", R"md(
Observations `NAME/0/charge`, as a fraction of the capacity, and `NAME/0/power` [W], averaged over the last
step.

In each step, the battery supplies the power `idle_power` + P / `motor_efficiency`. P is the total mechanical
power of the robot's actuators, force × velocity for each. Braking counts as 0 and returns no energy.

- Joint: motor torque or force × joint velocity.
- Track of a `treel_drive`: traction × track velocity.
- Belt, including those of a `tracked_drive`: force that contacts and tracks exert along the surface × surface
  velocity.
- Rotor: reaction torque in its own fluid × rotor velocity, which is `moment_constant` × `motor_constant` ×
  |ω|³.

When the battery is empty, every command is set to its neutral value.
)md"},
  };
  return all;
}

}  // namespace cohort::parsing
