#include "server/description/sdf_files.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <sdf/Console.hh>
#include <sdf/SDFImpl.hh>
#include <sdf/parser.hh>
#include <stdexcept>
#include <utility>

#include "server/description/file_kind.hpp"
#include "server/description/input_file.hpp"
#include "server/description/sdf_errors.hpp"
#include "server/description/text.hpp"
#include "server/description/yaml_sdf.hpp"

namespace cohort::description {
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

// "1.9" as {1, 9}; {0, 0} if it is nothing like that.
std::pair<int, int> version_of(std::string_view text) {
  std::pair<int, int> version{0, 0};
  const char* const end = text.data() + text.size();
  const auto [dot, error] = std::from_chars(text.data(), end, version.first);
  if (error == std::errc{} && dot != end && *dot == '.') std::from_chars(dot + 1, end, version.second);
  return version;
}

// The first element of this name on this line.
const XmlNode* find_on_line(const XmlNode& node, std::string_view name, int line) {
  if (node.line == line && node.name == name) return &node;
  for (const XmlNode& child : node.children)
    if (const XmlNode* const found = find_on_line(child, name, line)) return found;
  return nullptr;
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

const XmlNode* nth_child(const XmlNode& node, std::string_view name, std::size_t n) {
  for (const XmlNode& child : node.children)
    if (child.name == name && n-- == 0) return &child;
  return nullptr;
}

// What libsdformat would stumble over in an <include>: it copies the children without a look at what it is given, and
// an attribute that it does not know, or a value that is not there, ends the process. The child and what is wrong with
// it.
std::optional<std::pair<const XmlNode*, std::string>> flaw_of_include(const XmlNode& include) {
  const std::map<std::string, std::vector<std::string>> attributes_of = {
      {"uri", {}},
      {"name", {}},
      {"static", {}},
      {"placement_frame", {}},
      {"pose", {"relative_to", "degrees", "rotation_format"}},
      {"plugin", {"name", "filename"}}};
  std::vector<std::string> names;
  names.reserve(attributes_of.size());
  for (const auto& [name, attributes] : attributes_of) names.push_back(name);
  for (const XmlNode& child : include.children) {
    if (child.name == "experimental:params") return std::pair{&child, "parameters of an include are not supported"};
    if (child.name.find(':') != std::string::npos) continue;
    const auto known = attributes_of.find(child.name);
    if (known == attributes_of.end()) return std::pair{&child, "unknown element" + suggestion(child.name, names)};
    for (const auto& [attribute, value] : child.attributes)
      if (std::find(known->second.begin(), known->second.end(), attribute) == known->second.end())
        return std::pair{&child, "unknown attribute '" + attribute + "'" + suggestion(attribute, known->second)};
    if (child.name == "plugin" && !child.text.empty()) return std::pair{&child, "unexpected text"};
    if (child.name != "plugin" && child.name != "pose" && child.text.empty())
      return std::pair{&child, "expected a value"};
  }
  return std::nullopt;
}

}  // namespace

std::string name_of(const XmlNode& node) {
  if (const std::string* const name = node.attribute("name")) return *name;
  const XmlNode* const name = node.name == "include" ? node.child("name") : nullptr;
  return name != nullptr ? name->text : "";
}

std::string step_of(const XmlNode& node) { return step_of(node.name, name_of(node)); }

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

SdfFiles::SdfFiles(const fs::path& world_file, const std::vector<fs::path>& last_model_folders,
                   std::vector<Problem>& problems)
    : world_file_(world_file), search_(world_file, last_model_folders), problems_(problems) {}

SdfFile& SdfFiles::open(const fs::path& path, const fs::path& shown) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  std::unique_ptr<SdfFile>& file = files_[absolute];
  if (file) return *file;
  file = std::make_unique<SdfFile>();
  file->path = absolute;
  file->shown = shown;
  opening_.push_back(absolute);
  if (auto text = read_text(*file)) {
    const auto sdf = is_yaml(absolute) ? read_yaml(*text, *file) : read_outline(*std::move(text), *file);
    if (sdf && follow_includes(file->xml, "", *file)) load(*sdf, *file);
  }
  opening_.pop_back();
  return *file;
}

std::optional<std::string> SdfFiles::read_text(const SdfFile& file) {
  auto failure = why_unreadable(file.path);
  if (!failure) {
    std::ifstream stream(file.path);
    std::string text(std::istreambuf_iterator<char>(stream), {});
    if (stream) return text;
    failure = "the file cannot be read";
  }
  problems_.push_back({file.shown, 0, "", std::move(*failure)});
  return std::nullopt;
}

std::optional<std::string> SdfFiles::read_outline(std::string text, SdfFile& file) {
  const auto fail = [&](int line, std::string message) {
    problems_.push_back({file.shown, line, "", std::move(message)});
    return std::nullopt;
  };
  XmlOutline outline = outline_xml(text);
  if (outline.error) return fail(outline.error->line, outline.error->message);
  file.xml = std::move(outline.root);

  const std::string* const version = file.xml.attribute("version");
  if (file.xml.name != "sdf" || version == nullptr)
    return fail(file.xml.line, "expected <sdf version=\"" + sdf::SDF::Version() + "\"> as the root element, not <" +
                                   file.xml.name + ">");
  // libsdformat would read a newer file as if it were of its own version.
  if (version_of(*version) > version_of(sdf::SDF::Version()) || version_of(*version) == std::pair{0, 0})
    return fail(file.xml.line,
                "SDF version '" + *version + "' cannot be read, only versions up to " + sdf::SDF::Version());
  return text;
}

std::optional<std::string> SdfFiles::read_yaml(const std::string& text, SdfFile& file) {
  const YamlDocument document = parse_yaml(text);
  if (document.error) {
    problems_.push_back({file.shown, document.error->line, "", document.error->message});
    return std::nullopt;
  }
  file.xml = sdf_of_yaml(*document.root, file.shown, problems_);
  auto [sdf, lines] = xml_text_of(file.xml);
  file.source_lines = std::move(lines);
  return std::move(sdf);
}

bool SdfFiles::follow_includes(const XmlNode& node, const std::string& path, SdfFile& file) {
  bool usable = true;
  for (const XmlNode& child : node.children) {
    const std::string child_path = (path.empty() ? "" : path + "/") + step_of(child);
    if (child.name == "include")
      usable = follow_include(child, child_path, node.name == "world", file) && usable;
    else if (child.name == "world" || child.name == "model")
      usable = follow_includes(child, child_path, file) && usable;
  }
  return usable;
}

bool SdfFiles::follow_include(const XmlNode& include, const std::string& path, bool in_world, SdfFile& file) {
  const auto problem = [&](const XmlNode& where, std::string message) {
    problems_.push_back({file.shown, file.source_line(where.line), &where == &include ? path : path + "/" + where.name,
                         std::move(message)});
  };
  const auto flaw = flaw_of_include(include);
  if (flaw) {
    problem(*flaw->first, flaw->second);
    return false;
  }
  const XmlNode* const uri = include.child("uri");
  if (uri == nullptr) {
    problem(include, "expected <uri>model://NAME</uri>");
    return false;
  }
  FoundModel found;
  try {
    found = search_.find(uri->text);
  } catch (const std::runtime_error& error) {
    problem(*uri, error.what());
    return true;  // libsdformat leaves it out
  }
  if (std::find(opening_.begin(), opening_.end(), found.file) != opening_.end()) {
    problem(*uri, "'" + found.file.string() + "' includes itself");
    return false;
  }
  const SdfFile& included = open(found.file, found.file);
  if (!included.sound) return true;
  // libsdformat asks this map first. It would ask the working directory before its find callback, and the result would
  // depend on where the program was started.
  libsdformat_.config().AddURIPath(found.folder_uri, found.folder.string());
  if (in_world) file.includes.push_back({file.source_line(include.line), uri->text, &included});
  return true;
}

void SdfFiles::load(const std::string& text, SdfFile& file) {
  sdf::Errors errors;
  try {
    const sdf::SDFPtr sdf = std::make_shared<sdf::SDF>();
    sdf::init(sdf);
    sdf->SetFilePath(file.path.string());
    // Into an element: what reads into an SDFPtr tries anything that is not SDF as URDF, whose parser prints on its
    // own.
    file.loaded = sdf::readString(text, libsdformat_.config(), sdf->Root(), errors);
    if (file.loaded) {
      const sdf::Errors more = file.root.Load(sdf, libsdformat_.config());
      errors.insert(errors.end(), more.begin(), more.end());
    }
  } catch (const std::exception& error) {
    file.loaded = false;
    problems_.push_back({file.shown, 0, "", std::string("libsdformat cannot read this file: ") + error.what()});
    return;
  }
  std::vector<Problem> found = problems_of(errors, file);
  if (!file.loaded && found.empty() && problems_.empty())
    found.push_back({file.shown, 0, "", "libsdformat cannot read this file"});
  // Left out by libsdformat, because we have reported it already.
  const bool includes_missing = std::any_of(
      errors.begin(), errors.end(), [](const sdf::Error& error) { return error.Code() == sdf::ErrorCode::URI_LOOKUP; });
  file.sound = file.loaded && found.empty() && !includes_missing;
  problems_.insert(problems_.end(), found.begin(), found.end());
}

const SdfFile* SdfFiles::find(const std::string& path) const {
  const auto found = files_.find(fs::path(path).lexically_normal());
  return found == files_.end() ? nullptr : found->second.get();
}

fs::path SdfFiles::find_file(const sdf::ElementPtr& element) const {
  return search_.find_file(element->Get<std::string>(), fs::path(element->FilePath()).parent_path());
}

Location SdfFiles::locate(const sdf::ElementPtr& element) const {
  Location location;
  const SdfFile* const file = find(element->FilePath());
  location.file = file != nullptr ? file->shown : fs::path(element->FilePath());
  location.line = line_of(element);
  if (file != nullptr) location.line = file->source_line(location.line);
  for (sdf::ElementPtr step = element; step && step->GetName() != "sdf"; step = step->GetParent())
    location.element = step_of(step) + (location.element.empty() ? "" : "/") + location.element;
  return location;
}

int SdfFiles::line_of(const sdf::ElementPtr& element) const {
  // libsdformat knows the lines of its own elements only. From the innermost of those, the way down is walked again in
  // the outline of the file.
  std::vector<sdf::ElementPtr> way{element};
  while (!way.back()->LineNumber() && way.back()->GetParent()) way.push_back(way.back()->GetParent());
  const sdf::ElementPtr known = way.back();
  const int known_line = known->LineNumber().value_or(0);
  const SdfFile* const file = find(element->FilePath());
  if (known == element || file == nullptr) return known_line;

  const XmlNode* node = nullptr;
  if (known->FilePath() == element->FilePath())
    node = find_on_line(file->xml, known->GetName(), known_line);
  else  // merged from a model of another file
    node = file->xml.child("model");
  int line = node != nullptr ? node->line : known_line;
  for (auto step = std::next(way.rbegin()); step != way.rend() && node != nullptr; ++step) {
    node = nth_child(*node, (*step)->GetName(), place_among_siblings(*step));
    if (node != nullptr) line = node->line;
  }
  return line;
}

}  // namespace cohort::description
