#include "server/parsing/keys/details.hpp"

namespace cohort::parsing {

std::span<const Explanation> sensor_explanations() {
  static constexpr Explanation all[] = {
      {"sensors", "", R"md(
A sensor has a name, which is unique among the devices of the model that give observations. Its observation
channels are called `NAME/INDEX/QUANTITY`. The [sensors of SDFormat](../sdf-sensors.md), such as `<sensor
type="lidar">`, are read too.

A reading is the measured value plus noise and bias. It is rounded to the precision and kept within the range
of its channel. Counts and flags have neither noise nor bias. A sensor with a `rate` measures at the ticks that
are multiples of its period, and its reading holds in between. With a `latency` the reading is reported that
much later. A drop-out loses a whole report of the device. Until the first report arrives, readings are 0;
those of a lidar are its greatest range, and the objects of a logical camera are -1.

Random draws depend on the seed of the run, the names of the robot and of the device, the tick, and the index
of the value. Nothing else in the world changes them.
)md"},
      {"samples", "", R"md(
Readings of a real robot, or those that `cohort samples` computes, are kept in a file of comma-separated values.
Its path is relative to the file of the model.

```text
# anything
distance [m],angle [rad],reading_0 [1],reading_1 [1]
0.01,0,0.9,0.2
0.01,3.14,0.1,0.8
0.05,0,0.5,0.1
0.05,3.14,0.05,0.4
```

There is one reading for each sensor, in their order, at every angle of every distance. Distances are in
ascending order. Angles are counter-clockwise from the front of the robot, in ascending order, over less than
a full turn. Readings are interpolated bilinearly, and angles wrap around. Nearer than the first distance the
readings are those of the first distance. Beyond the last distance they are 0.
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
- `random_ray`: one ray, which each tick draws evenly from the cone.
- `five_rays`: the mean of the ray along the axis and of four others. These are at √(5/8) of half the cone from
  the axis: left, right, up and down.
- `shadow`: the mean over those of 360 directions from the middle of the ring, in its plane, that end in the
  mouth of the cone. Each body is replaced by an upright circle or rectangle around it. The ground is not seen.
- `samples`: a value from a [file of samples](sensors.md#samples). It is looked up by the distance and bearing
  of the nearest point of a body, seen from the middle of the ring. Bodies do not hide each other, and the
  greatest value counts. The ground is not seen.
)md"},
      {"ground_sensors", "model", R"md(
Observations `NAME/I/reading`: 1 at contact, falling linearly to 0 at the range. Over a hole it is 0.
)md"},
      {"light_sensors", "model", R"md(
Observations `NAME/I/reading`.

The light of a [lamp](../sdf-sensors.md#lights) is weighted by the cosine of the angle between the lamp and the
axis of the sensor. It counts only if a ray from the middle of the ring to the lamp hits nothing but the two
bodies that carry them. With the sum x over all lamps, times the gain, the reading is 2 / (1 + exp(−x)) − 1.

With [`samples`](sensors.md#samples) the file replaces distance and cosine. The reading of the file is looked
up by the distance of the lamp and its bearing in the xy plane of the ring. It is multiplied by the brightness
of the lamp.
)md"},
      {"microphones", "model", R"md(
Observations `NAME/I/intensity`, with one value for each band.

A source within the band contributes its intensity / d². With the sum x over all sources, times the gain, the
reading is 2 / (1 + exp(−x)) − 1. A robot does not receive its own sound.

With [`samples`](sensors.md#samples) the file replaces 1 / d². The reading of the file is looked up by the
distance of the source from the origin of the link and its bearing from the x axis of the link. It is multiplied
by the intensity of the source.
)md"},
      {"range_and_bearing", "model", R"md(
Commands `NAME/0/sending` (0 or 1) and `NAME/0/message`. Observations: `NAME/0/count`, and for each received
message `NAME/I/range` [m], `NAME/I/bearing` [rad], `NAME/I/elevation` [rad] and `NAME/I/message`.

A message arrives at the tick after the command. Every robot within its range receives it if its device has
messages of the same size and the line of sight is free. The line of sight is a ray from one device to the
other that hits nothing but these two robots. The nearest message comes first, and messages beyond the capacity
are lost. If a controller does not act at every tick, messages accumulate until the next observation, and the
newest tick comes first.
)md"},
      {"omnidirectional_camera", "model", R"md(
It sees [markers](emitters.md#cohortmarker-name-in-link) and the LEDs of other robots. Observations:
`NAME/0/count`, and for each spot `NAME/I/bearing` [rad], `NAME/I/elevation` [rad], `NAME/I/distance` [m] and
`NAME/I/color` (red, green, blue).

The nearest spot comes first. A spot is visible if a ray to it hits nothing but the camera's own body. The ray
ends 2 mm before the spot. The LEDs on the far side of a robot are therefore hidden, and a marker inside the
body that carries it is never visible. A camera does not see the spots of its own robot.
)md"},
      {"panorama", "model", R"md(
Observation `NAME/0/image`: red, green and blue of each pixel, from 0 to 1. Rows go from the highest elevation
to the lowest. Each row goes counter-clockwise from the x axis.

Each pixel is one ray. A surface has the colour of its link: the `<diffuse>` of the `<material>` of the first
`<visual>` of the link, or grey. It is multiplied by 0.4 + 0.6 max(0, n·l), with the normal n and the light
direction l = (2, 1, 3) / √14. The camera sees collisions and not the shapes of visuals. Lamps do not
illuminate anything. Visible markers and LEDs are drawn on top as spots with a radius of 5 mm, at least one
pixel wide.

An image is sent to the controller as float64 values at each tick that the controller acts. Use a `rate`, or
keep the image small.
)md"},
      {"torque_sensor", "model", R"md(
Observation `NAME/0/torque` [N m], or `NAME/0/force` [N] for a prismatic joint.
)md"},
      {"traction_sensor", "model", R"md(
It measures the force that the child exerts on the parent, over the last step. Observations
`NAME/0/direction` [rad], `NAME/0/intensity` [N] and `NAME/0/force`, its x and y [N].
)md"},
      {"climate_sensor", "model", R"md(
It measures the [climate](emitters.md#cohortclimate-in-world) of the world plus the contributions of climate
sources nearby. Observations `NAME/0/temperature` [K] and `NAME/0/humidity`.
)md"},
      {"accelerometer", "model", R"md(
Observation `NAME/0/acceleration`, x y z along its own axes [m/s²]: the acceleration of its origin minus
gravity, averaged over the last step. At rest it is g upwards; in free fall it is 0.
)md"},
      {"inclinometer", "model", R"md(
Observations `NAME/0/roll` and `NAME/0/pitch` [rad].

With u the direction opposite to gravity in the frame of the sensor, roll = atan2(u_y, u_z) and
pitch = atan2(−u_x, √(u_y² + u_z²)). Both are independent of the heading. Without gravity both are 0.
)md"},
      {"battery", "model", R"md(
Observations `NAME/0/charge`, as a fraction of the capacity, and `NAME/0/power` [W], over the last step.

Over each step the battery gives `idle_power` + P / `motor_efficiency`. P is the mechanical power, which is
force × velocity, summed over everything that the robot drives. Braking counts as 0 and returns no energy.

- Joint: torque or force of its motor × velocity of the joint.
- Track of a `treel_drive`: traction × velocity of the track.
- Belt, also of a `tracked_drive`: force that contacts and tracks exert along the surface × velocity of the
  surface.
- Rotor: `moment_constant` × `motor_constant` × |ω|³, its reaction torque × velocity in its own fluid.

When the battery is empty, every command has its neutral value.
)md"},
  };
  return all;
}

}  // namespace cohort::parsing
