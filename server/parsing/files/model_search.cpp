#include "server/parsing/files/model_search.hpp"

#include <algorithm>
#include <sdf/SDFImpl.hh>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "server/parsing/files/sdf_version.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view model_scheme = "model://";
constexpr std::string_view package_scheme = "package://";
constexpr std::string_view file_scheme = "file://";
constexpr int parent_levels = 4;

// The file that a model.config names: of several, the one of the newest version that libsdformat reads; of those that
// say no version, the first.
std::string best_file(const XmlNode& model) {
  const std::pair<int, int> own = version_of(sdf::SDF::Version());
  std::pair<int, int> best{-1, 0};
  std::string file;
  for (const XmlNode& sdf : model.children) {
    if (sdf.name != "sdf" || sdf.text.empty()) continue;
    const std::string* const written = sdf.attribute("version");
    const std::pair<int, int> version = version_of(written != nullptr ? *written : "");
    if (version > own || version <= best) continue;
    best = version;
    file = sdf.text;
  }
  return file;
}

}  // namespace

ModelSearch::ModelSearch(InputFiles& input, const fs::path& world_file, const std::vector<fs::path>& last_folders)
    : input_(input), world_folder_(input.absolute(world_file).parent_path()) {
  std::istringstream stream(input.model_path());
  for (std::string folder; std::getline(stream, folder, ':');)
    if (!folder.empty()) folders_.push_back(input.absolute(folder));
  fs::path folder = world_folder_;
  for (int level = 0; level <= parent_levels; ++level) {
    folders_.push_back(folder / "robots");
    folders_.push_back(folder / "objects");
    if (folder == folder.parent_path()) break;
    folder = folder.parent_path();
  }
  for (const fs::path& last : last_folders)
    if (std::find(folders_.begin(), folders_.end(), last) == folders_.end()) folders_.push_back(last);
}

fs::path ModelSearch::sdf_file_of(const fs::path& folder) const {
  const fs::path config = folder / "model.config";
  if (!input_.is_file(config))
    throw std::runtime_error("the model's folder '" + folder.string() + "' has no model.config");
  const XmlOutline outline = outline_xml(input_.read(config));
  if (outline.error)
    throw std::runtime_error(config.string() + ":" + std::to_string(outline.error->line) + ": " +
                             outline.error->message);
  const XmlNode* const name = outline.root.child("name");
  const XmlNode* const sdf = outline.root.child("sdf");
  if (outline.root.name != "model" || name == nullptr || name->text.empty() || sdf == nullptr || sdf->text.empty())
    throw std::runtime_error(config.string() + " needs <model> with <name> and <sdf version=\"1.9\">FILE</sdf>");
  const std::string file = best_file(outline.root);
  if (file.empty()) throw std::runtime_error(config.string() + " names no SDF file of a version that is read");
  if (!input_.is_file(folder / file))
    throw std::runtime_error("there is no '" + (folder / file).string() + "', which " + config.string() + " names");
  return folder / file;
}

fs::path ModelSearch::find_folder(const std::string& name) const {
  std::string searched;
  for (const fs::path& folder : folders_) {
    if (!name.empty() && input_.is_folder(folder / name)) return folder / name;
    if (input_.is_folder(folder)) searched += (searched.empty() ? "" : ", ") + folder.string();
  }
  if (searched.empty())
    throw std::runtime_error("there is no model '" + name +
                             "': no folder 'robots' or 'objects' is beside the world file or up to " +
                             std::to_string(parent_levels) + " levels above it, and COHORT_MODEL_PATH names none");
  throw std::runtime_error("there is no model '" + name + "' in " + searched + "; COHORT_MODEL_PATH may name more");
}

fs::path ModelSearch::path_of(const std::string& uri, const fs::path& folder) const {
  fs::path path;
  if (uri.starts_with(model_scheme) || uri.starts_with(package_scheme)) {
    const std::string inside = uri.substr(uri.find("://") + 3);
    const std::size_t slash = std::min(inside.find('/'), inside.size());
    path = find_folder(inside.substr(0, slash)) / fs::path(inside.substr(slash)).relative_path();
  } else if (uri.starts_with(file_scheme)) {
    path = uri.substr(file_scheme.size());
  } else if (uri.find("://") != std::string::npos) {
    throw std::runtime_error("'" + uri + "' cannot be fetched: expected model://NAME or a path");
  } else {
    path = folder / uri;
  }
  path = path.lexically_normal();
  return path.has_filename() ? path : path.parent_path();  // it ended in a slash
}

FoundModel ModelSearch::find(const std::string& uri, const fs::path& folder) const {
  const fs::path path = path_of(uri, folder);
  if (input_.is_folder(path)) return {sdf_file_of(path)};
  if (input_.is_file(path)) return {path};
  throw std::runtime_error("there is no '" + path.string() + "'");
}

fs::path ModelSearch::find_file(const std::string& uri, const fs::path& folder) const {
  fs::path path = path_of(uri, folder);
  if (const auto reason = input_.why_unreadable(path)) throw std::runtime_error(*reason + ": '" + path.string() + "'");
  return path;
}

}  // namespace cohort::parsing
