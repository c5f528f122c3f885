#include "server/parsing/sdf/sdf_errors.hpp"

#include <algorithm>
#include <optional>
#include <sdf/Element.hh>
#include <sdf/Error.hh>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/schema/sdf_schema.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

// Returns `/sdf/world[@name="w"]/model[@name="m"]/link` as `world/model[m]/link`.
std::string readable_path(std::string_view xpath) {
  std::string path;
  if (xpath.starts_with("/sdf/")) xpath.remove_prefix(5);
  while (!xpath.empty()) {
    const std::size_t open = std::min(xpath.find("[@"), xpath.size());
    path += xpath.substr(0, open);
    xpath.remove_prefix(open);
    const std::size_t equals = xpath.find("=\"");
    const std::size_t close = xpath.find("\"]");
    if (xpath.empty() || equals == std::string_view::npos || close == std::string_view::npos) break;
    const std::string_view attribute = xpath.substr(2, equals - 2);
    const std::string_view value = xpath.substr(equals + 2, close - equals - 2);
    if (attribute != "name")
      path += "/@" + std::string(attribute);
    else if (path != "world")
      path += "[" + std::string(value) + "]";
    xpath.remove_prefix(close + 2);
  }
  return path;
}

// A message of libsdformat about names, and a replacement that says what would be right.
struct Saying {
  std::string_view part;    // message of libsdformat
  std::string_view before;  // text before the name in it; empty if no name is needed
  std::string_view ours;    // with '*' in place of the name
};
constexpr Saying sayings[] = {
    {"causing a graph cycle", "name[", "'*' refers to itself; expected another frame"},
    {"must not specify its own name", "name[", "the joint '*' refers to itself; expected a link or another frame"},
    {"cycle detected", "", "frames refer to each other in a cycle"},
    {"not found in model", "name[", "there is no link or frame '*' in the model"},
    {"relative_to name[", "name[", "relative_to refers to a frame '*' that does not exist"},
    {"attached_to name[", "name[", "attached_to refers to a frame '*' that does not exist"},
    {"is reserved.", "name [", "the name '*' is reserved; choose another name"},
    {"already exists.", "name[", "the name '*' is already used; names must be unique within their parent element"},
    {"non-unique name", "name [", "another element of the model has the name '*'; names must be unique within a model"},
    {"must have at least one link", "", "expected at least one <link>"},
    {"must specify different frame names", "", "expected two different links as parent and child"},
    {"Root object can only contain one", "", "expected one <model>, <light> or <actor> in a file without a <world>"},
    {"unable to find unique frame", "name [", "there is no frame '*' here"},
    {"invalid child link", "name[", "the child of the joint '*' must be a link of the model"},
};

std::optional<std::string> in_our_words(const std::string& message) {
  for (const Saying& saying : sayings) {
    if (message.find(saying.part) == std::string::npos) continue;
    std::string ours(saying.ours);
    const std::size_t name = saying.before.empty() ? std::string::npos : message.find(saying.before);
    if (name == std::string::npos) return saying.before.empty() ? std::optional(ours) : std::nullopt;
    const std::size_t begin = name + saying.before.size();
    return ours.replace(ours.find('*'), 1, message.substr(begin, message.find(']', begin) - begin));
  }
  return std::nullopt;
}

std::string readable_message(const sdf::Error& error) {
  std::string message = error.Message();
  if (auto ours = in_our_words(message)) return *std::move(ours);
  if (const std::size_t rest = message.find(" Copying["); rest != std::string::npos) message.resize(rest);
  while (!message.empty() && message.back() == '\n') message.pop_back();
  std::replace(message.begin(), message.end(), '\n', ' ');
  return message;
}

bool is_cannot_read_element(const sdf::Error& error) {
  return error.Code() == sdf::ErrorCode::ELEMENT_INVALID && error.Message().starts_with("Error reading element");
}

// Returns whether a check of Cohort or the search for models reports the error with a position.
bool is_said_by_us(const sdf::Error& error) {
  switch (error.Code()) {
    case sdf::ErrorCode::LINK_INERTIA_INVALID:
    case sdf::ErrorCode::URI_LOOKUP: return true;
    case sdf::ErrorCode::DUPLICATE_NAME: return error.Message().starts_with("model with name[");
    case sdf::ErrorCode::ATTRIBUTE_INVALID: return error.Message().starts_with("Joint type of");
    case sdf::ErrorCode::ELEMENT_INVALID:
      return error.Message() == "Failed to load a world." || error.Message().starts_with("The norm of the xyz vector");
    default: return false;
  }
}

// Returns whether the error follows from one before it: a whole with an invalid part, or a graph with an invalid edge.
bool is_consequence(const sdf::Error& error, const std::string& path, const std::string& last_path) {
  switch (error.Code()) {
    case sdf::ErrorCode::ELEMENT_INVALID:
      return (is_cannot_read_element(error) && last_path.starts_with(path)) ||
             error.Message().starts_with("Unable to parse sdf element");
    case sdf::ErrorCode::MODEL_WITHOUT_LINK:
    case sdf::ErrorCode::FRAME_ATTACHED_TO_GRAPH_ERROR:
    case sdf::ErrorCode::POSE_RELATIVE_TO_GRAPH_ERROR: return true;
    default:
      return error.Message().starts_with("FrameAttachedToGraph") || error.Message().starts_with("PoseRelativeToGraph");
  }
}

// Returns the path, with links and names as in the URDF, of the element at `steps` below a node.
std::string written_path(const XmlNode& node, const std::string& path, const std::string& steps) {
  for (const XmlNode& child : node.children) {
    const std::string step = step_of(child);
    if (steps == step) return path_below(path, child);
    if (steps.starts_with(step + "/"))
      return written_path(child, path_below(path, child), steps.substr(step.size() + 1));
  }
  return path + (path.empty() ? "" : "/") + steps;
}

struct Place {
  const XmlNode* node;
  std::string path;
};

// Returns the last element of this kind and name under `from`, since the second of two equal names is the error. An
// include counts as a model.
std::optional<Place> find_named(const XmlNode& from, const std::string& path, std::string_view kind,
                                std::string_view name) {
  std::optional<Place> found;
  for (const XmlNode& child : from.children) {
    const std::string child_path = path_below(path, child);
    const bool is_kind = child.name == kind || (child.name == "include" && kind == "model");
    if (is_kind && name_of(child) == name) found = Place{&child, child_path};
    if (auto deeper = find_named(child, child_path, kind, name)) found = std::move(deeper);
  }
  return found;
}

// Returns the name in the first `KIND with name[NAME]` of a message, or in the first `name[NAME]` if the kind is empty.
std::optional<std::string> name_in(std::string_view message, std::string_view kind, std::size_t start = 0) {
  const std::string before = kind.empty() ? "name[" : std::string(kind) + " with name[";
  const std::size_t found = message.find(before, start);
  if (found == std::string_view::npos) return std::nullopt;
  const std::size_t begin = found + before.size();
  return std::string(message.substr(begin, message.find(']', begin) - begin));
}

// Errors of the second stage of libsdformat have no position, but names of the elements concerned: "... specified by
// joint with name[j] ... in model with name[m]".
std::optional<Place> place_named_in(std::string message, const XmlNode& xml) {
  for (const char* const kind : {"Model", "Link", "Joint", "Frame", "Collision"})
    for (std::size_t at = message.find(kind); at != std::string::npos; at = message.find(kind, at))
      message[at] = static_cast<char>(message[at] - 'A' + 'a');

  std::optional<Place> scope;
  if (const auto model = name_in(message, "model")) scope = find_named(xml, "", "model", *model);
  const std::size_t subject = message.find("specified by ");
  const std::size_t start = subject == std::string::npos ? 0 : subject;
  for (const char* const kind : {"joint", "link", "frame", "collision"})
    if (const auto name = name_in(message, kind, start)) {
      auto place = scope ? find_named(*scope->node, scope->path, kind, *name) : find_named(xml, "", kind, *name);
      if (place) return place;
    }
  return scope;
}

// Returns the definition in SDFormat of the element at a readable path, which starts below the root; nullptr if there
// is none.
sdf::ElementPtr definition_of(std::string_view path) {
  sdf::ElementPtr element = sdf_definition();
  while (element && !path.empty()) {
    const std::string step(path.substr(0, path.find('/')));
    const std::string name = step.substr(0, step.find('['));
    path.remove_prefix(std::min(path.size(), step.size() + 1));
    // Models can be nested; nested models have the definition of the outer one.
    if (name != element->GetName()) element = element->GetElementDescription(name);
  }
  return element;
}

// `XML Element[x], child of element[y], not defined in SDF.` and the like.
bool is_unknown(const sdf::Error& error) { return error.Message().find("not defined in SDF") != std::string::npos; }
bool is_missing_attribute(const sdf::Error& error) { return error.Message().starts_with("Required attribute["); }

// Returns the text in the first brackets of a message.
std::string in_brackets(const std::string& message) {
  const std::size_t begin = std::min(message.find('['), message.size() - 1) + 1;
  return message.substr(begin, message.find(']', begin) - begin);
}

// Returns the path of an unknown element or attribute in SDFormat, without its last step.
std::string_view parent_of(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  return path.substr(0, slash == std::string_view::npos ? 0 : slash);
}

std::vector<std::string> known_names(const sdf::Error& error, std::string_view parent) {
  const sdf::ElementPtr definition = definition_of(parent);
  std::vector<std::string> names;
  if (!definition) return names;
  if (error.Message().starts_with("XML Attribute"))
    for (const sdf::ParamPtr& attribute : definition->GetAttributes()) names.push_back(attribute->GetKey());
  else
    for (std::size_t i = 0; i < definition->GetElementDescriptionCount(); ++i)
      names.push_back(definition->GetElementDescription(static_cast<unsigned>(i))->GetName());
  return names;
}

std::string cannot_have(const XmlNode& node) { return "<" + node.name + "> cannot have the value '" + node.text + "'"; }

// Returns a message with the value for `Error reading element <NAME>`, in which libsdformat omits it.
std::string message_with_value(const sdf::Error& error, const XmlNode* node) {
  std::string name = error.Message().substr(error.Message().find('<') + 1);
  name.resize(std::min(name.find('>'), name.size()));
  if (node == nullptr || node->name != name || !node->children.empty()) return "<" + name + "> cannot be read";
  return cannot_have(*node);
}

// Replaces a <frame> in the path by the <include> that it represents.
void name_include(std::string& path, const SdfFile& file) {
  constexpr std::string_view frame = "world/frame[";
  if (!path.starts_with(frame)) return;
  const std::size_t end = path.find(']');
  if (file.is_include(path.substr(frame.size(), end - frame.size()))) path.replace(0, frame.size(), "world/include[");
}

// Names, each after the readable path of its parent element.
using PlacedNames = std::set<std::pair<std::string, std::string>>;

// Adds a suggestion. If it is an attribute, it is added to `misspelt`.
void explain_unknown(const sdf::Error& error, Problem& problem, PlacedNames& misspelt) {
  const std::string parent(parent_of(problem.element));
  const std::string name = in_brackets(error.Message());
  const std::vector<std::string> known = known_names(error, parent);
  const bool is_attribute = error.Message().starts_with("XML Attribute");
  problem.message = std::string(is_attribute ? "unknown attribute" : "unknown element") + suggestion(name, known);
  if (const auto meant = nearest(name, known); meant && is_attribute) misspelt.emplace(parent, *meant);
}

void replace_bad_values_below(XmlNode& node, const ElementSchema& schema, const std::string& path, const SdfFile& file,
                              std::vector<Problem>& problems) {
  for (XmlNode& child : node.children) {
    const ElementSchema of_child = schema.child(child.name);
    if (of_child.is_free() || of_child.is_extension()) continue;
    const std::string child_path = path_below(path, child);
    // A pose can be written in several ways, depending on its attributes.
    const bool is_as_usual = child.attribute("rotation_format") == nullptr && child.attribute("degrees") == nullptr;
    if (!child.text.empty() && is_as_usual && !of_child.can_have(child.text)) {
      std::string shown_path = child_path;
      name_include(shown_path, file);
      problems.push_back({child.file->shown, child.line, shown_path, cannot_have(child)});
      child.text = of_child.default_text();
    }
    replace_bad_values_below(child, of_child, child_path, file, problems);
  }
}

}  // namespace

std::vector<Problem> replace_bad_values(SdfFile& file) {
  std::vector<Problem> problems;
  replace_bad_values_below(file.tree, ElementSchema::root(), "", file, problems);
  return problems;
}

std::vector<Problem> problems_of(const sdf::Errors& errors, const SdfFile& file) {
  // An error without a position is searched for in the whole file.
  constexpr std::size_t most_problems = 100;
  const XmlNode& tree = file.tree;
  std::vector<Problem> problems;
  std::set<std::string> without_position;  // messages: equal ones lead to the same place
  PlacedNames named;                       // the invalid ones
  PlacedNames misspelt;                    // attributes that misspelt ones were taken for
  std::string last_path;
  for (const sdf::Error& error : errors) {
    if (problems.size() == most_problems) break;
    if (is_said_by_us(error)) continue;
    const std::string path = error.XmlPath().value_or("");
    const bool follows = !problems.empty() && is_consequence(error, path, last_path);
    last_path = path;
    if (follows) continue;

    const XmlNode* node = file.node_at(error.LineNumber().value_or(0));
    Problem problem{file.shown, 0, readable_path(path), readable_message(error)};
    if (is_unknown(error)) {
      explain_unknown(error, problem, misspelt);
    } else if (is_missing_attribute(error)) {
      const std::string name = in_brackets(error.Message());
      if (misspelt.contains({problem.element, name})) continue;
      problem.message = "missing: the attribute '" + name + "'";
    } else if (node == nullptr && path.empty()) {
      if (!without_position.insert(error.Message()).second) continue;
      if (const auto place = place_named_in(error.Message(), tree)) {
        node = place->node;
        problem.element = place->path;
      } else if (const XmlNode* const model = tree.child("model")) {
        node = model;
        problem.element = step_of(*model);
      }
      // One unknown name is reported three times: as a frame, as a link and as the reference of a pose.
      const std::string name = name_in(error.Message(), "").value_or(error.Message());
      if (!named.emplace(problem.element, name).second) continue;
    } else if (is_cannot_read_element(error)) {
      problem.message = message_with_value(error, node);
    }
    if (node != nullptr) {
      problem.file = node->file->shown;
      problem.line = node->line;
    }
    problem.element = written_path(tree, "", problem.element);
    name_include(problem.element, file);
    problems.push_back(std::move(problem));
  }
  return problems;
}

}  // namespace cohort::parsing
