#include "server/parsing/sdf/sdf_files.hpp"

#include <memory>
#include <stdexcept>
#include <utility>

#include "server/parsing/sdf/load_elements.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

namespace fs = std::filesystem;

std::string step_of(const sdf::ElementPtr& element) {
  const bool has_name = element->GetAttributeSet("name");
  return path_step(element->GetName(), has_name ? element->GetAttribute("name")->GetAsString() : "");
}

std::size_t size_of(const XmlNode& node) {
  std::size_t size = 1;
  for (const XmlNode& child : node.children) size += size_of(child);
  return size;
}

}  // namespace

SdfFiles::SdfFiles(InputFiles& input, const fs::path& world_file, const std::vector<fs::path>& last_model_folders,
                   std::vector<Problem>& problems, std::vector<Problem>& warnings)
    : input_(input),
      world_file_(world_file),
      world_folder_(input.absolute(world_file).parent_path()),
      search_(input, world_file, last_model_folders),
      problems_(problems),
      warnings_(warnings),
      reader_(input, libsdformat_.config(), problems, warnings) {}

SdfFile& SdfFiles::open(const fs::path& path, const fs::path& shown) {
  const fs::path absolute = input_.absolute(path);
  std::unique_ptr<SdfFile>& file = files_[absolute];
  if (file) return *file;
  file = std::make_unique<SdfFile>();
  SdfFile& opened = *file;
  opened.path = absolute;
  opened.shown = shown;
  opening_.push_back(absolute);
  if (reader_.read(opened, opening_.size() > 1)) {
    opened.size = size_of(opened.tree);
    if (replace_includes(opened.tree, "", opened)) load(opened);
  }
  opening_.pop_back();
  return opened;
}

void SdfFiles::load(SdfFile& file) {
  const std::vector<Problem> found = load_elements(file, builder_, libsdformat_.config());
  if (!file.loaded && found.empty() && problems_.empty())
    problems_.push_back({file.shown, 0, "", "libsdformat cannot read this file"});
  problems_.insert(problems_.end(), found.begin(), found.end());
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
  for (sdf::ElementPtr step = element; step && step->GetName() != "sdf"; step = step->GetParent()) {
    const XmlNode* const source = step->LineNumber() ? node_of(step) : nullptr;
    const bool is_moved = source != nullptr && !source->written.empty();
    location.element =
        (is_moved ? source->written : step_of(step)) + (location.element.empty() ? "" : "/") + location.element;
    if (is_moved) step = step->GetParent();  // the link, which `written` includes
  }
  if (const SdfFile* const part = find(element->FilePath())) location.element.insert(0, part->within);
  return location;
}

bool SdfFiles::is_foreign(const sdf::ElementPtr& element) const {
  const XmlNode* const node = node_of(element);
  return node != nullptr && node->file->is_foreign;
}

const XmlNode* SdfFiles::node_of(const sdf::ElementPtr& element) const {
  const SdfFile* const file = find(element->FilePath());
  if (file == nullptr) return nullptr;
  // Elements that libsdformat has added for default values have no line.
  sdf::ElementPtr written = element;
  while (!written->LineNumber() && written->GetParent()) written = written->GetParent();
  return file->node_at(written->LineNumber().value_or(0));
}

}  // namespace cohort::parsing
