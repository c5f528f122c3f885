#include "server/parsing/keys/extensions.hpp"

#include <iterator>
#include <vector>

#include "server/parsing/keys/choices.hpp"
#include "server/parsing/keys/device_keys.hpp"

namespace cohort::parsing {
namespace {

using enum ExtensionValue;

constexpr ExtensionKey population[] = {
    {"uri", uri, "", "", "the model"},
    {"count", count, "1", "", "number of instances"},
    {"seed_offset", whole, "1", "0", "added to the seed of the run: another value, another placement"},
    {"placement", group, "", "", "where they are put"},
    {"may_be_fewer", flag, "", "false",
     "if there is no room for all: a warning that says how many fitted, not an error"},
};

constexpr std::string_view patterns[] = {"column", "row", "wedge"};

constexpr ExtensionKey placement[] = {
    {"uniform", group, "", no_value, "anywhere in a rectangle with equal probability"},
    {"gaussian", group, "", no_value, "normally distributed around a point"},
    {"grid", group, "", no_value, "in rows and columns"},
    {"ring", group, "", no_value, "evenly around a circle"},
    {"line", group, "", no_value, "evenly from one point to another"},
    {"formation", group, "", no_value, "in a pattern, or one by one"},
    {"heading", choice, "", no_value, "`random`, `fixed`, `towards` or `away` from a point, or `along` a ring or line",
     false, headings},
    {"point", point, "m", no_value, "of the headings `towards` and `away`"},
    {"yaw", real, "rad", "0", "added to the heading; of a fixed one, all of it"},
    {"gap", non_negative, "m", "0.01", "kept free between an instance's bounding circle and everything else"},
    {"level", real, "m", "0", "static things no higher than this are ground to stand on"},
};

constexpr ExtensionKey gaussian[] = {
    {"center", point, "m", "0 0", "the mean place"},
    {"deviation", positive, "m", "", "standard deviation along x and along y"},
};

constexpr ExtensionKey grid[] = {
    {"center", point, "m", "0 0", "middle of the grid"},
    {"spacing", positive, "m", "", "from one row or column to the next"},
    {"columns", count, "1", no_value, "places in a row; as many as there are rows if absent"},
    {"yaw", real, "rad", "0", "direction of the rows, from the x axis"},
};

constexpr ExtensionKey ring[] = {
    {"center", point, "m", "0 0", "middle of the circle"},
    {"radius", positive, "m", "", "of the circle"},
    {"first_bearing", real, "rad", "0", "where the first instance is, from the x axis; the others counter-clockwise"},
};

constexpr ExtensionKey line[] = {
    {"from", point, "m", "", "where the first instance is"},
    {"to", point, "m", "", "where the last one is"},
};

constexpr ExtensionKey formation[] = {
    {"center", point, "m", "0 0", "where the frame of the formation is; its heading is that of the placement"},
    {"pattern", choice, "", no_value, "`column`, `row` or `wedge`", false, patterns},
    {"spacing", positive, "m", no_value, "of a pattern: from one member to the next; in a wedge, ahead and aside"},
    {"member", place, "m, rad", no_value, "a place: x, y and heading in the frame of the formation; any number", true},
};

constexpr ExtensionKey uniform[] = {
    {"min", point, "m", "", "corner with the least x and y of the origins of the instances"},
    {"max", point, "m", "", "corner with the greatest x and y"},
};

constexpr ExtensionKey physics[] = {
    {"fidelity", choice, "", "treel", "how much of a model is simulated: `articulated`, `treel` or `planar`", false,
     fidelities},
    {"dynamics", choice, "", "bullet",
     "how bodies come by their velocities: `bullet`, with its articulated bodies, or `cohort`, with our own mass "
     "matrix; without meaning in `planar`",
     false, dynamics_kinds},
    {"solver", choice, "", "iterative", "of joints and contacts: `iterative`, `direct` or `hybrid`", false, solvers},
    {"iterations", count, "1", "10", "of the iterative solver, at the most"},
    {"direct_bodies", count, "1", "4", "`hybrid`: the most bodies that are solved directly together"},
    {"lowest", real, "m", no_value, "a body below this z has left the world"},
    {"sleeping", flag, "", "true", "whether steps pass over what has been still for a while"},
    {"strict", flag, "", "false", "whether a body that breaks or leaves the world ends the run"},
};

constexpr ExtensionKey climate[] = {
    {"temperature", non_negative, "K", "293.15", "of the air"},
    {"humidity", fraction, "1", "0.5", "relative"},
};

constexpr ExtensionKey air[] = {
    {"density", non_negative, "kg/m^3", "1.225", "of the air"},
    {"force_approximation_scaling_factor", non_negative, "1/s", "1",
     "of links that feel the wind: force for each kilogram, and m/s of wind that passes them"},
};

constexpr ExtensionKey water[] = {
    {"level", real, "m", "0", "z of its surface"},
    {"density", positive, "kg/m^3", "1000", "of the water"},
    {"current", vector, "m/s", "0 0 0", "its velocity"},
};

constexpr ExtensionKey material_pair[] = {
    {"first", name, "", "", "a material"},
    {"second", name, "", "", "another, or the same"},
    {"friction", non_negative, "1", "", "Coulomb coefficient"},
    {"restitution", fraction, "1", "0", "share of the normal velocity that comes back"},
    {"rolling_resistance", non_negative, "m", "0", "torque against rolling for each newton of normal force"},
};

constexpr ExtensionKey mimic[] = {
    {"joint", name, "", "", "the joint that it follows, of the same model"},
    {"multiplier", real, "1", "1", "its position for each radian or metre of that joint's"},
    {"offset", real, "rad", "0", "its position where that joint's is 0; of one that slides, in metres"},
};

constexpr ExtensionKey breakable_joint[] = {
    {"first", name, "", "", "an object, by its scoped name"},
    {"first_link", name, "", no_value, "of it; its root link if absent"},
    {"second", name, "", "", "another object; one of the two moves"},
    {"second_link", name, "", no_value, "of it; its root link if absent"},
    {"pose", pose, "m, rad", no_value, "where it is, in the first link; at the origin of the second one if absent"},
    {"breaking_force", positive, "N", no_value, "above it breaks; never if absent"},
    {"breaking_torque", positive, "N m", no_value, "above it breaks; never if absent"},
};

constexpr std::string_view terrains[] = {"sine", "ramp", "steps", "hills", "rough"};

constexpr ExtensionKey terrain[] = {
    {"kind", choice, "", "", "`sine`, `ramp`, `steps`, `hills` or `rough`", false, terrains},
    {"spacing", positive, "m", "0.05", "between neighbouring heights, at the most"},
    {"wavelength", positive, "m", "1", "of the waves; length of a step; distance between hills"},
    {"seed", whole, "1", "0", "of `hills` and `rough`: another value, another ground"},
};

constexpr Extension of_worlds[] = {
    {"density",
     "collision",
     false,
     "The link's mass is that of its collisions; this one has this density.",
     {},
     "physics",
     positive},
    {"density",
     "link",
     false,
     "The link's mass is that of its collisions, which have this density.",
     {},
     "physics",
     positive},
    {"climate", "world", false, "Temperature and humidity where no source is near.", climate, "emitters"},
    {"air", "world", false, "The air that bodies move in.", air, "physics"},
    {"water", "world", false, "Water below a level surface.", water, "physics"},
    {"terrain", "heightmap", false, "Ground that a function describes, in place of an image.", terrain, "physics"},
    {"material", "collision", false, "The name of what a collision is made of.", {}, "physics", name},
    {"material_pair", "world", false, "What holds where two materials touch.", material_pair, "physics"},
    {"mimic", "joint", false, "Lets the joint follow another one, by a force that both feel.", mimic, "physics"},
    {"breakable_joint", "world", true, "Holds links of two objects together until that takes too much.",
     breakable_joint, "physics"},
    {"physics", "world", false, "How the world is simulated.", physics, "physics"},
    {"population", "world", true, "Instances of one model, placed by the seed of the run.", population, "placement"},
    {"placement", "population", false, "Where the instances of a population are put.", placement, "placement"},
    {"uniform", "placement", false, "A rectangle of the ground.", uniform, "placement"},
    {"gaussian", "placement", false, "Around a point.", gaussian, "placement"},
    {"grid", "placement", false, "In rows and columns, the first row at the least y.", grid, "placement"},
    {"ring", "placement", false, "Evenly around a circle.", ring, "placement"},
    {"line", "placement", false, "Evenly along a line, with both ends.", line, "placement"},
    {"formation", "placement", false, "In a pattern, or at places given one by one.", formation, "placement"},
};

std::vector<Extension> all_extensions() {
  std::vector<Extension> all;
  const auto add = [&]<class Kind>(std::type_identity<Kind>) { all.push_back(keys::extension_of<Kind>); };
  keys::for_kinds_in(keys::devices, add);
  all.push_back(keys::extension_of<GripRing>);
  all.push_back(keys::extension_of<Fin>);
  all.push_back(keys::extension_of<Drag>);
  all.push_back(
      {"grippable", "collision", false, "Whether grippers can hold on to it, anywhere.", {}, "actuators", flag});
  keys::for_kinds_in(keys::emitters, add);
  all.insert(all.end(), std::begin(of_worlds), std::end(of_worlds));
  return all;
}

}  // namespace

std::span<const Extension> extensions() {
  static const std::vector<Extension> table = all_extensions();
  return table;
}

const Extension* find_extension(std::string_view extension_name, std::string_view parent) {
  for (const Extension& extension : extensions())
    if (extension.name == extension_name && extension.parent == parent) return &extension;
  return nullptr;
}

}  // namespace cohort::parsing
