// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/model/read_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "server/parsing/model/free_bodies.hpp"
#include "server/parsing/model/not_supported.hpp"
#include "server/parsing/plugins/gazebo_plugins.hpp"
#include "server/parsing/sdf/extension_values.hpp"

namespace cohort::parsing {
namespace {

// Returns the joint with parent and child exchanged, which has the same position about the opposite axis. The axes of a
// universal joint change places, since the first is fixed in the parent.
Joint turned_round(const Joint& joint, const Model& model) {
  Joint turned = joint;
  turned.parent = joint.child;
  turned.child = joint.parent;
  turned.X_LJ = model.links[joint.parent].X_ML.inverse() * model.links[joint.child].X_ML * joint.X_LJ;
  if (joint.type == JointType::universal) std::swap(turned.axis, turned.second_axis);
  turned.axis.direction *= -1.0;
  turned.second_axis.direction *= -1.0;
  return turned;
}

// Separates joints that close loops. In document order, a joint belongs to the tree if it connects a link without a
// parent to a link that is not below it. All others close loops, except those that attach a root to a descendant of
// another one.
void set_loops_apart(Model& model) {
  const std::size_t none = model.links.size();
  std::vector<std::size_t> parent(model.links.size(), none);  // for the world, the link itself
  const auto root_of = [&](std::size_t link) {
    while (link != Joint::world && parent[link] != none && parent[link] != link) link = parent[link];
    return link;
  };
  std::vector<Joint> tree;
  for (Joint& joint : model.joints) {
    const std::size_t root = root_of(joint.parent);
    const bool ties_root = root == joint.parent && root != Joint::world && parent[root] == none &&
                           root_of(joint.child) != root && joint.type != JointType::universal;
    if (parent[joint.child] != none && ties_root) {
      tree.push_back(turned_round(joint, model));
      parent[joint.parent] = joint.child;
      continue;
    }
    const bool closes_loop = parent[joint.child] != none || root == joint.child;
    if (!closes_loop) parent[joint.child] = joint.parent == Joint::world ? joint.child : joint.parent;
    (closes_loop ? model.loop_joints : tree).push_back(std::move(joint));
  }
  model.joints = std::move(tree);
}

// Warns of properties of joints that close loops, which are ignored.
void warn_of_loops(const Element& element, const Model& model, const SdfReport& report) {
  for (const Joint& joint : model.loop_joints) {
    const JointAxis& axis = joint.axis;
    const bool is_free = axis.damping == 0.0 && axis.friction == 0.0 && axis.spring_stiffness == 0.0 &&
                         std::isinf(axis.lower) && std::isinf(axis.upper);
    if (is_free && joint.type != JointType::screw) continue;
    const std::vector<const Element*> joints = children_of(element, "joint");
    const auto written = std::ranges::find(joints, joint.name, [](const Element* each) { return name_of(*each); });
    report.warning(written != joints.end() ? *written : &element,
                   "the joint '" + joint.name +
                       "' closes a loop: it constrains the links, but its limits, damping, friction, spring and thread "
                       "are ignored");
  }
}

// Puts the links into this order, which has their old indices; `place` has the new index of each.
void move_links(Model& model, const std::vector<std::size_t>& order, const std::vector<std::size_t>& place) {
  std::vector<Link> links;
  links.reserve(order.size());
  for (const std::size_t link : order) links.push_back(std::move(model.links[link]));
  model.links = std::move(links);
  for (std::vector<Joint>* joints : {&model.joints, &model.loop_joints})
    for (Joint& joint : *joints) {
      if (joint.parent != Joint::world) joint.parent = place[joint.parent];
      joint.child = place[joint.child];
    }
  for (Emitter& emitter : model.emitters) emitter.link = place[emitter.link];
  for (GripRing& ring : model.grip_rings) ring.link = place[ring.link];
  for (Fin& fin : model.fins) fin.link = place[fin.link];
  for (Drag& drag : model.drags) drag.link = place[drag.link];
}

// Puts parents before children, and otherwise keeps the document order. Returns false if the links are not one tree.
bool order_links(const Element& element, Model& model, const SdfReport& report) {
  const std::size_t count = model.links.size();
  std::vector<std::size_t> parent(count, count);  // `count` is none
  for (const Joint& joint : model.joints)
    if (joint.parent != Joint::world) parent[joint.child] = joint.parent;

  std::vector<std::size_t> order;  // old indices
  std::vector<std::size_t> place(count, count);
  const auto put = [&](std::size_t link) {
    place[link] = order.size();
    order.push_back(link);
  };
  std::vector<std::size_t> roots;
  for (std::size_t link = 0; link < count; ++link)
    if (parent[link] == count) roots.push_back(link);
  const bool are_on_world = std::ranges::all_of(roots, [&](std::size_t root) {
    return std::ranges::find(model.joints, root, &Joint::child) != model.joints.end();
  });
  if (roots.size() > 1 && !are_on_world) {
    std::string names;
    for (const std::size_t root : roots) names += (names.empty() ? "'" : ", '") + model.links[root].name + "'";
    report.problem(&element,
                   "the links " + names +
                       " are all root links, but loop joints or couplings connect them; expected one root link, or "
                       "joints between each of them and the world");
    return false;
  }
  for (const std::size_t root : roots) put(root);
  for (std::size_t before = count; before != order.size();) {
    before = order.size();
    for (std::size_t link = 0; link < count; ++link)
      if (place[link] == count && place[parent[link]] != count) {
        put(link);
        break;
      }
  }
  move_links(model, order, place);
  return true;
}

// Makes root links kinematic. A link on a joint moves with its parent, and the world holds links still.
void take_kinematic_links(Model& model, const SdfReport& report, const Element* element) {
  const auto is_child = [&](std::size_t link) {
    return std::ranges::any_of(model.joints, [&](const Joint& joint) { return joint.child == link; });
  };
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    if (!model.links[link].is_kinematic || !is_child(link)) continue;
    model.links[link].is_kinematic = false;
    report.warning(element,
                   "<kinematic> of the link '" + model.links[link].name +
                       "' is ignored because the link is attached by a joint; only a free root link can be kinematic");
  }
}

// Returns <enable_wind> of a model or a link; without it, the value of the parent element.
bool feels_wind(const Element* element, bool outer) {
  const Element* const written = element->child("enable_wind");
  return is_written(written) ? written->flag() : outer;
}

// Collects the parts of a model and of its nested models, with scoped names.
class ModelFlattener {
 public:
  ModelFlattener(Model& model, const ModelReading& reading)
      : model_(model), reading_(reading), static_reading_(reading) {
    static_reading_.is_static = true;
  }

  /// Links are added first, since joints of an outer model may name links of a nested one.
  void add_links(const Frames& frames, const std::string& scope, const Pose& X_MN, bool outer_feels_wind);
  void add_joints(const Frames& frames, const std::string& scope);

  /// Returns whether a part is in a static model that is nested in a moving one.
  bool is_static(std::string_view scoped_name) const {
    return std::ranges::any_of(static_scopes_, [&](const std::string& each) { return scoped_name.starts_with(each); });
  }

  const std::vector<DeviceScope>& scopes() const { return scopes_; }
  const std::vector<SensorPlace>& sensors() const { return sensors_; }
  /// Includes joints that could not be read.
  std::size_t joint_count() const { return joint_count_; }

 private:
  const ModelReading& reading_of(const std::string& scope) const {
    return is_static(scope) ? static_reading_ : reading_;
  }
  void note_sensors(const Element& owner, const Frames& frames, const std::string& scope) {
    for (const Element* const sensor : children_of(owner, "sensor"))
      if (is_sensor(sensor))
        sensors_.push_back({sensor, &frames, owner.name() == "joint", scope + name_of(owner), scope});
  }

  template <class Part>
  void add_parts(const Element& element, const std::string& scope, std::vector<Part>& parts) {
    for (Part& part : read_link_parts<Part>(element, reading_of(scope))) {
      part.name = scope + part.name;
      part.link = model_.links.size();
      parts.push_back(std::move(part));
    }
  }

  Model& model_;
  const ModelReading& reading_;
  ModelReading static_reading_;
  std::vector<std::string> static_scopes_;
  std::vector<DeviceScope> scopes_;
  std::vector<SensorPlace> sensors_;
  std::size_t joint_count_ = 0;
};

void ModelFlattener::add_links(const Frames& frames, const std::string& scope, const Pose& X_MN,
                               bool outer_feels_wind) {
  const Element& element = frames.owner();
  scopes_.push_back({&element, scope});
  const bool model_feels_wind = feels_wind(&element, outer_feels_wind);
  for (const Element* const written : children_of(element, "link")) {
    Link link = read_link(*written, frames, reading_of(scope));
    link.name = scope + link.name;
    link.X_ML = X_MN * link.X_ML;
    link.feels_wind = feels_wind(written, model_feels_wind);
    for (Emitter& emitter : read_emitters(*written, frames, reading_)) {
      emitter.name = scope + emitter.name;
      emitter.link = model_.links.size();
      model_.emitters.push_back(std::move(emitter));
    }
    add_parts(*written, scope, model_.grip_rings);
    add_parts(*written, scope, model_.fins);
    add_parts(*written, scope, model_.drags);
    model_.links.push_back(std::move(link));
    note_sensors(*written, frames, scope);
  }
  for (const Element* const joint : children_of(element, "joint")) note_sensors(*joint, frames, scope);
  for (const Element* const inner : children_of(element, "model")) {
    warn_of_unsupported(inner, reading_.report);
    const std::string inner_scope = scope + name_of(*inner) + "::";
    if (inner->flag("static")) static_scopes_.push_back(inner_scope);
    add_links(*frames.of(*inner), inner_scope, X_MN * resolved_pose(*inner, frames, reading_), model_feels_wind);
  }
}

void ModelFlattener::add_joints(const Frames& frames, const std::string& scope) {
  for (const Element* const joint : children_of(frames.owner(), "joint"))
    joint_count_ += joint->attribute("type") == "gearbox" ? 0 : 1;
  for (Joint& joint : read_joints(frames, model_.links, scope, reading_)) model_.joints.push_back(std::move(joint));
  for (const Element* const inner : children_of(frames.owner(), "model"))
    add_joints(*frames.of(*inner), scope + name_of(*inner) + "::");
}

// Attaches to the world what joints attach to links of static models, and removes joints between such links.
void join_to_world(Model& model, const ModelFlattener& parts) {
  const auto is_fixed = [&](std::size_t link) {
    return link == Joint::world || parts.is_static(model.links[link].name);
  };
  std::erase_if(model.joints, [&](const Joint& joint) { return is_fixed(joint.parent) && is_fixed(joint.child); });
  for (Joint& joint : model.joints) {
    if (is_fixed(joint.child)) joint = turned_round(joint, model);
    if (is_fixed(joint.parent)) joint.parent = Joint::world;
  }
}

void warn_of_what_static_has(const std::vector<DeviceScope>& scopes, const std::vector<SensorPlace>& sensors,
                             const SdfReport& report) {
  for (const DeviceScope& scope : scopes) {
    const bool has_sensor =
        std::ranges::any_of(sensors, [&](const SensorPlace& sensor) { return sensor.prefix == scope.prefix; });
    if (!extensions_in(scope.model_element, report).empty() || has_sensor)
      report.warning(scope.model_element, "is static: its devices are ignored, and it is not a robot");
    warn_of_static_belts(scope.model_element, report);
  }
}

// Returns a valid name for an object; the name of a link in a nested model contains colons.
std::string without_colons(std::string name) {
  for (std::size_t at = name.find("::"); at != std::string::npos; at = name.find("::", at)) name.replace(at, 2, ".");
  return name;
}

// Adds the devices of one body, whose links and joints have been read.
void add_devices(const std::vector<DeviceScope>& scopes, const std::vector<SensorPlace>& sensors,
                 const ModelReading& reading, Model& body) {
  std::vector<Counterpart> of_plugins;
  std::set<std::string> names;
  for (const DeviceScope& scope : scopes)
    for (Counterpart& each :
         read_model_plugins(scope.model_element, scope.prefix, scope.elsewhere, body, names, reading.report))
      of_plugins.push_back(std::move(each));
  add_link_parts(of_plugins, body, reading.report);
  body.devices = read_devices(scopes, of_plugins, body, reading.report, reading.shape_files);
  for (Device& sensor : read_sdf_sensors(sensors, body, reading)) body.devices.push_back(std::move(sensor));
}

}  // namespace

std::vector<Model> read_model(const Frames& frames, const ModelReading& reading) {
  const Element* const element = &frames.owner();
  Model model;
  model.name = name_of(*element);
  model.is_static = reading.is_static;
  model.self_collide = element->flag("self_collide");
  model.may_sleep = element->flag("allow_auto_disable");
  warn_of_unsupported(element, reading.report);

  ModelFlattener parts(model, reading);
  parts.add_links(frames, "", {}, false);
  if (model.links.empty() && reading.report.flaw(element, "expected at least one <link>", "the model has no effect")) {
    model.is_static = true;
    model.links.push_back({"link", {}, {}, {}});
  }
  if (model.is_static) {
    warn_of_what_static_has(parts.scopes(), parts.sensors(), reading.report);
    set_friction_frames(frames, reading, model);
    return {std::move(model)};
  }
  parts.add_joints(frames, "");
  // Devices name links and joints. If some of those are missing, every device would be reported.
  if (!reading.frames_resolve || model.joints.size() != parts.joint_count()) return {std::move(model)};
  join_to_world(model, parts);
  set_loops_apart(model);
  model.couplings = read_couplings(frames, model, "", reading);
  const FreeBodies bodies(model);
  const std::vector<std::vector<DeviceScope>> scopes = bodies.scopes(model, parts.scopes());
  std::vector<Model> read;
  for (std::size_t number = 0; number < std::max<std::size_t>(bodies.count(), 1); ++number) {
    Model& body = read.emplace_back(bodies.body(number, model));
    body.is_static = !body.links.empty() && parts.is_static(body.links.front().name);
    if (!body.is_static && !order_links(*element, body, reading.report)) continue;
    set_friction_frames(frames, reading, body);
    if (number > 0) body.name += "/" + without_colons(body.links.front().name);
    if (body.is_static) {
      warn_of_what_static_has(scopes[number], bodies.sensors_of(number, model, parts.sensors()), reading.report);
      continue;
    }
    warn_of_loops(*element, body, reading.report);
    take_kinematic_links(body, reading.report, element);
    add_devices(scopes[number], bodies.sensors_of(number, model, parts.sensors()), reading, body);
  }
  return read;
}

}  // namespace cohort::parsing
