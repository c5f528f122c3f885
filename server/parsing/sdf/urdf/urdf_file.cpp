#include "server/parsing/sdf/urdf/urdf_file.hpp"

#include <console_bridge/console.h>

#include <algorithm>
#include <memory>
#include <sdf/SDFImpl.hh>
#include <sdf/parser.hh>
#include <set>
#include <string>

#include "server/parsing/keys/extensions.hpp"
#include "server/parsing/sdf/schema/libsdformat_scope.hpp"
#include "server/parsing/sdf/urdf/mend_urdf.hpp"
#include "server/parsing/sdf/urdf/urdf_sources.hpp"

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

  UrdfSources sources(robot);
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
  XmlNode tree = sources.tree(sdf->Root());
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
