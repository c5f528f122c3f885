#include "server/parsing/sdf/urdf/urdf_file.hpp"

#include <console_bridge/console.h>

#include <algorithm>
#include <map>
#include <memory>
#include <sdf/SDFImpl.hh>
#include <sdf/parser.hh>
#include <set>
#include <string>
#include <string_view>

#include "server/parsing/keys/extensions.hpp"
#include "server/parsing/sdf/schema/libsdformat_scope.hpp"
#include "server/parsing/sdf/urdf/mend_urdf.hpp"

namespace cohort::parsing {
namespace {

/// Captures the output of the URDF reader.
class ConsoleCapture : public console_bridge::OutputHandler {
 public:
  ConsoleCapture() { console_bridge::useOutputHandler(this); }
  ~ConsoleCapture() override { console_bridge::restorePreviousOutputHandler(); }
  ConsoleCapture(const ConsoleCapture&) = delete;
  ConsoleCapture& operator=(const ConsoleCapture&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors_ += (errors_.empty() ? "" : "; ") + text;
  }
  const std::string& errors() const { return errors_; }

 private:
  std::string errors_;
};

// Returns an <sdf> that accepts any children as texts. Their values are read when elements are made from the tree.
sdf::SDFPtr unchecked_sdf() {
  const sdf::SDFPtr sdf = std::make_shared<sdf::SDF>();
  const sdf::ElementPtr root = std::make_shared<sdf::Element>();
  root->SetName("sdf");
  root->SetCopyChildren(true);
  root->AddAttribute("version", "string", sdf::SDF::Version(), true);
  sdf->Root(root);
  return sdf;
}

// Returns the name of the URDF element to which an SDF element corresponds.
std::string urdf_name(const std::string& sdf) {
  constexpr std::pair<std::string_view, std::string_view> names[] = {
      {"pose", "origin"},     {"uri", "mesh"}, {"scale", "mesh"},  {"size", "box"},    {"radius", "geometry"},
      {"length", "cylinder"}, {"xyz", "axis"}, {"lower", "limit"}, {"upper", "limit"}, {"damping", "dynamics"}};
  for (const auto& [in_sdf, in_urdf] : names)
    if (in_sdf == sdf) return std::string(in_urdf);
  return sdf;
}

const XmlNode* find_below(const XmlNode& node, const std::string& name) {
  for (const XmlNode& child : node.children) {
    if (child.name == name) return &child;
    if (const XmlNode* const found = find_below(child, name)) return found;
  }
  return nullptr;
}

class LineFinder {
 public:
  explicit LineFinder(const XmlNode& robot) {
    for (const XmlNode& child : robot.children)
      if (const std::string* const name = child.attribute("name");
          name != nullptr && (child.name == "link" || child.name == "joint"))
        named_.emplace(*name, &child);
  }

  XmlNode tree(const sdf::ElementPtr& element, const XmlNode& around) const {
    const XmlNode* source = &around;
    if (const XmlNode* const named = find(element))
      source = named;
    else if (const XmlNode* const below = find_below(around, urdf_name(element->GetName())))
      source = below;
    XmlNode node{element->GetName(), source->line, nullptr, {}, "", {}};
    for (const sdf::ParamPtr& attribute : element->GetAttributes())
      node.attributes.emplace_back(attribute->GetKey(), attribute->GetAsString());
    if (element->GetValue()) node.text = element->GetValue()->GetAsString();
    for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement())
      node.children.push_back(tree(child, *source));
    return node;
  }

 private:
  // `wheel_fixed_joint_lump__axle_collision_1` comes from the second collision of the link `axle`.
  const XmlNode* find(const sdf::ElementPtr& element) const {
    if (!element->GetAttributeSet("name")) return nullptr;
    std::string name = element->GetAttribute("name")->GetAsString();
    if (const auto exact = named_.find(name); exact != named_.end()) return exact->second;
    constexpr std::string_view lump = "_fixed_joint_lump__";
    if (const std::size_t at = name.find(lump); at != std::string::npos) name.erase(0, at + lump.size());
    const std::size_t kind = name.rfind("_collision");
    const auto link = named_.find(name.substr(0, kind));
    if (kind == std::string::npos || link == named_.end()) return nullptr;
    const XmlNode* const collision = link->second->child("collision");
    return collision != nullptr ? collision : link->second;
  }

  std::map<std::string, const XmlNode*> named_;
};

// Returns the joint above a link; nullptr for the root.
const XmlNode* joint_above(const XmlNode& robot, const std::string& link) {
  for (const XmlNode& joint : robot.children)
    if (joint.name == "joint" && *joint.child("child")->attribute("link") == link) return &joint;
  return nullptr;
}

// Returns whether the converter keeps a link: it merges links that a fixed joint connects, and omits those it cannot
// use.
bool is_kept(const XmlNode& robot, const std::string& link, const std::set<std::string>& names) {
  if (names.contains(link)) return true;
  const XmlNode* const joint = joint_above(robot, link);
  return joint != nullptr && *joint->attribute("type") == "fixed" &&
         is_kept(robot, *joint->child("parent")->attribute("link"), names);
}

XmlNode* find_joint(XmlNode& node, const std::string& name) {
  for (XmlNode& child : node.children) {
    const std::string* const own = child.name == "joint" ? child.attribute("name") : nullptr;  // none for a plugin
    if (own != nullptr && *own == name) return &child;
    if (XmlNode* const found = find_joint(child, name)) return found;
  }
  return nullptr;
}

// The converter of libsdformat omits <mimic>.
XmlNode extension_of(const XmlNode& mimic) {
  XmlNode extension{prefixed("mimic"), mimic.line, nullptr, {}, "", {}};
  for (const auto& [name, value] : mimic.attributes)
    extension.children.push_back({prefixed(name), mimic.line, nullptr, {}, value, {}});
  return extension;
}

void collect_names(const XmlNode& node, std::set<std::string>& names) {
  if (const std::string* const name = node.attribute("name")) names.insert(*name);
  for (const XmlNode& child : node.children) collect_names(child, names);
}

}  // namespace

std::optional<XmlNode> sdf_of_urdf(XmlNode robot, const std::filesystem::path& file, const sdf::ParserConfig& config,
                                   std::vector<Problem>& problems, std::vector<Problem>& warnings) {
  const std::size_t before = problems.size();
  const UrdfRest rest = mend_urdf(robot, file, problems, warnings);
  check_urdf(robot, file, problems, warnings);
  if (problems.size() > before) return std::nullopt;

  const ConsoleCapture console;
  sdf::ParserConfig tolerant = config;  // unknown elements are reported for the resulting SDF
  tolerant.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
  tolerant.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::LOG);
  sdf::Errors errors;
  const sdf::SDFPtr sdf = unchecked_sdf();
  bool is_read = false;
  // The content of <gazebo> may stop it, for example.
  std::string why = libsdformat_failure([&] {
                      is_read = sdf::readString(xml_text_of(robot).text, tolerant, sdf, errors);
                    }).value_or("");
  if (!is_read || !sdf->Root()->HasElement("model")) {
    why += console.errors();
    for (const sdf::Error& error : errors) why += (why.empty() ? "" : "; ") + error.Message();
    problems.push_back(
        {file, robot.line, "robot", "libsdformat cannot convert this URDF to SDF" + (why.empty() ? "" : ": " + why)});
    return std::nullopt;
  }
  XmlNode tree = LineFinder(robot).tree(sdf->Root(), robot);
  tree.attributes = {{"version", sdf::SDF::Version()}, {"xmlns:cohort", "https://cohort-sim.org/sdf/1"}};
  for (const XmlNode& joint : robot.children)
    if (const XmlNode* const mimic = joint.name == "joint" ? joint.child("mimic") : nullptr)
      if (XmlNode* const converted = find_joint(tree, *joint.attribute("name")))
        converted->children.push_back(extension_of(*mimic));
  for (XmlNode& model : tree.children)
    if (model.name == "model") add_rest(rest, model);
  std::set<std::string> names;
  collect_names(tree, names);
  for (const XmlNode& link : robot.children) {
    if (link.name != "link" || is_kept(robot, *link.attribute("name"), names)) continue;
    const std::string path = "robot/link[" + *link.attribute("name") + "]";
    if (*link.attribute("name") != "world")
      problems.push_back({file, link.line, path, "the URDF converter of libsdformat omits this link and its joint"});
    else if (link.child("collision") != nullptr)
      warnings.push_back(
          {file, link.line, path, "the link 'world' is treated as the world; its collisions are ignored"});
  }
  if (problems.size() > before) return std::nullopt;
  return tree;
}

}  // namespace cohort::parsing
