#include <algorithm>
#include <iterator>
#include <map>
#include <sdf/SDFImpl.hh>
#include <sdf/parser.hh>
#include <span>
#include <stdexcept>
#include <utility>

#include "server/parsing/files/sdf_version.hpp"
#include "server/parsing/sdf/libsdformat_failure.hpp"
#include "server/parsing/sdf/scoped_names.hpp"
#include "server/parsing/sdf/sdf_errors.hpp"
#include "server/parsing/sdf/sdf_files.hpp"
#include "server/parsing/sdf/sdf_schema.hpp"
#include "server/parsing/sdf/sdf_values.hpp"
#include "server/parsing/sdf/xml_edit.hpp"

// Files of older versions of SDF as such of the newest.
namespace cohort::parsing {
namespace {

// An <include> of an older version is put aside, since libsdformat would follow it. A <frame> keeps its place.
constexpr std::string_view aside = "cohort:include:";

void take_includes(XmlNode& node, std::vector<XmlNode>& taken) {
  for (XmlNode& child : node.children) {
    if (child.name == "world" || child.name == "model") take_includes(child, taken);
    if (child.name != "include") continue;
    XmlNode mark{"frame", child.line, child.file, {{"name", std::string(aside) + std::to_string(taken.size())}},
                 "",      {}};
    taken.push_back(std::exchange(child, std::move(mark)));
    for (XmlNode& part : taken.back().children)
      for (auto& [name, value] : part.attributes)
        if (part.name == "pose" && name == "frame") name = "relative_to";  // its name up to SDF 1.6
  }
}

void put_back(XmlNode& node, const std::vector<XmlNode>& taken) {
  for (XmlNode& child : node.children) {
    const std::string name = name_of(child);
    if (child.name == "frame" && name.starts_with(aside)) child = taken[std::stoul(name.substr(aside.size()))];
    put_back(child, taken);
  }
}

// libsdformat takes 2 MB for a model while it converts one, so that of a world with many some go at a time.
constexpr std::size_t most_models_at_once = 16;

// As above, if there are many. The place of the first of them in `taken`.
std::size_t take_models(XmlNode& tree, std::vector<XmlNode>& taken) {
  const std::size_t first = taken.size();
  XmlNode* const world = child_of(tree, "world");
  const auto is_model = [](const XmlNode& child) { return child.name == "model"; };
  if (world == nullptr ||
      static_cast<std::size_t>(std::ranges::count_if(world->children, is_model)) <= most_models_at_once)
    return first;
  for (XmlNode& child : world->children) {
    if (!is_model(child)) continue;
    XmlNode mark = element_at(child, "frame");
    mark.attributes = {{"name", std::string(aside) + std::to_string(taken.size())}};
    taken.push_back(std::exchange(child, std::move(mark)));
  }
  return first;
}

// Those that are converted for all that are alike: for each model the place of the first like it.
std::vector<std::size_t> first_alike(std::span<const XmlNode> models) {
  std::map<std::string, std::size_t> places;
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < models.size(); ++i) {
    std::string content;
    add_content(models[i], content);
    first.push_back(places.emplace(std::move(content), i).first->second);
  }
  return first;
}

// The one that was converted, with the name and the place of one like it.
XmlNode as_alike(XmlNode converted, const XmlNode& alike) {
  set_attribute(converted, "name", value_of(alike, "name"));
  const XmlNode* const pose = alike.child("pose");
  if (XmlNode* const own = child_of(converted, "pose"); own != nullptr && pose != nullptr) own->text = pose->text;
  return converted;
}

// A world with nothing but these models.
XmlNode with_models(const XmlNode& tree, std::span<XmlNode> models) {
  XmlNode some = element_at(tree, tree.name);
  some.attributes = tree.attributes;
  const XmlNode& whole = *tree.child("world");
  XmlNode& world = some.children.emplace_back(element_at(whole, "world"));
  world.attributes = whole.attributes;
  world.children.assign(std::move_iterator(models.begin()), std::move_iterator(models.end()));
  return some;
}

// What is said of a mark is said of what it stands for.
void name_what_is_aside(Problem& problem, const std::vector<XmlNode>& taken) {
  const std::string before = "frame[" + std::string(aside);
  const std::size_t at = problem.element.find(before);
  const std::size_t end = problem.element.find(']', at);
  if (at == std::string::npos || end == std::string::npos) return;
  const std::size_t number = at + before.size();
  problem.element.replace(at, end + 1 - at, step_of(taken[std::stoul(problem.element.substr(number, end - number))]));
}

// What libsdformat has made of a text, with the lines of the nodes that it was written from.
XmlNode tree_of(const sdf::ElementPtr& element, const XmlNode& parent, const std::vector<const XmlNode*>& nodes) {
  const auto line = static_cast<std::size_t>(element->LineNumber().value_or(0));
  const XmlNode* const unknown = parent.child(element->GetName());  // libsdformat copies it without its line
  const XmlNode& source = line > 0 && line < nodes.size() ? *nodes[line] : unknown != nullptr ? *unknown : parent;
  XmlNode node{element->GetName(), source.line, source.file, {}, "", {}};
  for (const sdf::ParamPtr& attribute : element->GetAttributes())
    if (attribute->GetSet()) node.attributes.emplace_back(attribute->GetKey(), attribute->GetAsString());
  node.text = written_text(element);
  for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement())
    if (child->GetExplicitlySetInFile()) node.children.push_back(tree_of(child, source, nodes));
  return node;
}

}  // namespace

std::optional<XmlNode> SdfFiles::converted(XmlNode tree, SdfFile& file) {
  file.version = *tree.attribute("version");
  const bool may_be_scoped = version_of(file.version) < std::pair{1, 8};
  if (may_be_scoped || file.is_foreign) join_scoped_names(tree, file.shown, may_be_scoped ? nullptr : &warnings_);
  if (!names_are_simple(tree, "")) return std::nullopt;
  if (file.version == sdf::SDF::Version()) return tree;
  std::vector<XmlNode> taken;
  take_includes(tree, taken);
  const std::size_t first = take_models(tree, taken);
  std::optional<XmlNode> newest = convert(tree, taken, file);
  const std::span<XmlNode> models = std::span(taken).subspan(first);
  const std::vector<std::size_t> alike = first_alike(models);
  std::vector<XmlNode> kinds;
  std::vector<std::size_t> kind_of(models.size());
  for (std::size_t i = 0; i < models.size(); ++i) {
    kind_of[i] = alike[i] == i ? kinds.size() : kind_of[alike[i]];
    if (alike[i] == i) kinds.push_back(models[i]);
  }
  for (std::size_t i = 0; i < kinds.size() && newest; i += most_models_at_once) {
    const std::span<XmlNode> some = std::span(kinds).subspan(i, std::min(most_models_at_once, kinds.size() - i));
    std::optional<XmlNode> done = convert(with_models(tree, some), taken, file);
    if (!done) return std::nullopt;
    std::ranges::move(done->children.front().children, some.begin());
  }
  for (std::size_t i = 0; i < models.size() && newest; ++i) models[i] = as_alike(kinds[kind_of[i]], models[i]);
  if (newest) put_back(*newest, taken);
  return newest;
}

std::optional<XmlNode> SdfFiles::convert(const XmlNode& tree, const std::vector<XmlNode>& aside, SdfFile& file) {
  XmlText written = xml_text_of(tree);
  file.nodes = std::move(written.nodes);
  sdf::Errors errors;
  const sdf::SDFPtr sdf = empty_sdf();
  sdf->SetFilePath(file.path.string());
  bool is_read = false;
  std::vector<Problem> found;
  const auto failure = libsdformat_failure([&] {
    is_read = sdf::readString(written.text, libsdformat_.config(), sdf->Root(), errors);
    if (file.is_foreign) take_unknown_names(errors, file, warnings_);
    found = problems_of(errors, file, tree);
  });
  if (failure) found.push_back({file.shown, 0, "", "libsdformat cannot read this file: " + *failure});
  if (!is_read && found.empty()) found.push_back({file.shown, 0, "", "libsdformat cannot read this file"});
  for (Problem& problem : found) name_what_is_aside(problem, aside);
  problems_.insert(problems_.end(), found.begin(), found.end());
  if (!is_read) return std::nullopt;
  XmlNode newest = tree_of(sdf->Root(), tree, file.nodes);
  for (const auto& [name, value] : tree.attributes)
    if (name.starts_with("xmlns:") && newest.attribute(name) == nullptr) newest.attributes.emplace_back(name, value);
  file.nodes.clear();
  return newest;
}

}  // namespace cohort::parsing
