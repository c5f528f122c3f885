// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/keys/extensions.hpp"

#include <array>
#include <iterator>
#include <tuple>
#include <vector>

#include "server/parsing/keys/choices.hpp"
#include "server/parsing/keys/device_keys.hpp"

namespace cohort::parsing {
namespace {

using enum ExtensionValue;

constexpr ExtensionKey population[] = {
    {"uri", uri, "", "", "model of the instances"},
    {"count", count, "1", "", "number of instances"},
    {"seed_offset", whole, "1", "0", "number added to the seed of the run; another number gives another placement"},
    {"placement", group, "", "", "placement of the instances"},
    {"may_be_fewer", flag, "", "false",
     "`true` to place fewer instances, with a warning, if there is not enough room; otherwise, this is an error"},
};

constexpr std::string_view patterns[] = {"column", "row", "wedge"};

constexpr ExtensionKey placement[] = {
    {"uniform", group, "", no_value, "uniformly distributed positions in a rectangle"},
    {"gaussian", group, "", no_value, "normally distributed positions around a point"},
    {"grid", group, "", no_value, "positions in rows and columns"},
    {"ring", group, "", no_value, "evenly spaced positions on a circle"},
    {"line", group, "", no_value, "evenly spaced positions from one point to another"},
    {"formation", group, "", no_value, "positions in a pattern, or listed one by one"},
    {"heading", choice, "", no_value,
     "heading of the instances: `random`, `fixed`, `towards` a point, `away` from a point, or `along` a ring or line",
     false, headings},
    {"point", point, "m", no_value, "point for the headings `towards` and `away`"},
    {"yaw", real, "rad", "0", "angle added to the heading; with `fixed`, the heading itself"},
    {"gap", non_negative, "m", "0.01",
     "minimum distance between the bounding circle of an instance and all other objects"},
    {"level", real, "m", "0", "maximum height of static objects that count as ground"},
};

constexpr ExtensionKey gaussian[] = {
    {"center", point, "m", "0 0", "mean position"},
    {"deviation", positive, "m", "", "standard deviation along x and along y"},
};

constexpr ExtensionKey grid[] = {
    {"center", point, "m", "0 0", "centre of the grid"},
    {"spacing", positive, "m", "", "distance between neighbouring rows and columns"},
    {"columns", count, "1", no_value, "number of positions in a row; a square grid if absent"},
    {"yaw", real, "rad", "0", "direction of the rows, from the x axis"},
};

constexpr ExtensionKey ring[] = {
    {"center", point, "m", "0 0", "centre of the circle"},
    {"radius", positive, "m", "", "radius of the circle"},
    {"first_bearing", real, "rad", "0",
     "bearing of the first instance, measured from the x axis; the others follow counter-clockwise"},
};

constexpr ExtensionKey line[] = {
    {"from", point, "m", "", "position of the first instance"},
    {"to", point, "m", "", "position of the last instance"},
};

constexpr ExtensionKey formation[] = {
    {"center", point, "m", "0 0", "origin of the formation frame, whose heading is that of the placement"},
    {"pattern", choice, "", no_value, "pattern of the members: `column`, `row` or `wedge`", false, patterns},
    {"spacing", positive, "m", no_value,
     "distance between neighbouring members of a pattern; in a wedge, along x and along y"},
    {"member", place, "m, rad", no_value, "x, y and heading of a member in the formation frame; may be repeated", true},
};

constexpr ExtensionKey uniform[] = {
    {"min", point, "m", "", "minimum x and y of the origins of the instances"},
    {"max", point, "m", "", "maximum x and y of the origins of the instances"},
};

constexpr ExtensionKey physics[] = {
    {"fidelity", choice, "", "treel", "level of detail of the simulation: `articulated`, `treel` or `planar`", false,
     fidelities},
    {"dynamics", choice, "", "bullet",
     "forward dynamics algorithm: Bullet's articulated-body algorithm (`bullet`) or Cohort's mass-matrix method "
     "(`cohort`); ignored with fidelity `planar`",
     false, dynamics_kinds},
    {"solver", choice, "", "convex", "solver for joints and contacts: `convex`, `iterative`, `direct` or `hybrid`",
     false, solvers},
    {"iterations", count, "1", "10", "maximum number of iterations of the iterative solver"},
    {"direct_bodies", count, "1", "4", "maximum size of a group of bodies that the `hybrid` solver solves directly"},
    {"lowest", real, "m", no_value,
     "z coordinate below which a body counts as having left the world; if absent, as described below"},
    {"sleeping", flag, "", "true",
     "`true` if bodies that have been at rest for a while are not simulated until something wakes them"},
    {"strict", flag, "", "false",
     "`true` to end the run when the state of a body becomes invalid or the body leaves the world"},
};

constexpr ExtensionKey climate[] = {
    {"temperature", non_negative, "K", "293.15", "temperature of the air"},
    {"humidity", fraction, "1", "0.5", "relative humidity of the air"},
};

constexpr ExtensionKey air[] = {
    {"density", non_negative, "kg/m^3", "1.225", "density of the air"},
    {"force_approximation_scaling_factor", non_negative, "1/s", "1",
     "wind force on links with `<enable_wind>`, per kilogram and per m/s of relative wind velocity"},
};

constexpr ExtensionKey water[] = {
    {"level", real, "m", "0", "z coordinate of the water surface"},
    {"density", positive, "kg/m^3", "1000", "density of the water"},
    {"current", vector, "m/s", "0 0 0", "velocity of the water"},
};

constexpr ExtensionKey material_pair[] = {
    {"first", name, "", "", "name of a material"},
    {"second", name, "", "", "name of another material, or of the same one"},
    {"friction", non_negative, "1", "", "Coulomb friction coefficient"},
    {"restitution", fraction, "1", "0", "coefficient of restitution"},
    {"rolling_resistance", non_negative, "m", "0",
     "rolling resistance: ratio of the resisting torque to the normal force"},
};

constexpr std::string_view axes_of_joints[] = {"axis", "axis2"};

constexpr ExtensionKey mimic[] = {
    {"joint", name, "", "", "joint of the same model that this joint follows"},
    {"multiplier", real, "1", "1", "change of this joint's position per unit of the followed joint's position"},
    {"offset", real, "rad", "0", "position of this joint when the followed joint is at 0; in m for a prismatic joint"},
    {"axis", choice, "", "axis", "`axis2` if the second axis of this universal joint follows", false, axes_of_joints},
    {"followed_axis", choice, "", "axis", "`axis2` if it follows the second axis of a universal joint", false,
     axes_of_joints},
};

constexpr std::string_view kinds_of_breakable_joints[] = {"fixed", "revolute", "ball"};

constexpr ExtensionKey breakable_joint[] = {
    {"first", name, "", "", "scoped name of an object"},
    {"first_link", name, "", no_value, "link of the first object; its root link if absent"},
    {"second", name, "", "", "scoped name of another object; at least one of the two must not be static"},
    {"second_link", name, "", no_value, "link of the second object; its root link if absent"},
    {"pose", pose, "m, rad", no_value,
     "pose of the joint in the frame of the first link; at the origin of the second link if absent"},
    {"type", choice, "", "fixed", "`fixed`, `revolute` (turns about `axis`) or `ball` (turns about any axis)", false,
     kinds_of_breakable_joints},
    {"axis", vector, "1", "0 0 1", "axis of a `revolute` joint, in the frame of the joint"},
    {"damping", non_negative, "N m s/rad", "0", "damping of a joint that turns"},
    {"breaking_force", positive, "N", no_value, "force above which the joint breaks; never if absent"},
    {"breaking_torque", positive, "N m", no_value, "torque above which the joint breaks; never if absent"},
};

constexpr std::string_view terrains[] = {"sine", "ramp", "steps", "hills", "rough"};

constexpr ExtensionKey terrain[] = {
    {"kind", choice, "", "", "shape of the ground: `sine`, `ramp`, `steps`, `hills` or `rough`", false, terrains},
    {"spacing", positive, "m", "0.05", "maximum distance between neighbouring height samples"},
    {"wavelength", positive, "m", "1", "length of a wave, a ramp or a step, or distance between hills"},
    {"seed", whole, "1", "0", "seed of the random shapes `hills` and `rough`"},
};

constexpr Extension of_worlds[] = {
    {"density",
     "collision",
     false,
     "Density of this collision, from which the mass of the link is computed.",
     {},
     "physics",
     positive},
    {"density",
     "link",
     false,
     "Density of all collisions of the link, from which the mass of the link is computed.",
     {},
     "physics",
     positive},
    {"climate", "world", false, "Temperature and humidity of the air far from all climate sources.", climate,
     "emitters"},
    {"air", "world", false, "Properties of the air.", air, "physics"},
    {"water", "world", false, "Water below a level surface.", water, "physics"},
    {"terrain", "heightmap", false, "Ground whose heights are computed by a function instead of read from an image.",
     terrain, "physics"},
    {"material", "collision", false, "Name of the material of a collision.", {}, "physics", name},
    {"material_pair", "world", false, "Contact parameters for two materials.", material_pair, "physics"},
    {"mimic", "joint", false, "A coupling that makes the joint follow another joint; its force acts on both joints.",
     mimic, "physics"},
    {"breakable_joint", "world", true, "A joint that connects links of two objects until it is overloaded.",
     breakable_joint, "physics"},
    {"physics", "world", false, "Settings of the physics simulation.", physics, "physics"},
    {"population", "world", true, "Instances of one model, placed in the world by a layout and the seed of the run.",
     population, "placement"},
    {"placement", "population", false, "Placement of the instances of a population.", placement, "placement"},
    {"uniform", "placement", false, "Uniformly distributed positions in a rectangle.", uniform, "placement"},
    {"gaussian", "placement", false, "Normally distributed positions around a point.", gaussian, "placement"},
    {"grid", "placement", false, "Positions in rows and columns; the first row has the smallest y.", grid, "placement"},
    {"ring", "placement", false, "Evenly spaced positions on a circle.", ring, "placement"},
    {"line", "placement", false, "Evenly spaced positions on a line, including both ends.", line, "placement"},
    {"formation", "placement", false, "Positions in a pattern, or listed one by one.", formation, "placement"},
};

std::vector<Extension> all_extensions() {
  std::vector<Extension> all;
  const auto add = [&]<class Kind>(std::type_identity<Kind>) { all.push_back(keys::extension_of<Kind>); };
  keys::for_kinds_in(keys::devices, add);
  all.push_back(keys::extension_of<GripRing>);
  all.push_back(keys::extension_of<Fin>);
  all.push_back(keys::extension_of<Drag>);
  all.push_back({"grippable",
                 "collision",
                 false,
                 "`true` if grippers can grasp the collision at any point.",
                 {},
                 "actuators",
                 flag});
  keys::for_kinds_in(keys::emitters, add);
  all.insert(all.end(), std::begin(of_worlds), std::end(of_worlds));
  return all;
}

}  // namespace

std::span<const Extension> extensions() {
  static const std::vector<Extension> table = all_extensions();
  return table;
}

std::span<const ExtensionKey> sensor_keys() {
  static constexpr auto keys = std::apply(
      [](const auto&... each) {
        return std::array<ExtensionKey, sizeof...(each)>{static_cast<const ExtensionKey&>(each)...};
      },
      keys::readout_keys);
  return keys;
}

const Extension* find_extension(std::string_view extension_name, std::string_view parent) {
  for (const Extension& extension : extensions())
    if (extension.name == extension_name && extension.parent == parent) return &extension;
  return nullptr;
}

}  // namespace cohort::parsing
