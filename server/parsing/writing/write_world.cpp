// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/writing/write_world.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "server/parsing/files/sdf_version.hpp"
#include "server/parsing/keys/choices.hpp"
#include "server/parsing/writing/write_values.hpp"

namespace cohort::parsing {
namespace {

struct ShapeWriter {
  XmlNode& geometry;
  const std::filesystem::path& folder;

  void operator()(const Box& box) const { add_value(add(geometry, "box"), "size", box.size); }
  void operator()(const Sphere& sphere) const { add_value(add(geometry, "sphere"), "radius", sphere.radius); }
  void operator()(const Cylinder& cylinder) const { add_round("cylinder", cylinder.radius, cylinder.length); }
  void operator()(const Capsule& capsule) const { add_round("capsule", capsule.radius, capsule.length); }
  void operator()(const Ellipsoid& ellipsoid) const { add_value(add(geometry, "ellipsoid"), "radii", ellipsoid.radii); }
  void operator()(const Plane& plane) const { add_value(add(geometry, "plane"), "normal", plane.normal); }
  void operator()(const Mesh& mesh) const {
    for (const Polyline& polyline : mesh.triangles->polylines) {
      XmlNode& element = add(geometry, "polyline");
      for (const Eigen::Vector2d& point : polyline.points) add_value(element, "point", point);
      add_value(element, "height", polyline.height);
    }
    if (!mesh.triangles->polylines.empty()) return;
    XmlNode& element = add(geometry, "mesh");
    add_value(element, "uri", relative(mesh.triangles->file));
    add_value(element, "scale", mesh.triangles->scale);
    if (mesh.triangles->submesh.empty()) return;
    XmlNode& submesh = add(element, "submesh");
    add_value(submesh, "name", mesh.triangles->submesh);
    add_value(submesh, "center", mesh.triangles->is_centered);
  }
  void operator()(const Heightmap& map) const {
    XmlNode& element = add(geometry, "heightmap");
    if (!map.grid->terrain) {
      add_value(element, "uri", relative(map.grid->file));
      add_value(element, "size", map.grid->size);
      return;
    }
    const Terrain& terrain = *map.grid->terrain;
    add_value(element, "size", terrain.size);
    XmlNode& extension = add(element, prefixed("terrain"));
    add_key(extension, "kind", terrain.kind);
    add_key(extension, "spacing", terrain.spacing);
    add_key(extension, "wavelength", terrain.wavelength);
    add_key(extension, "seed", terrain.seed);
  }

 private:
  void add_round(const char* name, double radius, double length) const {
    XmlNode& element = add(geometry, name);
    add_value(element, "radius", radius);
    add_value(element, "length", length);
  }
  std::string relative(const std::filesystem::path& file) const { return relative_to(folder, file); }
};

class WorldWriter {
 public:
  WorldWriter(const World& world, const std::filesystem::path& folder) : world_(world), folder_(folder) {}

  XmlNode write() const {
    XmlNode root;
    root.name = "sdf";
    root.attributes = {{"version", std::string(converted_version)}, {"xmlns:cohort", "https://cohort-sim.org/sdf/1"}};
    XmlNode& world = add_named(root, "world", world_.name);
    add_value(world, "gravity", world_.gravity);
    add_value(world, "magnetic_field", world_.magnetic_field);
    write_physics(world);
    XmlNode& climate = add(world, prefixed("climate"));
    add_key(climate, "temperature", world_.climate.temperature);
    add_key(climate, "humidity", world_.climate.humidity);
    write_fluids(world);
    for (const Instance& instance : world_.instances)
      if (instance.is_present) write_model(world, instance);
    for (const MaterialPair& pair : world_.material_pairs) {
      XmlNode& element = add(world, prefixed("material_pair"));
      add_key(element, "first", world_.materials[pair.first]);
      add_key(element, "second", world_.materials[pair.second]);
      add_key(element, "friction", pair.friction);
      add_key(element, "restitution", pair.restitution);
      add_key(element, "rolling_resistance", pair.rolling_resistance);
    }
    for (const BreakableJoint& joint : world_.breakable_joints) write_breakable_joint(world, joint);
    if (has_friction_links()) root.attributes.emplace_back("xmlns:gz", "http://gazebosim.org/schema");
    return root;
  }

 private:
  bool has_friction_links() const {
    for (const Instance& instance : world_.instances)
      for (const Link& link : world_.models[instance.model].links)
        for (const Collision& collision : link.collisions)
          if (collision.surface.friction_link) return true;
    return false;
  }

  void write_breakable_joint(XmlNode& world, const BreakableJoint& joint) const {
    XmlNode& element = add_named(world, prefixed("breakable_joint"), joint.name);
    const auto add_end = [&](const std::string& key, std::size_t object, std::size_t link) {
      const Instance& instance = world_.instances[object];
      add_key(element, key, instance.name);
      add_key(element, key + "_link", without_scope_marks(world_.models[instance.model].links[link].name));
    };
    add_end("first", joint.first, joint.first_link);
    add_end("second", joint.second, joint.second_link);
    if (joint.X_LP) add_key(element, "pose", *joint.X_LP);
    if (joint.type != JointType::fixed) add_key(element, "type", std::string(facts_of(joint.type).name));
    if (joint.type == JointType::revolute) add_key(element, "axis", joint.axis_P);
    if (joint.damping > 0.0) add_key(element, "damping", joint.damping);
    if (std::isfinite(joint.breaking_force)) add_key(element, "breaking_force", joint.breaking_force);
    if (std::isfinite(joint.breaking_torque)) add_key(element, "breaking_torque", joint.breaking_torque);
  }

  void write_fluids(XmlNode& world) const {
    const Air& air = world_.air;
    const Air usual;
    if (air.wind != usual.wind) add_value(add(world, "wind"), "linear_velocity", air.wind);
    if (air.density != usual.density || air.wind_force != usual.wind_force) {
      XmlNode& element = add(world, prefixed("air"));
      add_key(element, "density", air.density);
      add_key(element, "force_approximation_scaling_factor", air.wind_force);
    }
    if (!world_.water) return;
    XmlNode& water = add(world, prefixed("water"));
    add_key(water, "level", world_.water->level);
    add_key(water, "density", world_.water->density);
    add_key(water, "current", world_.water->current);
  }

  void write_physics(XmlNode& world) const {
    XmlNode& sdf = add_named(world, "physics", "default");
    sdf.attributes.emplace_back("type", "ignored");
    constexpr double nanoseconds = 1e9;
    add_value(sdf, "max_step_size", static_cast<double>(world_.step.count()) / nanoseconds);
    const PhysicsSettings& settings = world_.physics;
    XmlNode& physics = add(world, prefixed("physics"));
    add_key(physics, "fidelity", word_for(fidelities, settings.fidelity));
    add_key(physics, "dynamics", word_for(dynamics_kinds, settings.dynamics));
    add_key(physics, "solver", word_for(solvers, settings.solver));
    add_key(physics, "iterations", static_cast<std::uint64_t>(settings.iterations));
    add_key(physics, "direct_bodies", static_cast<std::uint64_t>(settings.direct_bodies));
    if (std::isfinite(settings.lowest)) add_key(physics, "lowest", settings.lowest);
    add_key(physics, "sleeping", settings.sleeping);
    add_key(physics, "strict", settings.strict);
  }

  void write_model(XmlNode& parent, const Instance& instance) const {
    const Model& model = world_.models[instance.model];
    XmlNode& element = add_named(parent, "model", instance.name);
    add_value(element, "static", model.is_static);
    add_value(element, "self_collide", model.self_collide);
    add_value(element, "allow_auto_disable", model.may_sleep);
    add_pose(element, instance.X_WM);
    for (std::size_t link = 0; link < model.links.size(); ++link) write_link(element, model, link);
    for (const std::vector<Joint>* joints : {&model.joints, &model.loop_joints})
      for (const Joint& joint : *joints) write_joint(element, joint, model);
    for (const Device& device : model.devices) write_device(element, model, device, folder_);
  }

  static void write_added_mass(XmlNode& inertial, const SpatialMatrix& added_mass) {
    XmlNode& element = add(inertial, "fluid_added_mass");
    constexpr std::string_view axes = "xyzpqr";
    constexpr std::array<int, axes.size()> in_matrix = {3, 4, 5, 0, 1, 2};
    for (std::size_t row = 0; row < axes.size(); ++row)
      for (std::size_t column = row; column < axes.size(); ++column)
        add_value(element, std::string{axes[row], axes[column]}, added_mass(in_matrix[row], in_matrix[column]));
  }

  void write_link(XmlNode& parent, const Model& model, std::size_t index) const {
    const Link& link = model.links[index];
    const bool is_static = model.is_static;
    XmlNode& element = add_named(parent, "link", without_scope_marks(link.name));
    add_pose(element, link.X_ML);
    if (link.feels_wind) add_value(element, "enable_wind", true);
    if (!link.feels_gravity) add_value(element, "gravity", false);
    if (link.is_kinematic) add_value(element, "kinematic", true);
    if (!is_static) {
      XmlNode& inertial = add(element, "inertial");
      add_pose(inertial, link.inertial.X_LI);
      add_value(inertial, "mass", link.inertial.mass);
      XmlNode& inertia = add(inertial, "inertia");
      const char* const axes = "xyz";
      for (int row = 0; row < 3; ++row)
        for (int column = row; column < 3; ++column)
          add_value(inertia, std::string("i") + axes[row] + axes[column], link.inertial.inertia(row, column));
      if (link.inertial.added_mass) write_added_mass(inertial, *link.inertial.added_mass);
    }
    if (link.color != default_color()) {
      XmlNode& visual = add_named(element, "visual", "color");
      add(add(visual, "geometry"), "empty");
      add_value(add(visual, "material"), "diffuse", link.color).text += " 1";
    }
    for (const Collision& collision : link.collisions) {
      XmlNode& shape = add_named(element, "collision", collision.name);
      add_pose(shape, collision.X_LC);
      std::visit(ShapeWriter{add(shape, "geometry"), folder_}, collision.shape);
      write_surface(add(shape, "surface"), collision.surface, model);
      if (collision.surface.is_grippable) add_key(shape, "grippable", true);
      if (collision.surface.material != 0) add_key(shape, "material", world_.materials[collision.surface.material]);
    }
    const auto write_parts = [&](const auto& parts) {
      for (const auto& part : parts)
        if (part.link == index) write_link_part(element, part);
    };
    write_parts(model.grip_rings);
    write_parts(model.fins);
    write_parts(model.drags);
    for (const Emitter& emitter : model.emitters)
      if (emitter.link == index) write_emitter(element, emitter);
  }

  static void write_surface(XmlNode& element, const Surface& surface, const Model& model) {
    const Surface usual;
    XmlNode& friction = add(element, "friction");
    XmlNode& ode = add(friction, "ode");
    add_value(ode, "mu", surface.friction);
    if (surface.has_direction()) {
      add_value(ode, "mu2", surface.second_friction);
      XmlNode& direction = add_value(ode, "fdir1", surface.friction_direction);
      if (surface.friction_link)
        direction.attributes.emplace_back("gz:expressed_in",
                                          without_scope_marks(model.links[*surface.friction_link].name));
    }
    add_value(add(friction, "bullet"), "rolling_friction", surface.rolling_resistance);
    if (surface.spinning_resistance > 0.0) {
      // The radius for which the coefficient is exactly the same.
      XmlNode& torsional = add(friction, "torsional");
      add_value(torsional, "coefficient", surface.spinning_resistance);
      add_value(torsional, "patch_radius", 16.0 / (3.0 * std::numbers::pi));
    }
    XmlNode& bounce = add(element, "bounce");
    add_value(bounce, "restitution_coefficient", surface.restitution);
    if (surface.bounce_threshold) add_value(bounce, "threshold", *surface.bounce_threshold);
    const bool is_soft = std::isfinite(surface.stiffness);
    const bool has_bitmasks =
        surface.collide_bitmask != usual.collide_bitmask || surface.category_bitmask != usual.category_bitmask;
    if (!is_soft && !has_bitmasks) return;
    XmlNode& contact = add(element, "contact");
    if (is_soft) {
      XmlNode& soft = add(contact, "ode");
      add_value(soft, "kp", surface.stiffness);
      add_value(soft, "kd", surface.damping);
    }
    if (has_bitmasks) {
      add_value(contact, "collide_bitmask", std::to_string(surface.collide_bitmask));
      add_value(contact, "category_bitmask", std::to_string(surface.category_bitmask));
    }
  }

  static void write_joint(XmlNode& parent, const Joint& joint, const Model& model) {
    XmlNode& element = add_named(parent, "joint", without_scope_marks(joint.name));
    element.attributes.emplace_back("type", facts_of(joint.type).name);
    add_pose(element, joint.X_LJ);
    add_value(
        element, "parent",
        joint.parent == Joint::world ? std::string("world") : without_scope_marks(model.links[joint.parent].name));
    add_value(element, "child", without_scope_marks(model.links[joint.child].name));
    if (joint.type != JointType::fixed) write_axis(add(element, "axis"), joint.axis);
    if (joint.type == JointType::universal) write_axis(add(element, "axis2"), joint.second_axis);
    if (joint.type == JointType::screw) add_value(element, "thread_pitch", -2.0 * M_PI / joint.thread_pitch);
    for (const Coupling& coupling : model.couplings) {
      if (&model.joints[coupling.follower] != &joint) continue;
      XmlNode& mimic = add(element, prefixed("mimic"));
      add_key(mimic, "joint", without_scope_marks(model.joints[coupling.leader].name));
      add_key(mimic, "multiplier", coupling.multiplier);
      add_key(mimic, "offset", coupling.offset);
      const std::string second = "axis2";
      if (coupling.moves_second_axis) add_key(mimic, "axis", second);
      if (coupling.follows_second_axis) add_key(mimic, "followed_axis", second);
    }
  }

  static void write_axis(XmlNode& element, const JointAxis& axis) {
    constexpr double no_limit = 1e16;  // as SDF writes it
    add_value(element, "xyz", axis.direction);
    if (std::isfinite(axis.lower) || std::isfinite(axis.upper) || std::isfinite(axis.max_effort) ||
        std::isfinite(axis.max_velocity)) {
      XmlNode& limit = add(element, "limit");
      add_value(limit, "lower", std::isfinite(axis.lower) ? axis.lower : -no_limit);
      add_value(limit, "upper", std::isfinite(axis.upper) ? axis.upper : no_limit);
      if (std::isfinite(axis.max_effort)) add_value(limit, "effort", axis.max_effort);
      if (std::isfinite(axis.max_velocity)) add_value(limit, "velocity", axis.max_velocity);
      if (std::isfinite(axis.limit_stiffness)) {
        add_value(limit, "stiffness", axis.limit_stiffness);
        add_value(limit, "dissipation", axis.limit_damping);
      }
    }
    XmlNode& dynamics = add(element, "dynamics");
    add_value(dynamics, "damping", axis.damping);
    add_value(dynamics, "friction", axis.friction);
    add_value(dynamics, "spring_stiffness", axis.spring_stiffness);
    add_value(dynamics, "spring_reference", axis.spring_reference);
  }

  const World& world_;
  const std::filesystem::path& folder_;
};

std::string escaped(std::string_view text) {
  std::string result;
  for (const char character : text) {
    switch (character) {
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '&': result += "&amp;"; break;
      case '"': result += "&quot;"; break;
      default: result += character;
    }
  }
  return result;
}

void print_node(const XmlNode& node, std::size_t depth, std::string& text) {
  const std::string indent(2 * depth, ' ');
  text += indent + "<" + node.name;
  for (const auto& [name, value] : node.attributes) text += " " + name + "=\"" + escaped(value) + "\"";
  if (node.children.empty() && node.text.empty()) {
    text += "/>\n";
    return;
  }
  text += ">" + escaped(node.text);
  if (!node.children.empty()) {
    text += "\n";
    for (const XmlNode& child : node.children) print_node(child, depth + 1, text);
    text += indent;
  }
  text += "</" + node.name + ">\n";
}

}  // namespace

XmlNode sdf_of(const World& world, const std::filesystem::path& folder) { return WorldWriter(world, folder).write(); }

std::string xml_text(const XmlNode& root) {
  std::string text = "<?xml version=\"1.0\"?>\n";
  print_node(root, 0, text);
  return text;
}

}  // namespace cohort::parsing
