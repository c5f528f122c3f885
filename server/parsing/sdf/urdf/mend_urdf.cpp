// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/urdf/mend_urdf.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/core/text.hpp"
#include "server/parsing/sdf/urdf/urdf_file.hpp"
#include "server/parsing/sdf/urdf/urdf_forms.hpp"
#include "server/parsing/sdf/urdf/urdf_visuals.hpp"

namespace cohort::parsing {
namespace {

class UrdfMender {
 public:
  UrdfMender(const std::filesystem::path& file, std::vector<Problem>& problems, std::vector<Problem>& warnings)
      : file_(file), problems_(problems), notes_(file, warnings) {}

  void mend(XmlNode& robot);

 private:
  void take_optional_environment(XmlNode& node, const std::string& path);
  void mend_numbers(XmlNode& node, const UrdfForm& form, const std::string& path);
  void mend_shape(XmlNode& geometry, const std::string& path);
  void mend_link(XmlNode& link);
  void mend_inertial(XmlNode& inertial, const std::string& path);
  void take_unknown(XmlNode& node, const std::string& path);

  const std::filesystem::path& file_;
  std::vector<Problem>& problems_;
  UrdfNotes notes_;
  UrdfVisuals visuals_;
};

void UrdfMender::mend(XmlNode& robot) {
  if (value_of(robot, "name").empty()) {
    set_attribute(robot, "name", file_.stem().string());
    notes_.warn(robot, "robot", "has no name; it is named '" + file_.stem().string() + "' after its file");
  }
  take_optional_environment(robot, "robot");
  name_joints_apart(robot, notes_);
  visuals_.mend_materials(robot);
  for (XmlNode& child : robot.children) {
    if (child.name == "link") mend_link(child);
    if (child.name != "joint") continue;
    mend_joint(child, notes_);
    take_unknown(child, "robot/" + urdf_step(child));
  }
  omit_empty_root(robot);
  omit_lost_mimics(robot, notes_);
  notes_.tell();
}

// `$(optenv NAME VALUE)` is replaced by VALUE, so that results do not depend on the environment.
void UrdfMender::take_optional_environment(XmlNode& node, const std::string& path) {
  constexpr std::string_view opening = "$(optenv ";
  for (auto& [name, value] : node.attributes)
    for (std::size_t at = value.find(opening); at != std::string::npos; at = value.find(opening)) {
      const std::size_t end = value.find(')', at);
      if (end == std::string::npos) break;
      const std::string inside = value.substr(at + opening.size(), end - at - opening.size());
      const std::size_t space = std::min(inside.find(' '), inside.size());
      value.replace(at, end + 1 - at, trimmed(inside.substr(space)));
      notes_.pass_over(node, path, "$(optenv …) is replaced by its default value; the environment is not read");
    }
  for (XmlNode& child : node.children) take_optional_environment(child, path + "/" + urdf_step(child));
}

// Numbers with a comma between them, with other characters behind one, or more than three, of which other programs read
// the part that is valid.
void UrdfMender::mend_numbers(XmlNode& node, const UrdfForm& form, const std::string& path) {
  for (const UrdfAttribute& attribute : form.attributes) {
    const std::string value = value_of(node, attribute.name);
    if (attribute.numbers == 0 || value.empty() || !what_is_wrong(value, attribute)) continue;
    std::string spaced = value;
    std::ranges::replace(spaced, ',', ' ');
    std::vector<std::string_view> parts = words(spaced);
    if (attribute.numbers == 3 && parts.size() > 3 && spaced == value) parts.resize(3);
    std::string mended;
    for (std::string_view part : parts) {
      while (!part.empty() && !parse_real(part)) part.remove_suffix(1);
      mended += (mended.empty() ? "" : " ") + std::string(part);
    }
    if (what_is_wrong(mended, attribute)) continue;
    const std::string expected =
        attribute.numbers == 1 ? "a number" : std::to_string(attribute.numbers) + " numbers separated by spaces";
    notes_.warn(node, path, "expected " + expected + ", not '" + value + "'; read as '" + mended + "'");
    set_attribute(node, attribute.name, mended);
  }
}

// An unknown shape is an error, since a moving model would pass through others.
void UrdfMender::mend_shape(XmlNode& geometry, const std::string& path) {
  if (geometry.children.size() > 1)
    notes_.pass_over(geometry, path, "has more than one shape; only the first is used, as in other URDF readers");
  geometry.children.resize(1, geometry.children.front());
  XmlNode& shape = geometry.children.front();
  if (form_of("geometry", shape.name) == nullptr) {
    problems_.push_back(
        {file_, shape.line, path + "/" + shape.name,
         "<" + shape.name +
             "> is not supported as a collision; expected box, sphere, cylinder, capsule, mesh or plane"});
    shape = element_at(geometry, "sphere");  // so that nothing else is reported
    set_attribute(shape, "radius", "1");
  }
  mend_mesh(geometry);
}

bool is_without_mass(const XmlNode& node) {
  if (node.name != "inertial") return false;
  const XmlNode* const mass = node.child("mass");
  return mass == nullptr || parse_real(value_of(*mass, "value")) == 0.0;
}

// Returns whether a box, sphere or cylinder has a size of 0, so that other programs ignore it.
bool has_no_size(const XmlNode& shape) {
  const UrdfForm* const form = form_of("geometry", shape.name);
  return form != nullptr && shape.name != "capsule" &&
         std::ranges::any_of(form->attributes, [&](const UrdfAttribute& attribute) {
           const std::string value = value_of(shape, attribute.name);
           return attribute.positive &&
                  std::ranges::any_of(words(value), [](auto word) { return parse_real(word) == 0.0; });
         });
}

void UrdfMender::mend_link(XmlNode& link) {
  const std::string path = "robot/" + urdf_step(link);
  const XmlNode* const contact = link.child("contact");
  std::optional<XmlNode> surface = contact != nullptr ? surface_of(*contact, path + "/contact", notes_) : std::nullopt;
  std::erase_if(link.children, [](const XmlNode& child) { return child.name == "contact"; });
  visuals_.mend_link(link);
  std::erase_if(link.children, [&](const XmlNode& child) {
    if (child.name == "inertial" && child.child("mass") == nullptr)
      notes_.pass_over(child, path + "/inertial", "has no <mass> and is ignored, as if the link had no <inertial>");
    if (child.name != "collision") return is_without_mass(child);
    const XmlNode* const geometry = child.child("geometry");
    const bool is_empty = geometry == nullptr || geometry->children.empty();
    if (is_empty) notes_.pass_over(child, path + "/collision", "<collision> has no shape and is ignored");
    if (is_empty || !has_no_size(geometry->children.front())) return is_empty;
    notes_.pass_over(geometry->children.front(), path + "/collision/geometry", "a collision of size 0 is ignored");
    return true;
  });
  for (XmlNode& child : link.children) {
    if (child.name == "inertial") mend_inertial(child, path + "/inertial");
    XmlNode* const geometry = child_of(child, "geometry");
    if (child.name != "collision") continue;
    if (geometry != nullptr) mend_shape(*geometry, path + "/collision/geometry");
  }
  take_unknown(link, path);
  if (surface) link.children.push_back(*std::move(surface));
}

void UrdfMender::mend_inertial(XmlNode& inertial, const std::string& path) {
  XmlNode* inertia = child_of(inertial, "inertia");
  if (inertia == nullptr) {
    inertia = &inertial.children.emplace_back(element_at(inertial, "inertia"));
    for (const char* const moment : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}) set_attribute(*inertia, moment, "0");
    notes_.pass_over(inertial, path, "has no <inertia>; its moments of inertia are set to 0");
  }
  for (const char* const product : {"ixy", "ixz", "iyz"}) {
    if (inertia->attribute(product) != nullptr) continue;
    set_attribute(*inertia, product, "0");
    notes_.pass_over(*inertia, path + "/inertia", "lacks products of inertia; the missing ones are set to 0");
  }
}

void UrdfMender::take_unknown(XmlNode& node, const std::string& path) {
  std::set<std::string> met;
  std::erase_if(node.children, [&](const XmlNode& child) {
    const bool is_again = form_of(node.name, child.name) != nullptr && child.name != "collision" &&
                          child.name != "visual" && !met.insert(child.name).second;
    if (is_again) notes_.pass_over(child, path + "/" + urdf_step(child), "is given twice; only the first is used");
    return is_again;
  });
  std::erase_if(node.children, [&](const XmlNode& child) {
    if (child.name == "visual" || child.name.find(':') != std::string::npos) return false;
    if (form_of(node.name, child.name) != nullptr) return false;
    std::vector<std::string> known;
    for (const UrdfForm& form : urdf_forms())
      if (form.parent == node.name) known.emplace_back(form.name);
    const auto meant = nearest(child.name, known);
    notes_.pass_over(child, path + "/" + urdf_step(child),
                     "ignored the unknown element <" + child.name + "> in <" + node.name + ">" +
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
      notes_.pass_over(child, child_path,
                       "ignored the unknown attribute '" + attribute.first + "' of <" + child.name + ">" +
                           (meant ? "; did you mean '" + *meant + "'?" : ""));
      return true;
    });
    take_unknown(child, child_path);
  }
}

}  // namespace

void mend_urdf(XmlNode& robot, const std::filesystem::path& file, std::vector<Problem>& problems,
               std::vector<Problem>& warnings) {
  UrdfMender(file, problems, warnings).mend(robot);
}

}  // namespace cohort::parsing
