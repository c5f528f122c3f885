// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/sdf_files.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "server/parsing/sdf/check_tree.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

namespace fs = std::filesystem;

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
      reader_(input, problems, warnings) {}

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
  const std::size_t before = problems_.size();
  std::ranges::move(check_tree(file.tree), std::back_inserter(problems_));
  file.elements = std::make_unique<ElementTree>(file.tree);
  if (const Element* const world = file.first("world")) file.frames = std::make_unique<Frames>(*world);
  if (const Element* const model = file.model()) file.model_frames = std::make_unique<Frames>(*model);
  for (const Frames* const frames : {file.frames.get(), file.model_frames.get()}) {
    if (frames == nullptr || !file.complete) continue;  // missing names follow from missing includes
    for (auto& [element, message] : frames->flaws()) {
      if (problems_.size() - before >= most_problems) break;
      Location where = locate(element);
      problems_.push_back({std::move(where.file), where.line, std::move(where.element), std::move(message)});
    }
  }
  file.sound = file.complete && problems_.size() == before;
}

fs::path SdfFiles::find_file(const Element* element) const try {
  return search_.find_file(element->text(), element->node().file->path.parent_path());
} catch (const std::runtime_error&) {
  input_.note_missing();
  throw;
}

Location SdfFiles::locate(const Element* element) {
  const XmlNode& node = element->node();
  Location location{node.file->shown, node.line, ""};
  for (const Element* step = element; step != nullptr; step = step->parent()) {
    const XmlNode& source = step->node();
    const std::string own = !source.written.empty() ? source.written : source.name != "sdf" ? step_of(source) : "";
    if (own.empty()) continue;
    location.element = own + (location.element.empty() ? "" : "/") + location.element;
    // A name that differs from the one in the file is replaced by the path there, from the model or the world on.
    if (!source.written.empty() && source.name != "sdf") step = step->parent();
    if (step == nullptr) break;
  }
  return location;
}

}  // namespace cohort::parsing
