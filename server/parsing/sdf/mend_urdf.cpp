#include "server/parsing/sdf/mend_urdf.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string_view>

#include "server/core/text.hpp"
#include "server/parsing/sdf/unknown_names.hpp"
#include "server/parsing/sdf/urdf_forms.hpp"
#include "server/parsing/sdf/urdf_masses.hpp"
#include "server/parsing/sdf/xml_edit.hpp"

namespace cohort::parsing {
namespace {

std::string urdf_step(const XmlNode& node) {
  const std::string name = value_of(node, "name");
  return node.name + (name.empty() ? "" : "[" + name + "]");
}

const UrdfForm* form_of(std::string_view parent, std::string_view name) {
  const auto found = std::ranges::find_if(
      urdf_forms(), [&](const UrdfForm& form) { return form.parent == parent && form.name == name; });
  return found == urdf_forms().end() ? nullptr : &*found;
}

// Puts `text` at a path below `node`.
void put(XmlNode& node, const std::vector<const char*>& path, const std::string& text) {
  XmlNode* at = &node;
  for (const char* const name : path) {
    XmlNode* next = child_of(*at, name);
    if (next == nullptr) next = &at->children.emplace_back(element_at(node, name));
    at = next;
  }
  at->text = text;
}

class UrdfMender {
 public:
  UrdfMender(const std::filesystem::path& file, std::vector<Problem>& problems, std::vector<Problem>& warnings)
      : file_(file), problems_(problems), warnings_(warnings) {}

  UrdfRest mend(XmlNode& robot);

 private:
  void warn(const XmlNode& node, const std::string& path, const std::string& message) {
    warnings_.push_back({file_, node.line, path, message});
  }
  void pass_over(const XmlNode& node, const std::string& path, const std::string& message) {
    unknown_.add({file_, node.line, path, ""}, message);
  }
  void take_optional_environment(XmlNode& node, const std::string& path);
  void name_joints_apart(XmlNode& robot);
  void mend_numbers(XmlNode& node, const UrdfForm& form, const std::string& path);
  void mend_materials(XmlNode& robot);
  void mend_shape(XmlNode& geometry, const std::string& path, const std::pair<std::string, std::size_t>& place);
  void mend_link(XmlNode& link);
  void mend_visuals(XmlNode& link);
  bool can_be_shown(XmlNode& visual) const;
  void mend_inertial(XmlNode& inertial, const std::string& path);
  void mend_joint(XmlNode& joint);
  void mend_limit(XmlNode& joint, const std::string& path);
  void take_contact(const XmlNode& contact, const std::string& link, const std::string& path);
  void take_unknown(XmlNode& node, const std::string& path);
  static void mend_mesh(XmlNode& geometry);
  void let_go(XmlNode& robot);

  const std::filesystem::path& file_;
  std::vector<Problem>& problems_;
  std::vector<Problem>& warnings_;
  UnknownNames unknown_;
  UrdfRest rest_;
  std::set<std::string> materials_;
};

UrdfRest UrdfMender::mend(XmlNode& robot) {
  if (value_of(robot, "name").empty()) {
    set_attribute(robot, "name", file_.stem().string());
    warn(robot, "robot", "has no name; it is called '" + file_.stem().string() + "', as its file");
  }
  take_optional_environment(robot, "robot");
  name_joints_apart(robot);
  mend_materials(robot);
  for (XmlNode& child : robot.children) {
    if (child.name == "link") mend_link(child);
    if (child.name == "joint") mend_joint(child);
  }
  let_go(robot);
  keep_links_without_mass(robot, file_, rest_, warnings_);
  unknown_.tell(warnings_);
  return std::move(rest_);
}

// `$(optenv NAME VALUE)` is the value: what runs does not depend on the environment.
void UrdfMender::take_optional_environment(XmlNode& node, const std::string& path) {
  constexpr std::string_view opening = "$(optenv ";
  for (auto& [name, value] : node.attributes)
    for (std::size_t at = value.find(opening); at != std::string::npos; at = value.find(opening)) {
      const std::size_t end = value.find(')', at);
      if (end == std::string::npos) break;
      const std::string inside = value.substr(at + opening.size(), end - at - opening.size());
      const std::size_t space = std::min(inside.find(' '), inside.size());
      value.replace(at, end + 1 - at, trimmed(inside.substr(space)));
      pass_over(node, path, "$(optenv …) is what stands in it, whatever the environment says");
    }
  for (XmlNode& child : node.children) take_optional_environment(child, path + "/" + urdf_step(child));
}

// In SDF a joint and a link of a model are not of one name.
void UrdfMender::name_joints_apart(XmlNode& robot) {
  std::set<std::string> taken;
  for (const XmlNode& child : robot.children)
    if (child.name == "link") taken.insert(value_of(child, "name"));
  std::map<std::string, std::string> renamed;
  for (XmlNode& joint : robot.children) {
    const std::string name = value_of(joint, "name");
    if (joint.name != "joint" || !taken.contains(name)) continue;
    std::string other = name + "_joint";
    while (taken.contains(other)) other += "_";
    pass_over(joint, "robot/" + urdf_step(joint), "has the name of a link; it is called after it, with '_joint'");
    set_attribute(joint, "name", other);
    renamed.emplace(name, other);
  }
  for (XmlNode& joint : robot.children)
    if (XmlNode* const mimic = joint.name == "joint" ? child_of(joint, "mimic") : nullptr)
      if (const auto leader = renamed.find(value_of(*mimic, "joint")); leader != renamed.end())
        set_attribute(*mimic, "joint", leader->second);
}

// A comma between two numbers, or a point after one: others read up to there.
void UrdfMender::mend_numbers(XmlNode& node, const UrdfForm& form, const std::string& path) {
  for (const UrdfAttribute& attribute : form.attributes) {
    const std::string value = value_of(node, attribute.name);
    if (attribute.numbers == 0 || value.empty() || !what_is_wrong(value, attribute)) continue;
    std::string spaced = value;
    std::ranges::replace(spaced, ',', ' ');
    std::string mended;
    for (std::string_view word : words(spaced)) {
      while (word.size() > 1 && word.ends_with('.')) word.remove_suffix(1);
      mended += (mended.empty() ? "" : " ") + std::string(word);
    }
    if (what_is_wrong(mended, attribute)) continue;
    warn(node, path, "expected numbers with spaces between them, not '" + value + "'; read as '" + mended + "'");
    set_attribute(node, attribute.name, mended);
  }
}

// Of no consequence for what moves, but the converter stops at them.
void UrdfMender::mend_materials(XmlNode& robot) {
  std::erase_if(robot.children, [&](const XmlNode& child) {
    return child.name == "material" && (value_of(child, "name").empty() || child.children.empty() ||
                                        !materials_.insert(value_of(child, "name")).second);
  });
}

// Of Bullet: shapes that the converter does not know. What nobody knows is an error: what moves would go through
// others.
void UrdfMender::mend_shape(XmlNode& geometry, const std::string& path,
                            const std::pair<std::string, std::size_t>& place) {
  if (geometry.children.size() > 1)
    pass_over(geometry, path, "has more than one shape; only the first counts, as other readers have it");
  geometry.children.resize(1, geometry.children.front());
  XmlNode& shape = geometry.children.front();
  const XmlNode bullets = shape;
  const auto stand_in = [&](const char* name, const char* size, const char* value) {
    shape = element_at(geometry, name);
    set_attribute(shape, size, value);
  };
  if (shape.name == "capsule") {
    rest_.capsules.insert(place);
    shape.name = "cylinder";
  } else if (shape.name == "plane") {
    rest_.planes.emplace(place, value_of(bullets, "normal").empty() ? "0 0 1" : value_of(bullets, "normal"));
    stand_in("sphere", "radius", "1");
  } else if (form_of("geometry", shape.name) == nullptr) {
    problems_.push_back({file_, bullets.line, path + "/" + bullets.name,
                         "<" + bullets.name +
                             "> is not supported as a collision; expected box, sphere, cylinder, "
                             "capsule, mesh or plane"});
    stand_in("sphere", "radius", "1");
  }
  mend_mesh(geometry);
}

// The converter divides by the mass of links that it makes one.
bool is_without_mass(const XmlNode& node) {
  const XmlNode* const mass = node.name == "inertial" ? node.child("mass") : nullptr;
  return mass != nullptr && parse_real(value_of(*mass, "value")) == 0.0;
}

// A box, a sphere or a cylinder that is flat, thin or a point, which others take for one that is not there.
bool has_no_size(const XmlNode& shape) {
  const UrdfForm* const form = form_of("geometry", shape.name);
  return form != nullptr && std::ranges::any_of(form->attributes, [&](const UrdfAttribute& attribute) {
           const std::string value = value_of(shape, attribute.name);
           return attribute.positive &&
                  std::ranges::any_of(words(value), [](auto word) { return parse_real(word) == 0.0; });
         });
}

void UrdfMender::mend_link(XmlNode& link) {
  const std::string path = "robot/" + urdf_step(link);
  const std::string name = value_of(link, "name");
  if (const XmlNode* const contact = link.child("contact")) take_contact(*contact, name, path + "/contact");
  std::erase_if(link.children, [](const XmlNode& child) { return child.name == "contact"; });
  mend_visuals(link);
  std::size_t collision = 0;
  std::erase_if(link.children, [&](const XmlNode& child) {
    if (child.name != "collision") return is_without_mass(child);
    const XmlNode* const geometry = child.child("geometry");
    const bool is_empty = geometry == nullptr || geometry->children.empty();
    if (is_empty) pass_over(child, path + "/collision", "a <collision> without a shape, which is ignored");
    if (is_empty || !has_no_size(geometry->children.front())) return is_empty;
    pass_over(geometry->children.front(), path + "/collision/geometry", "a collision of size 0, which is left out");
    return true;
  });
  for (XmlNode& child : link.children) {
    if (child.name == "inertial") mend_inertial(child, path + "/inertial");
    XmlNode* const geometry = child_of(child, "geometry");
    if (child.name != "collision") continue;
    if (geometry != nullptr) mend_shape(*geometry, path + "/collision/geometry", {name, collision});
    ++collision;
  }
  take_unknown(link, path);
}

void UrdfMender::mend_mesh(XmlNode& geometry) {
  XmlNode* const mesh = child_of(geometry, "mesh");
  if (mesh == nullptr) return;
  const std::string scale = value_of(*mesh, "scale");
  const std::vector<std::string_view> parts = words(scale);
  if (parts.size() == 1)
    set_attribute(*mesh, "scale", scale + " " + scale + " " + scale);
  else if (parts.size() > 3)
    set_attribute(*mesh, "scale", std::string(parts[0]) + " " + std::string(parts[1]) + " " + std::string(parts[2]));
}

// A visual that cannot be read would stop the converter.
bool UrdfMender::can_be_shown(XmlNode& visual) const {
  XmlNode* const geometry = child_of(visual, "geometry");
  if (geometry == nullptr || geometry->children.size() != 1) return false;
  mend_mesh(*geometry);
  XmlNode& shape = geometry->children.front();
  if (shape.name == "capsule") shape.name = "cylinder";
  const auto is_right = [](const XmlNode& node, const UrdfForm* form) {
    return form != nullptr && std::ranges::all_of(form->attributes, [&](const UrdfAttribute& attribute) {
             const std::string* const value = node.attribute(attribute.name);
             return value == nullptr ? !attribute.required : !what_is_wrong(*value, attribute);
           });
  };
  const XmlNode* const origin = visual.child("origin");
  return is_right(shape, form_of("geometry", shape.name)) &&
         (origin == nullptr || is_right(*origin, form_of("collision", "origin")));
}

void UrdfMender::mend_visuals(XmlNode& link) {
  std::erase_if(link.children, [&](XmlNode& child) { return child.name == "visual" && !can_be_shown(child); });
  const UrdfAttribute rgba{"rgba", 4};
  for (XmlNode& visual : link.children)
    if (visual.name == "visual")
      std::erase_if(visual.children, [&](XmlNode& material) {
        if (material.name != "material") return false;
        if (const XmlNode* const color = material.child("color");
            color != nullptr && what_is_wrong(value_of(*color, "rgba"), rgba))
          return true;
        const bool has_own = !material.children.empty();
        if (value_of(material, "name").empty() && has_own) set_attribute(material, "name", "unnamed");
        return !has_own && !materials_.contains(value_of(material, "name"));
      });
}

void UrdfMender::mend_inertial(XmlNode& inertial, const std::string& path) {
  constexpr double least_mass = 2e-6;  // [kg]: the converter takes less for none
  XmlNode* const mass = child_of(inertial, "mass");
  const std::optional<double> value = mass != nullptr ? parse_real(value_of(*mass, "value")) : std::nullopt;
  if (value && *value > 0.0 && *value < least_mass) {
    pass_over(*mass, path + "/mass", "is less than 2 mg, which stands in for it");
    set_attribute(*mass, "value", shortest_text(least_mass));
  }
  XmlNode* const inertia = child_of(inertial, "inertia");
  if (inertia == nullptr) return;
  for (const char* const product : {"ixy", "ixz", "iyz"}) {
    if (inertia->attribute(product) != nullptr) continue;
    set_attribute(*inertia, product, "0");
    pass_over(*inertia, path + "/inertia", "has not all products of inertia; those that are missing are 0");
  }
}

// Of Bullet: how the surface of a link rubs, bounces and gives way.
void UrdfMender::take_contact(const XmlNode& contact, const std::string& link, const std::string& path) {
  const double radius_by_spinning = 16.0 / (3.0 * std::numbers::pi);  // SDF's torsional friction has its inverse
  XmlNode surface = element_at(contact, "surface");
  for (const XmlNode& child : contact.children) {
    const std::optional<double> value = parse_real(value_of(child, "value"));
    const bool is_number = value && std::isfinite(*value) && *value >= 0.0;
    const auto set = [&](const std::vector<const char*>& where, double factor = 1.0) {
      if (is_number) put(surface, where, shortest_text(factor * *value));
    };
    if (child.name == "lateral_friction") {
      set({"friction", "ode", "mu"});
    } else if (child.name == "rolling_friction") {
      set({"friction", "bullet", "rolling_friction"});
    } else if (child.name == "spinning_friction") {
      set({"friction", "torsional", "patch_radius"}, radius_by_spinning);
    } else if (child.name == "restitution") {
      if (is_number) put(surface, {"bounce", "restitution_coefficient"}, shortest_text(std::min(*value, 1.0)));
    } else if (child.name == "stiffness") {
      if (value && *value > 0.0) set({"contact", "ode", "kp"});
    } else if (child.name == "damping") {
      set({"contact", "ode", "kd"});
    } else {
      pass_over(child, path + "/" + child.name,
                "unknown element <" + child.name + "> of a <contact>, which is ignored");
      continue;
    }
    if (!is_number) pass_over(child, path + "/" + child.name, "expected value=\"NUMBER\", at least 0; it is ignored");
  }
  if (!surface.children.empty()) rest_.surfaces.emplace(link, std::move(surface));
}

void UrdfMender::take_unknown(XmlNode& node, const std::string& path) {
  std::set<std::string> met;
  std::erase_if(node.children, [&](const XmlNode& child) {
    const bool is_again = form_of(node.name, child.name) != nullptr && child.name != "collision" &&
                          child.name != "visual" && !met.insert(child.name).second;
    if (is_again) pass_over(child, path + "/" + urdf_step(child), "is given twice; only the first counts");
    return is_again;
  });
  std::erase_if(node.children, [&](const XmlNode& child) {
    if (child.name == "visual" || child.name.find(':') != std::string::npos) return false;
    if (form_of(node.name, child.name) != nullptr) return false;
    std::vector<std::string> known;
    for (const UrdfForm& form : urdf_forms())
      if (form.parent == node.name) known.emplace_back(form.name);
    const auto meant = nearest(child.name, known);
    pass_over(child, path + "/" + urdf_step(child),
              "unknown element <" + child.name + "> in a <" + node.name + ">, which is ignored" +
                  (meant ? "; did you mean '" + *meant + "'?" : ""));
    return true;
  });
  for (XmlNode& child : node.children) {
    const UrdfForm* const form = form_of(node.name, child.name);
    if (form == nullptr || child.name == "visual") continue;
    const std::string child_path = path + "/" + urdf_step(child);
    mend_numbers(child, *form, child_path);
    std::vector<std::string> known;
    for (const UrdfAttribute& attribute : form->attributes) known.emplace_back(attribute.name);
    std::erase_if(child.attributes, [&](const auto& attribute) {
      if (attribute.first.find(':') != std::string::npos) return false;
      if (std::ranges::find(known, attribute.first) != known.end()) return false;
      const auto meant = nearest(attribute.first, known);
      pass_over(child, child_path,
                "unknown attribute '" + attribute.first + "' of <" + child.name + ">, which is ignored" +
                    (meant ? "; did you mean '" + *meant + "'?" : ""));
      return true;
    });
    take_unknown(child, child_path);
  }
}

void UrdfMender::mend_joint(XmlNode& joint) {
  const std::string path = "robot/" + urdf_step(joint);
  const std::string type = value_of(joint, "type");
  if (type == "spherical") {
    rest_.balls.insert(value_of(joint, "name"));
    set_attribute(joint, "type", "continuous");
  } else if (type == "planar") {
    set_attribute(joint, "type", "floating");
    warn(joint, path, "a planar joint is not supported; its child is free, as of a floating one");
  }
  if (XmlNode* const properties = child_of(joint, "joint_properties"); properties != nullptr) {
    if (joint.child("dynamics") == nullptr) properties->name = "dynamics";
  }
  mend_limit(joint, path);
  take_unknown(joint, path);
}

void UrdfMender::mend_limit(XmlNode& joint, const std::string& path) {
  const std::string type = value_of(joint, "type");
  XmlNode* const limit = child_of(joint, "limit");
  if (limit != nullptr) {
    for (const char* const most : {"effort", "velocity"}) {
      if (limit->attribute(most) != nullptr) continue;
      set_attribute(*limit, most, "0");
      pass_over(*limit, path + "/limit", std::string("has no '") + most + "', which then has no limit");
    }
    return;
  }
  if (type == "revolute") set_attribute(joint, "type", "continuous");
  if (type == "prismatic") {
    XmlNode none = element_at(joint, "limit");
    none.attributes = {{"lower", "-1e16"}, {"upper", "1e16"}, {"effort", "0"}, {"velocity", "0"}};
    joint.children.push_back(std::move(none));
  }
  if (type == "revolute" || type == "prismatic")
    pass_over(joint, path, "has no <limit>, which a " + type + " joint needs; it moves without one");
}

// A floating joint lets go: of a root that has no mass nothing is left, otherwise there are two that are free.
void UrdfMender::let_go(XmlNode& robot) {
  std::set<std::string> children;
  for (const XmlNode& joint : robot.children)
    if (joint.name == "joint") children.insert(urdf_end(joint, "child"));
  std::set<std::string> gone;
  for (XmlNode& joint : robot.children) {
    if (joint.name != "joint" || value_of(joint, "type") != "floating") continue;
    const std::string parent = urdf_end(joint, "parent");
    const bool is_root_of_it_alone =
        !children.contains(parent) && std::ranges::none_of(robot.children, [&](const XmlNode& other) {
          return (other.name == "link" && value_of(other, "name") == parent && has_mass(other)) ||
                 (other.name == "joint" && &other != &joint && urdf_end(other, "parent") == parent);
        });
    if (is_root_of_it_alone) {
      gone.insert(parent);
      continue;
    }
    rest_.let_go.insert(value_of(joint, "name"));
    set_attribute(joint, "type", "continuous");
  }
  std::erase_if(robot.children, [&](const XmlNode& node) {
    return (node.name == "link" && gone.contains(value_of(node, "name"))) ||
           (node.name == "joint" && gone.contains(urdf_end(node, "parent")));
  });
}

}  // namespace

UrdfRest mend_urdf(XmlNode& robot, const std::filesystem::path& file, std::vector<Problem>& problems,
                   std::vector<Problem>& warnings) {
  return UrdfMender(file, problems, warnings).mend(robot);
}

}  // namespace cohort::parsing
