// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "server/geometry/shapes/convex_hull.hpp"
#include "server/geometry/shapes/mass_properties.hpp"
#include "server/parsing/model/read_model.hpp"
#include "server/parsing/sdf/extension_values.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"

namespace cohort::parsing {
namespace {

using geometry::mass_properties;
using geometry::MassProperties;
using geometry::moved;
using geometry::together;

// Returns the nearest physically possible principal moments for a body of this mass, in ascending order. If all are
// nearly 0, the body is a small grain.
Eigen::Vector3d nearest_moments(const Eigen::Vector3d& moments, double mass) {
  constexpr double radius_of_grain = 1e-3;  // [m]
  Eigen::Vector3d nearest = moments.cwiseMax(mass * radius_of_grain * radius_of_grain);
  const double excess = nearest[2] - nearest[0] - nearest[1];
  if (excess > 0.0) nearest += excess / 3.0 * Eigen::Vector3d(1.0, 1.0, -1.0);
  return nearest;
}

// Returns the inertia of the collisions with the mass distributed evenly in them; nothing if the link has no solid
// collision.
std::optional<Eigen::Matrix3d> inertia_of_collisions(const Link& link, double mass) {
  std::vector<MassProperties> parts;
  for (const Collision& collision : link.collisions)
    parts.push_back(moved(mass_properties(collision.shape, 1.0), collision.X_LC));
  const MassProperties whole = together(parts);
  if (!(whole.mass > 0.0) || !whole.inertia.allFinite()) return std::nullopt;
  return mass / whole.mass * whole.inertia;
}

// Returns the solid for mass properties: nothing for planes and height maps, and the convex hull of a mesh, since
// meshes for display have gaps.
std::optional<Shape> solid_of(const Shape& shape) {
  const Mesh* const mesh = std::get_if<Mesh>(&shape);
  if (mesh == nullptr || mesh->convex) return shape;
  try {
    return Mesh{std::make_shared<const TriangleMesh>(geometry::convex_hull(mesh->triangles->vertices)), true};
  } catch (const std::invalid_argument&) {  // flat
    return std::nullopt;
  }
}

template <class Part>
MassProperties mass_of_parts(const std::vector<Part>& parts, Pose Part::*X_LP, double density) {
  std::vector<MassProperties> solids;
  for (const Part& part : parts)
    if (const std::optional<Shape> solid = solid_of(part.shape))
      solids.push_back(moved(mass_properties(*solid, density), part.*X_LP));
  return together(solids);
}

// Computes the mass of a link without one from its shapes, like MuJoCo.
Inertial inertial_of_shapes(const Link& link) {
  constexpr double density = 1000.0;        // [kg/m^3]
  constexpr double mass_of_grain = 1e-3;    // [kg]
  constexpr double moment_of_grain = 1e-6;  // [kg m^2]
  const auto is_real = [](const MassProperties& whole) {
    return whole.mass > 0.0 && std::isfinite(whole.mass) && whole.inertia.allFinite();
  };
  MassProperties whole = mass_of_parts(link.collisions, &Collision::X_LC, density);
  if (!is_real(whole)) whole = mass_of_parts(link.visuals, &Visual::X_LV, density);
  if (!is_real(whole)) return {mass_of_grain, {}, moment_of_grain * Eigen::Matrix3d::Identity()};
  return {whole.mass, {whole.centre, Eigen::Quaterniond::Identity()}, whole.inertia};
}

// A repaired moment of inertia is at least that of the collisions with this part of the mass. A smaller one, such as
// that of a grain in place of 0, would let a link of everyday size spin about one axis without end.
constexpr double least_density = 1e-3;

// NaN passes here and below, since check_numbers has reported it.
Inertial read_written_inertial(const Element* element, const Link& link, const SdfReport& report) {
  const Element* const mass = find(element, {"inertial", "mass"});
  const Element* const inertia = find(element, {"inertial", "inertia"});
  if (mass != nullptr && mass->real() == 0.0 && SdfReport::is_foreign(mass))
    return inertial_of_shapes(link);  // already reported
  if (mass == nullptr) report.warning(element, "has no mass; SDF's default of 1 kg is used");
  if (inertia == nullptr) report.warning(element, "has no inertia; SDF's default of 1 kg m^2 about each axis is used");

  Inertial inertial;
  if (const Element* const pose = find(element, {"inertial", "pose"}))
    inertial.X_LI = written_pose(pose->node()).value_or(Pose{});
  if (mass != nullptr) {
    inertial.mass = mass->real();
    if (inertial.mass <= 0.0 || std::isinf(inertial.mass))
      report.problem(mass, "expected a mass > 0 kg, not " + mass->text());
  }
  if (inertia == nullptr) return inertial;

  const auto component = [&](const char* name) { return inertia->real(name); };
  const double xx = component("ixx"), yy = component("iyy"), zz = component("izz");
  const double xy = component("ixy"), xz = component("ixz"), yz = component("iyz");
  inertial.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  if (!inertial.inertia.allFinite()) {
    if (!inertial.inertia.hasNaN()) report.problem(inertia, "expected finite moments of inertia");
    return inertial;
  }
  if (const auto solid = inertial.inertia.isZero(0.0) ? inertia_of_collisions(link, inertial.mass) : std::nullopt) {
    if (report.flaw(inertia, "the matrix is not positive definite", "the inertia of the collisions is used instead")) {
      inertial.X_LI.orientation.setIdentity();
      inertial.inertia = *solid;
    }
    return inertial;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertial.inertia);
  const Eigen::Vector3d& moments = solver.eigenvalues();
  // Bodies of positive mass satisfy the triangle inequality, thin ones with equality.
  constexpr double rounding = 1e-6;
  const char* flaw = nullptr;
  if (!(moments[0] > 0.0))
    flaw = "the matrix is not positive definite";
  else if (moments[2] > (moments[0] + moments[1]) * (1.0 + rounding))
    flaw = "no physical body has this inertia: one principal moment exceeds the sum of the other two";
  if (flaw != nullptr && report.flaw(inertia, flaw, "the nearest physically possible inertia is used instead")) {
    const Eigen::Matrix3d& axes = solver.eigenvectors();
    Eigen::Vector3d usable = nearest_moments(moments, inertial.mass);
    if (const auto solid = inertia_of_collisions(link, least_density * inertial.mass))
      usable = usable.cwiseMax((axes.transpose() * *solid * axes).diagonal());
    const Eigen::Matrix3d nearest = axes * usable.asDiagonal() * axes.transpose();
    inertial.inertia = 0.5 * (nearest + nearest.transpose());
  }
  return inertial;
}

// Returns the spatial inertia of a link about its origin.
SpatialMatrix spatial_inertia(const Inertial& inertial) {
  const Eigen::Matrix3d R = inertial.X_LI.orientation.toRotationMatrix();
  const Eigen::Vector3d& centre = inertial.X_LI.position;
  Eigen::Matrix3d cross;
  cross << 0.0, -centre.z(), centre.y(), centre.z(), 0.0, -centre.x(), -centre.y(), centre.x(), 0.0;
  SpatialMatrix matrix;
  matrix << R * inertial.inertia * R.transpose() - inertial.mass * cross * cross, inertial.mass * cross,
      -inertial.mass * cross, inertial.mass * Eigen::Matrix3d::Identity();
  return matrix;
}

// Reads the upper triangle of a matrix in the order of SDF: x, y, z, then the rotations p, q, r about them.
std::shared_ptr<const SpatialMatrix> read_added_mass(const Element& link, const Inertial& inertial,
                                                     const SdfReport& report) {
  const Element* const element = find(&link, {"inertial", "fluid_added_mass"});
  if (element == nullptr) return nullptr;
  constexpr std::string_view axes = "pqrxyz";
  constexpr std::string_view order = "xyzpqr";
  SpatialMatrix matrix;
  for (int i = 0; i < matrix.rows(); ++i) {
    for (int j = 0; j < matrix.cols(); ++j) {
      std::string name{axes[static_cast<std::size_t>(i)], axes[static_cast<std::size_t>(j)]};
      if (order.find(name[0]) > order.find(name[1])) std::swap(name[0], name[1]);
      matrix(i, j) = element->real(name);
    }
  }
  if (matrix.isZero(0.0)) return nullptr;
  const Eigen::LLT<SpatialMatrix> whole(spatial_inertia(inertial) + matrix);
  if (!matrix.allFinite() || whole.info() != Eigen::Success)
    report.problem(element, "expected a matrix that makes the inertia of the link positive definite");
  return std::make_shared<const SpatialMatrix>(matrix);
}

// Returns <cohort:density> of a link or a collision; nothing if it has none.
std::optional<double> read_density(const Element* parent, const SdfReport& report) {
  const Element* const element = parent->child("cohort:density");
  if (element == nullptr) return std::nullopt;
  if (const Element* const again = element->next_alike()) report.problem(again, "<cohort:density> is given twice");
  const auto values = ExtensionValues::read(element, *find_extension("density", parent->name()), report);
  return values ? std::optional(values->real("density")) : std::nullopt;
}

// Returns nothing if neither the link nor any of its collisions has a density.
std::optional<Inertial> read_inertial_from_density(const Element* element, const Link& link, const SdfReport& report) {
  const std::optional<double> of_link = read_density(element, report);
  bool has_density = of_link.has_value();
  std::vector<MassProperties> parts;
  const std::vector<const Element*> collisions = children_of(*element, "collision");
  for (const Collision& collision : link.collisions) {
    const auto written =
        std::ranges::find(collisions, collision.name, [](const Element* each) { return name_of(*each); });
    const auto own = read_density(*written, report);
    has_density = has_density || own;
    if (const std::optional<double> density = own ? own : of_link)
      parts.push_back(moved(mass_properties(collision.shape, *density), collision.X_LC));
  }
  if (!has_density) return std::nullopt;
  const Element* const mass = find(element, {"inertial", "mass"});
  const auto is_given = [&](const char* part) { return is_written(find(element, {"inertial", part})); };
  if (const Element* const written = element->child("inertial");
      written != nullptr && (written->children().empty() || is_given("pose") || is_given("inertia")))
    report.problem(written, "expected either <inertial> or <cohort:density>, not both, unless it has only a <mass>");
  MassProperties whole = together(parts);
  if (is_written(mass) && whole.mass > 0.0) {
    const auto given = mass->real();
    if (!(given > 0.0) || std::isinf(given)) report.problem(mass, "expected a mass > 0 kg, not " + mass->text());
    whole.inertia *= given / whole.mass;
    whole.mass = given;
  }
  if (!(whole.mass > 0.0) && link.collisions.size() == collisions.size())
    report.problem(element, "<cohort:density> requires a <collision> with a volume");
  if (!std::isfinite(whole.mass) || !whole.inertia.allFinite())
    report.problem(element,
                   "the mass or inertia of the collisions is not finite: check their sizes and <cohort:density>");
  return Inertial{whole.mass, {whole.centre, Eigen::Quaterniond::Identity()}, whole.inertia};
}

double read_coefficient(const Element* element, double by_default, double greatest, const char* expected,
                        const SdfReport& report) {
  if (element == nullptr) return by_default;
  const auto value = element->real();
  if (!(value < 0.0) && !(value > greatest)) return value;
  const double nearest = value < 0.0 ? 0.0 : greatest;
  return report.flaw(element, expected, "the nearest valid value is used instead") ? nearest : value;
}

// Reads a friction coefficient. A negative one means unlimited friction in ODE.
double read_friction_coefficient(const Element* element, const SdfReport& report) {
  constexpr double as_if_glued = 1e3;
  const char* const expected = "expected a coefficient >= 0";
  if (element != nullptr && element->real() < 0.0 && report.flaw(element, expected, "unlimited friction is used"))
    return as_if_glued;
  return read_coefficient(element, 1.0, std::numeric_limits<double>::max(), expected, report);
}

std::uint32_t read_material(const Element* collision, const ModelReading& reading) {
  const Element* const element = collision->child("cohort:material");
  if (element == nullptr) return 0;
  if (const Element* const again = element->next_alike())
    reading.report.problem(again, "<cohort:material> is given twice");
  const auto values = ExtensionValues::read(element, *find_extension("material", "collision"), reading.report);
  if (!values) return 0;
  std::vector<std::string>& materials = reading.materials;
  const auto found = std::find(materials.begin(), materials.end(), values->text("material"));
  const auto index = static_cast<std::uint32_t>(found - materials.begin());
  if (found == materials.end()) materials.push_back(values->text("material"));
  return index;
}

bool read_grippable(const Element* collision, const SdfReport& report) {
  const Element* const element = collision->child("cohort:grippable");
  if (element == nullptr) return false;
  const auto values = ExtensionValues::read(element, *find_extension("grippable", "collision"), report);
  return values && values->flag("grippable");
}

// Reads the 16 bits of a bitmask; SDF ignores higher bits.
std::uint16_t read_bitmask(const Element* element, std::uint16_t by_default) {
  return is_written(element) ? static_cast<std::uint16_t>(element->count()) : by_default;
}

// Reads friction from <ode> or, without it, from <bullet>.
void read_friction(const Element& collision, const SdfReport& report, Surface& surface) {
  const Element* const element = friction_of(collision);
  const bool is_bullet = element != nullptr && element->name() == "bullet";
  surface.friction = read_friction_coefficient(find(element, {is_bullet ? "friction" : "mu"}), report);
  surface.second_friction = read_friction_coefficient(find(element, {is_bullet ? "friction2" : "mu2"}), report);
  const Element* const direction = find(element, {"fdir1"});
  if (!is_written(direction)) return;
  const auto unit = written_unit_vector(direction);
  surface.friction_direction = unit ? *unit : direction->vector().normalized();
}

// Reads softness from <ode> or, without it, from <bullet>.
void read_softness(const Element* contact, const SdfReport& report, Surface& surface) {
  const Element* const element = find(contact, {find(contact, {"ode"}) != nullptr ? "ode" : "bullet"});
  const Element* const stiffness = find(element, {"kp"});
  if (is_written(stiffness)) surface.stiffness = stiffness->real();
  if (!(surface.stiffness > 0.0) && !std::isnan(surface.stiffness) &&
      report.flaw(stiffness, "expected a stiffness > 0 N/m", "the contact is rigid"))
    surface.stiffness = Surface{}.stiffness;
  surface.damping = read_coefficient(find(element, {"kd"}), surface.damping, std::numeric_limits<double>::max(),
                                     "expected a damping >= 0 N s/m", report);
}

// Reads the ratio of the torque against spinning to the normal force: 3 pi / 16 times the radius of the contact patch
// times the coefficient ("Torsional friction", tutorial of Gazebo).
double read_spinning_resistance(const Element* torsional, const SdfReport& report) {
  const char* const expected = "expected a radius >= 0 m";
  const double most = std::numeric_limits<double>::max();
  const double coefficient =
      read_coefficient(find(torsional, {"coefficient"}), 1.0, most, "expected a coefficient >= 0", report);
  const double radius = read_coefficient(find(torsional, {"patch_radius"}), 0.0, most, expected, report);
  read_coefficient(find(torsional, {"surface_radius"}), 0.0, most, expected, report);
  const Element* const by_patch = find(torsional, {"use_patch_radius"});
  if (!is_written(by_patch) || by_patch->flag()) return 3.0 * std::numbers::pi / 16.0 * radius * coefficient;
  report.warning(by_patch, "a contact patch that grows with depth is not supported; set <patch_radius>");
  return 0.0;
}

Surface read_surface(const Element* collision, const ModelReading& reading) {
  const Surface by_default;
  const SdfReport& report = reading.report;
  const double most = std::numeric_limits<double>::max();
  Surface surface;
  read_friction(*collision, report, surface);
  surface.restitution = read_coefficient(find(collision, {"surface", "bounce", "restitution_coefficient"}),
                                         by_default.restitution, 1.0, "expected a coefficient from 0 to 1", report);
  const Element* const threshold = find(collision, {"surface", "bounce", "threshold"});
  if (is_written(threshold))
    surface.bounce_threshold = read_coefficient(threshold, 0.0, most, "expected a velocity >= 0 m/s", report);
  surface.rolling_resistance =
      read_coefficient(find(collision, {"surface", "friction", "bullet", "rolling_friction"}),
                       by_default.rolling_resistance, most, "expected a rolling resistance >= 0 m", report);
  surface.spinning_resistance = read_spinning_resistance(find(collision, {"surface", "friction", "torsional"}), report);
  surface.material = read_material(collision, reading);
  surface.is_grippable = read_grippable(collision, report);
  const auto contact = find(collision, {"surface", "contact"});
  read_softness(contact, report, surface);
  surface.collide_bitmask = read_bitmask(find(contact, {"collide_bitmask"}), by_default.collide_bitmask);
  surface.category_bitmask = read_bitmask(find(contact, {"category_bitmask"}), surface.collide_bitmask);
  return surface;
}

// Rounds a colour component, which is a float in SDF, so that values of up to six digits stay as written.
double read_part(double part) {
  constexpr double digits = 1e6;
  return std::clamp(std::round(part * digits) / digits, 0.0, 1.0);
}

const Element* diffuse_of(const Element& visual) { return find(&visual, {"material", "diffuse"}); }

Eigen::Vector3d read_color(const Element& visual) {
  const Element* const diffuse = diffuse_of(visual);
  return diffuse != nullptr ? Eigen::Vector3d(diffuse->color().head<3>().unaryExpr(&read_part)) : default_color();
}

double read_opacity(const Element& visual) {
  const Element* const diffuse = diffuse_of(visual);
  const double opacity = diffuse != nullptr ? read_part(diffuse->color().w()) : 1.0;
  return std::clamp(opacity - read_part(static_cast<double>(static_cast<float>(visual.real("transparency")))), 0.0,
                    1.0);
}

// Returns the image of the albedo map; null if there is none, or it cannot be shown.
std::shared_ptr<const Image> read_texture(const Element& visual, const ModelReading& reading) {
  const Element* const map = find(&visual, {"material", "pbr", "metal", "albedo_map"});
  if (!is_written(map)) return nullptr;
  try {
    return reading.shape_files.images().image(map);
  } catch (const std::runtime_error& error) {
    reading.report.warning(map, texture_not_shown(error));
    return nullptr;
  }
}

void read_visuals(const Element& element, const Frames& frames, const ModelReading& reading, Link& link) {
  const std::vector<const Element*> visuals = children_of(element, "visual");
  if (!visuals.empty()) link.color = read_color(*visuals.front());
  link.visuals.reserve(visuals.size());
  for (const Element* const visual : visuals) {
    const Element* const geometry = visual->child("geometry");
    std::optional<Shape> shape = geometry != nullptr ? read_visual_shape(*geometry, reading) : std::nullopt;
    if (!shape) continue;
    Eigen::Vector4d color;
    color << read_color(*visual), read_opacity(*visual);
    link.visuals.push_back({name_of(*visual), resolved_pose(*visual, frames, reading), *std::move(shape), color,
                            diffuse_of(*visual) != nullptr, read_texture(*visual, reading)});
  }
}

}  // namespace

Link read_link(const Element& element, const Frames& frames, const ModelReading& reading) {
  Link link;
  link.name = name_of(element);
  link.X_ML = resolved_pose(element, frames, reading);
  read_visuals(element, frames, reading, link);
  for (const Element* const collision : children_of(element, "collision")) {
    const Element* const geometry = collision->child("geometry");
    std::optional<Shape> shape = read_shape(geometry != nullptr ? *geometry : *collision, reading);
    const Surface surface = read_surface(collision, reading);
    if (!shape) continue;
    Pose X_LC = resolved_pose(*collision, frames, reading);
    if (const Element* const map = find(geometry, {"heightmap"})) X_LC.position = X_LC * map->vector("pos");
    link.collisions.push_back({name_of(*collision), X_LC, *std::move(shape), surface});
  }
  if (reading.is_static) return link;
  const Element* const gravity = element.child("gravity");
  link.feels_gravity = !is_written(gravity) || gravity->flag();
  link.is_kinematic = element.flag("kinematic");
  const auto computed = read_inertial_from_density(&element, link, reading.report);
  link.inertial = computed ? *computed : read_written_inertial(&element, link, reading.report);
  link.inertial.added_mass = read_added_mass(element, link.inertial, reading.report);
  return link;
}

}  // namespace cohort::parsing
