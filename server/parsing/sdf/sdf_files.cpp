#include "server/parsing/sdf/sdf_files.hpp"

#include <algorithm>
#include <iostream>
#include <memory>
#include <sdf/Console.hh>
#include <sdf/SDFImpl.hh>
#include <sdf/parser.hh>
#include <stdexcept>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/files/sdf_version.hpp"
#include "server/parsing/files/xacro.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/parsing/sdf/libsdformat_failure.hpp"
#include "server/parsing/sdf/mend_sdf.hpp"
#include "server/parsing/sdf/newer_sdf.hpp"
#include "server/parsing/sdf/sdf_errors.hpp"
#include "server/parsing/sdf/sdf_schema.hpp"
#include "server/parsing/sdf/sdf_values.hpp"
#include "server/parsing/sdf/unknown_names.hpp"
#include "server/parsing/sdf/urdf_file.hpp"
#include "server/parsing/sdf/what_is_seen.hpp"
#include "server/parsing/sdf/xml_edit.hpp"
#include "server/parsing/sdf/yaml_sdf.hpp"

namespace cohort::parsing {
namespace {

namespace fs = std::filesystem;

std::mutex& libsdformat_mutex() {
  static std::mutex mutex;
  return mutex;
}

// libsdformat keeps a log of its own in the home folder, and says so on standard error where there is none.
sdf::Console& console() {
  static const sdf::ConsolePtr made = [] {
    std::streambuf* const before = std::cerr.rdbuf(nullptr);
    sdf::ConsolePtr silent = sdf::Console::Instance();
    std::cerr.rdbuf(before);
    return silent;
  }();
  return *made;
}

// There is one world, whose name does not matter.
std::string step_of(const std::string& element, const std::string& name) {
  return name.empty() || element == "world" ? element : element + "[" + name + "]";
}

std::string step_of(const sdf::ElementPtr& element) {
  const bool has_name = element->GetAttributeSet("name");
  return step_of(element->GetName(), has_name ? element->GetAttribute("name")->GetAsString() : "");
}

// How many elements of the same name and file stand before it.
std::size_t place_among_siblings(const sdf::ElementPtr& element) {
  std::size_t place = 0;
  for (sdf::ElementPtr sibling = element->GetParent()->GetFirstElement(); sibling && sibling != element;
       sibling = sibling->GetNextElement())
    if (sibling->GetName() == element->GetName() && sibling->FilePath() == element->FilePath()) ++place;
  return place;
}

void set_file(XmlNode& node, const SdfFile* file) {
  node.file = file;
  for (XmlNode& child : node.children) set_file(child, file);
}

// SDF asks every <heightmap> for the <uri> of an image, also one that is a function.
void name_terrains(XmlNode& node) {
  for (XmlNode& child : node.children) name_terrains(child);
  if (node.name == "heightmap" && node.child("cohort:terrain") != nullptr && node.child("uri") == nullptr)
    node.children.push_back({"uri", node.line, node.file, {}, "cohort:terrain", {}});
}

std::size_t size_of(const XmlNode& node) {
  std::size_t size = 1;
  for (const XmlNode& child : node.children) size += size_of(child);
  return size;
}

void add_names(const XmlNode& node, std::set<std::string>& names) {
  names.insert(node.name);
  for (const XmlNode& child : node.children) add_names(child, names);
}

const XmlNode* nth_child(const XmlNode& node, std::string_view name, std::size_t n) {
  for (const XmlNode& child : node.children)
    if (child.name == name && n-- == 0) return &child;
  return nullptr;
}

bool is_ours(const XmlNode& root) { return root.attribute("xmlns:" + std::string(extension_prefix)) != nullptr; }

}  // namespace

std::string name_of(const XmlNode& node) {
  if (const std::string* const name = node.attribute("name")) return *name;
  const XmlNode* const name = node.name == "include" ? node.child("name") : nullptr;
  return name != nullptr ? name->text : "";
}

std::string step_of(const XmlNode& node) { return step_of(node.name, name_of(node)); }

bool SdfFile::is_include(const std::string& name) const {
  return std::any_of(includes.begin(), includes.end(), [&](const Include& include) { return include.name == name; });
}

LibsdformatScope::LibsdformatScope() : lock_(libsdformat_mutex()), saved_(sdf::ParserConfig::GlobalConfig()) {
  config() = sdf::ParserConfig();
  // A misspelt element or attribute would otherwise be left out with a line on the console.
  config().SetWarningsPolicy(sdf::EnforcementPolicy::ERR);
  config().SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::ERR);
  config().SetDeprecatedElementsPolicy(sdf::EnforcementPolicy::LOG);
  console().SetQuiet(true);
}

LibsdformatScope::~LibsdformatScope() {
  config() = saved_;
  console().SetQuiet(false);
}

SdfFiles::SdfFiles(InputFiles& input, const fs::path& world_file, const std::vector<fs::path>& last_model_folders,
                   std::vector<Problem>& problems, std::vector<Problem>& warnings)
    : input_(input),
      world_file_(world_file),
      world_folder_(input.absolute(world_file).parent_path()),
      search_(input, world_file, last_model_folders),
      problems_(problems),
      warnings_(warnings) {}

SdfFile& SdfFiles::open(const fs::path& path, const fs::path& shown) {
  const fs::path absolute = input_.absolute(path);
  std::unique_ptr<SdfFile>& file = files_[absolute];
  if (file) return *file;
  file = std::make_unique<SdfFile>();
  SdfFile& opened = *file;
  opened.path = absolute;
  opened.shown = shown;
  opening_.push_back(absolute);
  if (const std::string* const text = read_text(opened))
    if (auto source = read_source(*text, opened))
      if (auto tree = converted(*std::move(source), opened)) {
        opened.tree = *std::move(tree);
        if (opened.is_foreign) make_readable(opened);
        opened.size = size_of(opened.tree);
        warn_of_repeated(opened.tree, ElementSchema::root(), "");
        name_terrains(opened.tree);
        if (replace_includes(opened.tree, "", opened)) load(opened);
      }
  opening_.pop_back();
  return opened;
}

void SdfFiles::make_readable(SdfFile& file) {
  pass_over_unknown(file.tree, warnings_);
  keep_what_is_shown(file.tree);
  const auto is_of_world = [](const XmlNode& child) {
    return child.name == "include" || child.name == "light" || child.name == "actor";
  };
  // Of a file that others include as a light, nothing is met.
  if (std::ranges::none_of(file.tree.children, is_of_world) || file.tree.child("world") != nullptr ||
      file.tree.child("model") != nullptr || opening_.size() > 1)
    return;
  // Of a file with nothing else they are those of a world.
  XmlNode world = element_at(file.tree, "world");
  set_attribute(world, "name", file.shown.stem().string());
  std::ranges::copy_if(file.tree.children, std::back_inserter(world.children), is_of_world);
  std::erase_if(file.tree.children, is_of_world);
  file.tree.children.push_back(std::move(world));
}

const std::string* SdfFiles::read_text(const SdfFile& file) {
  try {
    return &input_.read(file.path);
  } catch (const std::runtime_error& error) {
    problems_.push_back({file.shown, 0, "", error.what()});
    return nullptr;
  }
}

std::optional<XmlNode> SdfFiles::read_source(const std::string& text, SdfFile& file) {
  std::optional<XmlNode> source = is_yaml(file.path) ? read_yaml(text, file) : read_xml(text, file);
  if (source) set_file(*source, &file);
  return source;
}

std::optional<XmlNode> SdfFiles::read_xml(const std::string& text, SdfFile& file) {
  const auto fail = [&](int line, std::string message) {
    problems_.push_back({file.shown, line, "", std::move(message)});
    return std::nullopt;
  };
  XmlOutline outline = outline_xml(text);
  if (outline.error) {
    XmlOutline loose = outline_loose_xml(text);
    if (!loose.error && !is_ours(loose.root)) outline = std::move(loose);
  }
  if (outline.error) return fail(outline.error->line, outline.error->message);
  const XmlNode& root = outline.root;
  if (input_.is_disk() && !input_.is_expanded(file.path))
    if (const XmlNode* const macro = find_macro(root, file.path)) return fail(macro->line, why_not_expanded(file.path));
  file.is_foreign = root.name == "robot" || !is_ours(root);
  if (root.name == "robot") {
    auto sdf = sdf_of_urdf(std::move(outline.root), file.shown, libsdformat_.config(), problems_, warnings_);
    if (sdf) mend_sdf(*sdf, file.shown, warnings_);
    return sdf;
  }

  if (root.name == "gazebo" && file.is_foreign) outline.root.name = "sdf";  // what it was called up to SDF 1.2
  const std::string* const version = root.attribute("version");
  if (root.name != "sdf" || version == nullptr)
    return fail(root.line,
                "expected <sdf version=\"" + sdf::SDF::Version() + "\"> as the root element, not <" + root.name + ">");
  // libsdformat would read a newer file as if it were of its own version.
  if (version_of(*version) > newest_version || version_of(*version) == std::pair{0, 0})
    return fail(root.line, "SDF version '" + *version + "' cannot be read, only versions up to 1.12");
  if (version_of(*version) > version_of(sdf::SDF::Version())) make_older(outline.root, file.shown, warnings_);
  if (file.is_foreign) mend_sdf(outline.root, file.shown, warnings_);
  return std::move(outline.root);
}

std::optional<XmlNode> SdfFiles::read_yaml(const std::string& text, const SdfFile& file) {
  const YamlDocument document = parse_yaml(text);
  if (document.error) {
    problems_.push_back({file.shown, document.error->line, "", document.error->message});
    return std::nullopt;
  }
  return sdf_of_yaml(*document.root, file.shown, problems_);
}

bool SdfFiles::names_are_simple(const XmlNode& node, const std::string& path) {
  bool are_simple = true;
  for (const XmlNode& child : node.children) {
    if (child.name == "plugin" || child.name.find(':') != std::string::npos) continue;
    const std::string child_path = (path.empty() ? "" : path + "/") + step_of(child);
    if (const std::string* const name = child.attribute("name");
        name != nullptr && name->find("::") != std::string::npos) {
      problems_.push_back({child.file->shown, child.line, child_path,
                           "a name cannot have '::' in it, which is between the name of a model and that of its part"});
      are_simple = false;
    }
    are_simple = names_are_simple(child, child_path) && are_simple;
  }
  return are_simple;
}

void SdfFiles::warn_of_repeated(const XmlNode& node, const ElementSchema& schema, const std::string& path) {
  for (const XmlNode& child : node.children) {
    const ElementSchema of_child = schema.child(child.name);
    if (of_child.is_free() || of_child.is_extension()) continue;
    const std::string child_path = (path.empty() ? "" : path + "/") + step_of(child);
    if (of_child.is_single() && node.child(child.name) != &child)
      warnings_.push_back({child.file->shown, child.line, child_path, "is given twice; only the first counts"});
    warn_of_repeated(child, of_child, child_path);
  }
}

void SdfFiles::load(SdfFile& file) {
  std::vector<Problem> found = try_to_load(file);
  if (!file.loaded) {
    if (std::vector<Problem> values = replace_bad_values(file.tree, file); !values.empty()) {
      found = try_to_load(file);
      found.insert(found.begin(), values.begin(), values.end());
    }
  }
  if (!file.loaded && found.empty() && problems_.empty())
    found.push_back({file.shown, 0, "", "libsdformat cannot read this file"});
  file.sound = file.loaded && found.empty() && file.complete;
  problems_.insert(problems_.end(), found.begin(), found.end());
}

std::vector<Problem> SdfFiles::try_to_load(SdfFile& file) {
  XmlText written = xml_text_of(file.tree);
  file.nodes = std::move(written.nodes);
  sdf::Errors errors;
  const auto failure = libsdformat_failure([&] {
    std::set<std::string> names;
    add_names(file.tree, names);
    if (names != last_definition_.first || !last_definition_.second)
      last_definition_ = {names, sdf_definition_for(names)};
    const sdf::SDFPtr sdf = empty_sdf(last_definition_.second);
    sdf->SetFilePath(file.path.string());
    sdf->Root()->SetOriginalVersion(file.version);  // what an old version allowed stays allowed
    // Into an element: what reads into an SDFPtr tries anything that is not SDF as URDF, whose parser prints on its
    // own.
    file.loaded = sdf::readString(written.text, libsdformat_.config(), sdf->Root(), errors);
    if (file.loaded) {
      const sdf::Errors more = file.root.Load(sdf, libsdformat_.config());
      if (file.complete) errors.insert(errors.end(), more.begin(), more.end());  // otherwise they follow from that
    }
  });
  if (failure) {
    file.loaded = false;
    return {{file.shown, 0, "", "libsdformat cannot read this file: " + *failure}};
  }
  return problems_of(errors, file, file.tree);
}

const SdfFile* SdfFiles::find(const std::string& path) const {
  const auto found = files_.find(fs::path(path).lexically_normal());
  return found == files_.end() ? nullptr : found->second.get();
}

fs::path SdfFiles::find_file(const sdf::ElementPtr& element) const {
  const XmlNode* const node = node_of(element);
  return search_.find_file(element->Get<std::string>(),
                           node != nullptr ? node->file->path.parent_path() : world_folder_);
}

Location SdfFiles::locate(const sdf::ElementPtr& element) const {
  Location location;
  const XmlNode* const node = node_of(element);
  location.file = node != nullptr ? node->file->shown : world_file_;
  location.line = node != nullptr ? node->line : 0;
  for (sdf::ElementPtr step = element; step && step->GetName() != "sdf"; step = step->GetParent())
    location.element = step_of(step) + (location.element.empty() ? "" : "/") + location.element;
  if (const SdfFile* const part = find(element->FilePath())) location.element.insert(0, part->within);
  return location;
}

bool SdfFiles::is_foreign(const sdf::ElementPtr& element) const {
  const XmlNode* const node = node_of(element);
  return node != nullptr && node->file->is_foreign;
}

const XmlNode* SdfFiles::node_of(const sdf::ElementPtr& element) const {
  // libsdformat knows the lines of its own elements only. From the innermost of those, the way down is walked again.
  std::vector<sdf::ElementPtr> way{element};
  while (!way.back()->LineNumber() && way.back()->GetParent()) way.push_back(way.back()->GetParent());
  const SdfFile* const file = find(element->FilePath());
  if (file == nullptr) return nullptr;
  const XmlNode* node = file->node_at(way.back()->LineNumber().value_or(0));
  for (auto step = std::next(way.rbegin()); step != way.rend() && node != nullptr; ++step)
    if (const XmlNode* const child = nth_child(*node, (*step)->GetName(), place_among_siblings(*step)))
      node = child;
    else
      break;
  return node;
}

}  // namespace cohort::parsing
