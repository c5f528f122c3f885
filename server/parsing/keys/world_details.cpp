// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/keys/details.hpp"

namespace cohort::parsing {

std::span<const Explanation> world_explanations() {
  static constexpr Explanation all[] = {
      {"values", "", R"md(
All values are in SI units: m, kg, s, rad, N, N m. Frames are right-handed, with z up and x forward. All numbers
are finite, and angles are from -1e6 to 1e6 rad. A pose is `x y z roll pitch yaw`, with rotations about the fixed
axes x, then y, then z. A pose may also be `x y z qx qy qz qw`, with a quaternion. In YAML, a pose or vector is a
string as in SDF, or a list of numbers.

An optional key may be absent; it then has no value. A *name* refers to a link, joint or device of the same
model. A *scoped name* includes the group of the object, as in `team/sbot_1`.

In SDF, declare the prefix once: `<sdf version="1.9" xmlns:cohort="https://cohort-sim.org/sdf/1">`. Every key of
a `cohort:` element is a child element with the same prefix. In [YAML](../worlds-in-yaml.md), these keys may be
written without the prefix.
)md"},
      {"emitters", "", R"md(
Emitters are sources that sensors detect from a distance. An emitter belongs to a link of a robot or of any
other object. [Lights](../sdf-sensors.md#lights) are elements of SDFormat. The event
[`set_emitter`](events.md#set_emitter-in-events) changes emitters of links and of the world. Emitters of an
object that is not in the world are off.
)md"},
      {"physics", "", R"md(
These elements define how a world is simulated, and its materials and fluids.

## Air and water

The forces of air and water are computed in every step. Models have
[rotors](actuators.md#cohortrotor-name-in-model), [fins](#cohortfin-name-in-link) and
[drag](#cohortdrag-name-in-link) as elements. The following forces need no such element.

**Buoyancy.** In a world with water, the buoyant force on each collision of a non-static model is the weight of
the water that it displaces. Overlapping volumes count twice. Describe a hull by convex collisions that together
displace the right volume. Buoyancy does not depend on the mass of the hull, which `<cohort:density>` or
`<inertial>` defines. There is no buoyancy in air. The view does not draw the water.

**Wind.** The `<wind>` of the world acts on links with `<enable_wind>`, set for the link or for its model. Above
the water, the wind exerts the force mass × factor × (wind − link velocity) on each such link, as in Gazebo's
WindEffects. The factor is the `force_approximation_scaling_factor` of [`<cohort:air>`](#cohortair-in-world).
Rotors, fins and drag of these links use the velocity relative to the wind, even with a factor of 0.

**Current.** Fins, drag and rotors in the water use the velocity relative to the current.
)md"},
      {"density", "collision", R"md(
The density of a collision takes precedence over that of its link. See
[`<cohort:density>` of a link](#cohortdensity-in-link).
)md"},
      {"density", "link", R"md(
The density is in kg/m³, as in `<cohort:density>700</cohort:density>`. The mass, centre of mass and inertia of
the link are computed from its collisions. Collisions without a density have no mass, and overlapping volumes
count twice. Boxes, spheres, cylinders, capsules and ellipsoids use closed-form formulas. Meshes use integrals
over the volume of their convex hull. The element replaces `<inertial>`. Beside it, `<inertial>` may have a `<mass>`
only: the link then has this mass, and the inertia is scaled to it.
)md"},
      {"terrain", "heightmap", R"md(
A `<heightmap>` with this element needs no `<uri>`. Its `<size>` gives the sides of the rectangle and, as z, the
maximum height; the minimum height is 0. The grid has at most 4097 height samples along each side. The heights
are the same on every machine. In these formulas, x and y are measured from the corner with the smallest x and
y, and λ is the wavelength.

- `sine`: z (1 + sin 2πx/λ sin 2πy/λ) / 2.
- `ramp`, `steps`: a ramp or stairs that rise along x.
- `hills`: smooth ground, interpolated between random heights on a grid with the wavelength as its spacing
  (value noise).
- `rough`: every height sample is random.
)md"},
      {"material", "collision", R"md(
For example, `<cohort:material>rubber</cohort:material>`. The name has no effect by itself; [material
pairs](#cohortmaterial_pair-in-world) refer to it.
)md"},
      {"material_pair", "world", R"md(
These parameters replace those of the two surfaces at their contacts. Define each pair once, in either order.
The world must have at least one collision of each of the two materials.
)md"},
      {"mimic", "joint", R"md(
The coupling acts like a gear, a belt or a linkage between the two joints. The URDF element `<mimic>` and the
SDF joint type `gearbox` have the same effect.
)md"},
      {"breakable_joint", "world", R"md(
The two links are connected in their initial relative pose, by default rigidly. A joint that turns has no limits
and no motor; use a joint of a model for these. The joint breaks after the first step in
which its force, or its torque about the joint's origin, was above the limit. The run's list of events then
contains the cause: `joint 'shelf' broke at 12.1 N`.

The joint is also released if one of its objects leaves the world, breaks or is moved by an event. If the object
returns, the joint does not. The two objects can still collide with each other. Leave a gap between them;
otherwise their contact carries part of the load. The quantity
[`joint_force`](experiments.md#print-in-experiment) prints the forces on both links. With `fidelity: planar`,
the joint constrains only motion in the plane, and only forces along x and y and torques about z count.
)md"},
      {"physics", "world", R"md(
A world has at most one such element. The map `physics` of an experiment has the same keys, which take
precedence over those of the world.

**Leaving the world.** A body leaves the world when the origin of its root link is below `lowest`, or 1,000 km
away from that of the world along an axis. From then on it is not simulated, until an event puts it back. If
`lowest` is absent, the ground decides how far a body can fall:

- In a world without static models, or none that has collisions, there is no limit.
- Otherwise, the limit is 10 m below the lowest static collision, and 10 m below the lowest place at which an
  object was put. It changes when objects are added, moved or deleted. Objects that events have removed still
  count, because they can return. A sloping plane has no end and sets no limit.
- With `fidelity: planar`, there is no limit, because bodies keep their height.

**Sleeping.** [Sleep](../fidelity.md#sleep) describes which bodies sleep and what wakes them.

**Fidelity.** `articulated` simulates every joint and wheel. With `treel`, each
[`treel_drive`](actuators.md#cohorttreel_drive-name-in-model) replaces the wheels that it names. With `planar`,
bodies on flat ground have only a position in the plane and a heading:

- Planar bodies keep their height and stay on the ground on which they started. Their outlines, seen from above,
  collide. Motors turn their joints as commanded. Free objects slide and never tip or roll.
- Gravity must point along -z, the ground must be level under everything that moves, and walls must be upright.
  Robots must be placed upright, and no joint may move a link relative to the world.
- Water, belts, rotors, fins, drag and links with `<enable_wind>` are not supported.

**Dynamics.** The SDF element `<physics type="bullet">` has the same meaning as `bullet`. If it names another
engine, Cohort warns and ignores the name.

**Solver.** `convex` solves all joints and contacts of a group of bodies at once, by the same equations for any
robot. `iterative` makes a few passes of sequential impulses. It is less exact and faster, above all for robots
that grip each other. `direct` uses Dantzig's algorithm, which solves each group of bodies
that are connected or in contact simultaneously. `hybrid` solves small groups directly and large groups
iteratively.
)md"},
      {"air", "world", R"md(
A world has at most one such element.
)md"},
      {"water", "world", R"md(
A world has at most one such element.
)md"},
      {"fin", "link", R"md(
To make a movable fin, such as a rudder, add it to a link that a joint moves. A fin acts in water or in air,
depending on its position. Wind acts on the fins of links with [`<enable_wind>`](#air-and-water).

The parameters are those of Gazebo's LiftDrag, with the same meaning. Lift is ½ density v² `area` × its
coefficient, perpendicular to the flow in the plane of x and z. Drag is along the flow. v is the flow velocity
in that plane. If the flow comes from the side, lift and drag decrease with the cosine of the sweep angle.
Beyond `alpha_stall`, the lift never changes its sign. A flow from behind also causes lift and drag; in Gazebo,
it has no effect. There is no `cma`, because Gazebo reads it but sets it to 0.
)md"},
      {"drag", "link", R"md(
Velocities are relative to the water or the air, depending on the position of the element. Wind contributes to
the drag of links with [`<enable_wind>`](#air-and-water). Without `density`, the coefficients are the same in
both fluids. For a hull in water, choose a `pose` below the water surface, and set `density` to the density of
water.
)md"},
      {"placement", "", R"md(
A population places instances of a model in the world. The instances are named `POPULATION/MODEL_0`,
`POPULATION/MODEL_1`, ….

## Height of an instance

An instance is placed upright, regardless of the pose in the model file. The lowest point of its collisions and
tracks is at the height of the highest ground under its bounding circle, whose centre is the origin of the
model. Ground means planes, height maps, and static objects up to `level`, such as floors made of boxes. Where
there is no ground, the instance is placed at `level`. On a slope, it therefore starts in contact with the
uphill ground and drops a little.

## Free space

The bounding circle, enlarged by the gap, does not overlap anything that the world file or an earlier population
has placed, from the ground up to the height of the model. Instances may be placed under a bridge. Spheres,
capsules, and upright boxes and cylinders are represented by their exact outlines. Tilted boxes and cylinders,
and the hulls of non-static meshes, are represented by rectangles around their outlines, and ellipsoids by
rounded rectangles. Each triangle of a static mesh counts separately, so a whole room may be one mesh. There is
no free space inside a closed mesh.

If a position is occupied, `uniform` and `gaussian` draw another one. The other layouts skip the position, and
the numbers of the instances are those of their positions. If not all instances fit, the error says how many do.
With `may_be_fewer`, it is a warning.

## Repeatability

The random numbers for an instance depend on the seed of the run, `seed_offset`, the name of the population and
the number of the instance. The same seed gives the same poses on every machine. Adding a population after the
others does not change their poses. Placing 10,000 robots takes a few tenths of a second.
)md"},
      {"placement", "population", R"md(
A placement has exactly one of the six layouts. If `heading` is absent, headings are random in `uniform` and
`gaussian`, and fixed in the other layouts. In a formation, `heading` is the heading of the formation as a
whole.
)md"},
      {"formation", "placement", R"md(
In a column, each member is behind the previous one; in a row, it is to the right of the previous one. In a
wedge, the members are alternately behind and to the left, and behind and to the right of the first one.
)md"},
  };
  return all;
}

}  // namespace cohort::parsing
