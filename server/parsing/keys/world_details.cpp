#include "server/parsing/keys/details.hpp"

namespace cohort::parsing {

std::span<const Explanation> world_explanations() {
  static constexpr Explanation all[] = {
      {"values", "", R"md(
All values are in SI units: m, kg, s, rad, N, N m. Frames are right-handed, with z up and x forward. All
numbers are finite. A pose is `x y z roll pitch yaw`, with rotations about the fixed axes x, then y, then z. It
may also be `x y z qx qy qz qw`, with a quaternion. In YAML, a pose or vector is text as in SDF or a list of
numbers.

A key without a default that is not required may be absent; then it has no value. Names are those of links,
joints and devices of the same model. A scoped name includes the group of the object, as in `team/sbot_1`.

In SDF, declare the prefix once: `<sdf version="1.9" xmlns:cohort="https://cohort-sim.org/sdf/1">`. Every key
of a `cohort:` element is an element with the same prefix. In [YAML](../worlds-in-yaml.md) the prefix of these
keys may be left out.
)md"},
      {"emitters", "", R"md(
Emitters are what sensors perceive from afar. They belong to a link, of a robot or of any other object.
[Lights](../sdf-sensors.md#lights) are elements of SDFormat. The event
[`set_emitter`](events.md#set_emitter-in-events) changes emitters of links and of the world. Emitters of an
object that is not in the world are off.
)md"},
      {"physics", "", R"md(
These elements say how a world is simulated and what it is made of.

## Air and water

The forces of air and water are computed in every step. [Rotors](actuators.md#cohortrotor-name-in-model),
[fins](#cohortfin-name-in-link) and [drag](#cohortdrag-name-in-link) are elements of models. The following
forces act without them.

**Buoyancy.** In a world with water, each collision of a model that moves is lifted by the weight of the water
that it displaces. Where collisions overlap, this counts twice. Describe a hull by convex parts that displace
the right volume. The contents of a hull do not matter: `<cohort:density>` or `<inertial>` gives its weight.
Nothing floats in air. The view does not draw the water.

**Wind.** The `<wind>` of the world acts on links with `<enable_wind>`, set for the link or for its model.
Above the water, each link gets the force mass × factor × (wind − its velocity), as in Gazebo's WindEffects.
Its rotors, fins and drag use the velocity relative to the wind. A factor of 0 leaves only the latter.

**Current.** Fins, drag and rotors in the water use the velocity relative to its current.
)md"},
      {"density", "collision", R"md(
The density of a collision takes precedence over that of its link. See
[`<cohort:density>` of a link](#cohortdensity-in-link).
)md"},
      {"density", "link", R"md(
The density is in kg/m³, as in `<cohort:density>700</cohort:density>`. Mass, centre of mass and inertia of the
link follow from its collisions. Collisions without a density have no mass, and overlaps count twice. Boxes,
spheres, cylinders, capsules and ellipsoids use their closed forms. Meshes use integrals over the volume of
their convex hull. The element replaces `<inertial>`; a link with both is an error.
)md"},
      {"terrain", "heightmap", R"md(
The `<heightmap>` then needs no `<uri>`. Its `<size>` is that of the rectangle, and heights go from 0 to the z
of the size. There are at most 4097 heights along a side. The heights are the same on every machine. x and y are
measured from the corner with the least x and y, and λ is the wavelength.

- `sine`: z (1 + sin 2πx/λ sin 2πy/λ) / 2.
- `ramp`, `steps`: the ground rises along x.
- `hills`: smooth ground through random heights at every wavelength along x and y (value noise).
- `rough`: every height is random.
)md"},
      {"material", "collision", R"md(
For example `<cohort:material>rubber</cohort:material>`. The name changes nothing by itself;
[material pairs](#cohortmaterial_pair-in-world) refer to it.
)md"},
      {"material_pair", "world", R"md(
The values replace those of the two surfaces. Each pair is given once, in either order. The world must have a
collision of each of the two materials.
)md"},
      {"mimic", "joint", R"md(
It acts as a gear, a belt or a linkage between the two joints. The `<mimic>` of URDF means the same, and so
does a `gearbox` joint of SDF for the two joints that it couples.
)md"},
      {"breakable_joint", "world", R"md(
The links keep the relative pose that they have at the start, and nothing moves between them. The joint breaks
after the first step over which the force, or the torque about the joint's origin, was above the limit. The
list of events of the run then has the cause: `joint 'shelf' broke at 12.1 N`.

The joint is also released if one of its objects leaves the world, breaks or is moved by an event. It does not
return with the object. The two objects still collide with each other. Leave a gap between them; otherwise their
contact carries a part of the load. The quantity [`joint_force`](experiments.md#print-in-experiment) prints the
forces at both ends. With `fidelity: planar` the joint holds in the plane, and only forces in x and y and
torques about z count.
)md"},
      {"physics", "world", R"md(
A world has at most one such element. The map `physics` of an experiment has the same keys, which take
precedence.

**Sleeping.** [Sleep](../fidelity.md#sleep) says which bodies sleep and what wakes them.

**Fidelity.** `articulated` simulates every joint and wheel. With `treel`, a treel drive replaces the wheels
below it. With `planar`, bodies on flat ground have position and heading only:

- Planar bodies keep their height and stay on the ground on which they started. They collide by their
  outlines from above. Motors turn their joints as commanded. Loose objects slide and never tip or roll.
- It needs gravity along -z, level ground under everything that moves, and upright walls. Robots must be placed
  upright, and no joint may move against the world.
- There is no water, and there are no belts, rotors, fins, drag or links with `<enable_wind>`.

**Dynamics.** `<physics type="bullet">` of SDF means the same as `bullet`. The name of another engine there is
a warning and changes nothing.

**Solver.** `iterative` is the method of sequential impulses. `direct` solves all bodies that are connected or
in contact at once, with Dantzig's algorithm. `hybrid` is direct for small groups and iterative for large ones.
)md"},
      {"air", "world", R"md(
A world has at most one such element.
)md"},
      {"water", "world", R"md(
A world has at most one such element.
)md"},
      {"fin", "link", R"md(
A fin that is to turn belongs to the link behind a joint. It acts in water or air, depending on its position.
Wind acts on fins of links with [`<enable_wind>`](#air-and-water).

The parameters are those of Gazebo's LiftDrag, with the same meaning. Lift is ½ density v² `area` × its
coefficient, perpendicular to the flow in the plane of x and z. Drag is along the flow. v is the velocity in that
plane. Both decrease with the cosine of the sweep angle of a flow from the side. Beyond `alpha_stall` lift never
changes its sign. A flow from behind acts too; in Gazebo it has no effect. There is no `cma`: Gazebo reads it
and sets it to 0.
)md"},
      {"drag", "link", R"md(
Velocities are relative to the water or the air, depending on the position of the element. Wind acts on the
drag of links with [`<enable_wind>`](#air-and-water). Without `density` the coefficients are the same in both
fluids. For a hull in water, put its `pose` under water and give the density of water.
)md"},
      {"placement", "", R"md(
A population puts copies of a model into the world. Its robots are called `POPULATION/MODEL_0`,
`POPULATION/MODEL_1`, ….

## Height of an instance

An instance is placed upright, independent of the pose in its own file. The lowest point of its collisions and
tracks is at the highest ground under its bounding circle. The circle is centred on the origin of the model.
Ground means planes, height maps, and static objects up to `level`, such as floors made of boxes. Where there is
no ground, the instance is placed at `level`. On a slope it therefore touches the uphill ground and drops a
little.

## Free space

The bounding circle and the gap stay clear of everything that the file or an earlier population has placed,
from the ground up to the height of the model. Instances may stand under a bridge. Spheres and capsules count
with their exact outline, and so do upright boxes and cylinders. Tilted ones, and the hull of a mesh that moves,
count with the rectangle around their outline. Ellipsoids count with a rounded one. Each triangle of a static
mesh counts separately, so a whole room may be one mesh. There is no free space inside a closed mesh.

`uniform` and `gaussian` draw again if a position is taken. The other layouts skip the position and number the
instances by their positions. If the instances do not all fit, the error says how many fit. With `may_be_fewer`
it is a warning.

## Repeatability

The draws of an instance depend on the seed of the run, the offset, the name of the population and the number
of the instance. The same seed gives the same poses on every machine. A population that is added after the
others does not change them. Placing 10,000 robots takes a few tenths of a second.
)md"},
      {"placement", "population", R"md(
It has exactly one of the six layouts. Without `heading`, headings are random in `uniform` and `gaussian`, and
fixed in the other layouts. The heading of a formation is that of the whole.
)md"},
      {"formation", "placement", R"md(
In a column each member is behind the previous one; in a row it is to the right of it. In a wedge the members
are alternately behind the first one's left and right.
)md"},
  };
  return all;
}

}  // namespace cohort::parsing
