// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "server/core/text.hpp"
#include "server/parsing/sdf/urdf/mend_urdf.hpp"
#include "server/parsing/sdf/urdf/urdf_file.hpp"
#include "server/parsing/sdf/urdf/urdf_forms.hpp"
#include "server/parsing/sdf/urdf/urdf_gazebo.hpp"
#include "server/parsing/sdf/urdf/urdf_tree.hpp"

namespace cohort::parsing {
namespace {

constexpr std::string_view joint_types[] = {"revolute", "continuous", "prismatic", "fixed", "floating", "spherical"};

class Checker {
 public:
  Checker(const std::filesystem::path& file, std::vector<Problem>& problems, std::vector<Problem>& warnings)
      : file_(file), problems_(problems), warnings_(warnings) {}

  void check(const XmlNode& robot);

 private:
  void problem(const XmlNode& node, const std::string& path, std::string message) {
    problems_.push_back({file_, node.line, path, std::move(message)});
  }
  void warning(const XmlNode& node, const std::string& path, std::string message) {
    warnings_.push_back({file_, node.line, path, std::move(message)});
  }
  void check_top(const XmlNode& node);
  void check_form(const XmlNode& node, const std::string& path);
  void check_attributes(const XmlNode& node, const UrdfForm& form, const std::string& path);
  void check_gazebo(const XmlNode& gazebo);
  void check_link(const XmlNode& link, const std::string& path);
  void check_joint(const XmlNode& joint, const std::string& path);
  void check_tree(const XmlNode& robot);
  /// Reports a missing link that <parent> or <child> names.
  void check_end(const XmlNode& joint, const std::string& path, const char* end);

  const std::filesystem::path& file_;
  std::vector<Problem>& problems_;
  std::vector<Problem>& warnings_;
  std::map<std::string, const XmlNode*> links_;
  std::map<std::string, const XmlNode*> joints_;
};

void Checker::check(const XmlNode& robot) {
  for (const XmlNode& child : robot.children) check_top(child);
  if (links_.empty()) {
    const bool is_srdf = robot.child("group") != nullptr || robot.child("disable_collisions") != nullptr;
    problem(robot, urdf_step(robot),
            is_srdf ? "this is an SRDF, which describes groups of joints for MoveIt; expected a URDF, with <link>"
                    : "expected at least one <link>");
  }
  for (const auto& [name, joint] : joints_) {
    const std::string path = urdf_step(robot) + "/" + urdf_step(*joint);
    check_end(*joint, path, "parent");
    check_end(*joint, path, "child");
  }
  if (problems_.empty()) check_tree(robot);
}

void Checker::check_top(const XmlNode& node) {
  const std::string path = "robot/" + urdf_step(node);
  if (node.name.starts_with("xacro:")) {
    problem(node, path, "this is a xacro file; expected the URDF that `xacro FILE` generates from it");
  } else if (node.name == "link" || node.name == "joint") {
    const std::string* const name = node.attribute("name");
    if (name == nullptr || name->empty() || name->find("::") != std::string::npos)
      problem(node, path, "expected an attribute name=\"NAME\", with a NAME without '::'");
    else if (!(node.name == "link" ? links_ : joints_).emplace(*name, &node).second)
      problem(node, path, "another " + node.name + " has the name '" + *name + "'");
    node.name == "link" ? check_link(node, path) : check_joint(node, path);
  } else if (node.name == "transmission") {
    warning(node, path, "<transmission> is not supported and is ignored; define motors with cohort: elements");
  } else if (node.name == "gazebo") {
    check_gazebo(node);
  } else if (form_of("robot", node.name) == nullptr) {
    warning(node, path, "<" + node.name + "> is not supported and is ignored");
  }
}

void Checker::check_form(const XmlNode& node, const std::string& path) {
  for (const XmlNode& child : node.children) {
    const UrdfForm* const form = form_of(node.name, child.name);
    if (form == nullptr || child.name == "visual") continue;
    const std::string child_path = path + "/" + urdf_step(child);
    check_attributes(child, *form, child_path);
    check_form(child, child_path);
  }
}

void Checker::check_attributes(const XmlNode& node, const UrdfForm& form, const std::string& path) {
  for (const UrdfAttribute& attribute : form.attributes) {
    const std::string name(attribute.name);
    const std::string* const value = node.attribute(name);
    if (value == nullptr) {
      if (attribute.required) problem(node, path, "missing: the attribute '" + name + "'");
      continue;
    }
    if (const std::optional<std::string> wrong = what_is_wrong(*value, attribute)) problem(node, path, *wrong);
  }
}

void Checker::check_gazebo(const XmlNode& gazebo) {
  for (const XmlNode& child : gazebo.children) {
    if (!is_gazebo_number(child.name)) continue;
    if (const auto wrong = what_is_wrong(gazebo_value(child), {child.name, 1}))
      problem(child, "robot/gazebo/" + child.name, *wrong);
  }
}

void Checker::check_link(const XmlNode& link, const std::string& path) {
  check_form(link, path);
  const XmlNode* const inertial = link.child("inertial");
  const XmlNode* const mass = inertial != nullptr ? inertial->child("mass") : nullptr;
  const std::string value = mass != nullptr ? value_of(*mass, "value") : "";
  if (parse_real(value).value_or(0.0) < 0.0)
    problem(*mass, path + "/inertial/mass", "expected a mass > 0 kg, not " + value);
}

void Checker::check_joint(const XmlNode& joint, const std::string& path) {
  check_form(joint, path);
  const std::string* const type = joint.attribute("type");
  if (type == nullptr) {
    problem(joint, path, "missing: the attribute 'type'");
  } else if (std::find(std::begin(joint_types), std::end(joint_types), *type) == std::end(joint_types)) {
    problem(joint, path,
            "the joint type '" + *type + "' is not supported; expected revolute, continuous, prismatic or fixed");
  }
  for (const char* const end : {"parent", "child"})
    if (joint.child(end) == nullptr) problem(joint, path, "missing: <" + std::string(end) + " link=\"NAME\"/>");
  for (const XmlNode& child : joint.children)
    if (const UrdfForm* const form = form_of("joint", child.name); form != nullptr && !form->has_effect)
      warning(child, path + "/" + child.name, "<" + child.name + "> is not supported and is ignored");
}

void Checker::check_end(const XmlNode& joint, const std::string& path, const char* end) {
  const std::string link = urdf_end(joint, end);
  if (link.empty() || links_.contains(link)) return;
  std::vector<std::string> names;
  for (const auto& [name, node] : links_) names.push_back(name);
  problem(*joint.child(end), path + "/" + end, "the robot has no link '" + link + "'" + suggestion(link, names));
}

void Checker::check_tree(const XmlNode& robot) {
  std::map<std::string, std::string> parent;
  for (const auto& [name, joint] : joints_)
    if (!parent.emplace(urdf_end(*joint, "child"), urdf_end(*joint, "parent")).second)
      problem(*joint, urdf_step(robot) + "/" + urdf_step(*joint),
              "the link '" + urdf_end(*joint, "child") + "' is already the child of another joint");
  std::string roots;
  std::size_t count = 0;
  for (const auto& [name, node] : links_) {
    if (parent.contains(name)) continue;
    roots += (count++ == 0 ? "'" : ", '") + name + "'";
  }
  if (count > 1)
    problem(robot, urdf_step(robot), "expected one root link (a link without a parent joint), not " + roots);
  // Each ascent ends at a root or at a visited link; if it was visited in this ascent, there is a loop.
  std::set<std::string> met;
  for (const auto& [name, node] : links_) {
    std::set<std::string> now;
    std::string link = name;
    while (parent.contains(link) && met.insert(link).second) {
      now.insert(link);
      link = parent[link];
    }
    if (now.contains(link))
      problem(*links_[link], urdf_step(robot) + "/link[" + link + "]",
              "is in a loop of joints; expected a tree of links");
  }
}

}  // namespace

void check_urdf(const XmlNode& robot, const std::filesystem::path& file, std::vector<Problem>& problems,
                std::vector<Problem>& warnings) {
  std::vector<Problem> found;
  Checker(file, found, warnings).check(robot);
  problems.insert(problems.end(), found.begin(), found.end());
}

}  // namespace cohort::parsing
