// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/model_search.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/files/sdf_version.hpp"
#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view model_scheme = "model://";
constexpr std::string_view misspelt_scheme = "models://";  // other programs accept it, too
constexpr std::string_view package_scheme = "package://";
constexpr std::string_view file_scheme = "file://";
constexpr int parent_levels = 4;

// Returns the file that a model.config names. Among several, it is the one of the newest version to which files are
// converted, or else the oldest newer one; without versions, the first.
std::string best_file(const XmlNode& model) {
  const std::pair<int, int> own = version_of(converted_version);
  std::pair<int, int> best{-1, 0};
  std::string file;
  for (const XmlNode& sdf : model.children) {
    if (sdf.name != "sdf" || sdf.text.empty()) continue;
    const std::string* const written = sdf.attribute("version");
    const std::pair<int, int> version = version_of(written != nullptr ? *written : "");
    const bool is_newer = version > own;
    if (version > newest_version || (is_newer ? best.first >= 0 && best <= version : best <= own && version <= best))
      continue;
    best = version;
    file = sdf.text;
  }
  return file;
}

// Returns nothing for a file that cannot be read.
std::string name_of_package(const InputFiles& input, const fs::path& file) {
  if (input.why_unreadable(file)) return "";
  const XmlOutline outline = outline_xml(input.content(file));
  const XmlNode* const name = outline.root.child("name");
  return name != nullptr ? name->text : "";
}

std::string in_small_letters(std::string text) {
  for (char& each : text)
    if (each >= 'A' && each <= 'Z') each = static_cast<char>(each - 'A' + 'a');
  return text;
}

}  // namespace

ModelSearch::ModelSearch(InputFiles& input, const fs::path& world_file, const std::vector<fs::path>& last_folders)
    : input_(input), world_folder_(input.absolute(world_file).parent_path()) {
  std::istringstream stream(input.model_path());
  bool is_ours = true;
  for (std::string folder; std::getline(stream, folder, ':');) {
    is_ours = is_ours && !folder.empty();
    if (!folder.empty()) (is_ours ? folders_ : others_).push_back(input.absolute(folder));
  }
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
  const std::string& text = input_.read(config);
  XmlOutline outline = outline_xml(text);
  if (outline.error) outline = outline_loose_xml(text);
  if (outline.error)
    throw std::runtime_error(config.string() + ":" + std::to_string(outline.error->line) + ": " +
                             outline.error->message);
  const XmlNode* const sdf = outline.root.child("sdf");
  if (outline.root.name != "model" || sdf == nullptr || sdf->text.empty())
    throw std::runtime_error(config.string() + " must contain <model> with <sdf version=\"1.9\">FILE</sdf>");
  const std::string file = best_file(outline.root);
  if (file.empty()) throw std::runtime_error(config.string() + " does not list an SDF file of a supported version");
  if (!input_.is_file(folder / file))
    throw std::runtime_error("there is no '" + (folder / file).string() + "', the file that " + config.string() +
                             " lists");
  return folder / file;
}

// Returns the first folder of this name that contains `inside`, or else the first one.
std::optional<fs::path> ModelSearch::look_for(const std::string& name, const fs::path& folder,
                                              const fs::path& inside) const {
  if (name.empty()) return std::nullopt;
  std::optional<fs::path> first;
  const auto has_it = [&](const fs::path& place) {
    if (!first) first = place;
    return inside.empty() || input_.is_file(place / inside) || input_.is_folder(place / inside);
  };
  for (const auto* const folders : {&folders_, &others_})
    for (const fs::path& each : *folders) {
      if (input_.is_folder(each / name) && has_it(each / name)) return each / name;
      if (each.filename() == name && input_.is_folder(each) && has_it(each)) return each;
    }
  for (fs::path above = folder; above != above.parent_path(); above = above.parent_path())
    if (auto place = look_in(above, name, inside, has_it)) return place;
  if (auto package = find_package(name); package && has_it(*package)) return package;
  return first;
}

// Looks for the folder of a model or package in one above the file: itself, or one in it.
std::optional<fs::path> ModelSearch::look_in(const fs::path& above, const std::string& name, const fs::path& inside,
                                             const std::function<bool(const fs::path&)>& has_it) const {
  if ((above.filename() == name || is_package(above, name)) && has_it(above)) return above;
  for (const fs::path& place : {above / name, above / "models" / name})
    if (is_signed(place) ? has_it(place) : !inside.empty() && input_.is_file(place / inside)) return place;
  return std::nullopt;
}

std::string ModelSearch::searched_folders() const {
  std::string searched;
  for (const auto* const folders : {&folders_, &others_})
    for (const fs::path& each : *folders)
      if (input_.is_folder(each)) searched += (searched.empty() ? "" : ", ") + each.string();
  return searched;
}

std::vector<std::string> ModelSearch::known_models() const {
  std::vector<std::string> names;
  if (!input_.is_disk()) return names;
  for (const auto* const folders : {&folders_, &others_})
    for (const fs::path& folder : *folders) {
      std::error_code is_over;
      for (fs::directory_iterator each(folder, is_over); !is_over && each != fs::directory_iterator();
           each.increment(is_over))
        if (input_.is_file(each->path() / "model.config")) names.push_back(each->path().filename().string());
    }
  std::ranges::sort(names);
  return names;
}

void ModelSearch::fail_to_find_file(const std::string& file, const fs::path& folder) const {
  const std::string name = file.substr(0, file.find('/'));
  const std::string searched = searched_folders();
  throw std::runtime_error("there is no '" + file + "' in " + folder.string() + " or its parent folders" +
                           (searched.empty() ? "" : ", nor in " + searched) +
                           ", and no package.xml there declares the package '" + name +
                           "'; use --allow-files DIR if DIR contains '" + name + "'");
}

void ModelSearch::fail_to_find(const std::string& name) const {
  const std::string searched = searched_folders();
  if (searched.empty())
    throw std::runtime_error("there is no model '" + name +
                             "': there is no folder 'robots' or 'objects' beside the world file or up to " +
                             std::to_string(parent_levels) + " levels above it, and COHORT_MODEL_PATH lists none");
  const auto near = nearest(name, known_models());
  throw std::runtime_error(
      "there is no model '" + name + "' in " + searched +
      (near ? "; did you mean '" + *near + "'?" : std::string("; set COHORT_MODEL_PATH to search more folders")));
}

// Returns whether a folder is marked as a model or a package.
bool ModelSearch::is_signed(const fs::path& folder) const {
  constexpr const char* signs[] = {"model.config", "package.xml"};
  if (!input_.is_folder(folder)) return false;
  const auto* const sign = std::ranges::find_if(signs, [&](const char* each) { return input_.is_file(folder / each); });
  if (sign == std::end(signs)) return false;
  if (!input_.why_unreadable(folder / *sign)) input_.read(folder / *sign);  // so that it is kept
  return true;
}

// Finds a path without its package, like PyBullet.
std::optional<fs::path> ModelSearch::find_file_above(const std::string& path, fs::path folder) const {
  for (; folder != folder.parent_path(); folder = folder.parent_path())
    if (input_.is_file(folder / path)) return folder / path;
  return std::nullopt;
}

bool ModelSearch::is_package(const fs::path& folder, const std::string& name) const {
  const fs::path package = folder / "package.xml";
  if (!input_.is_file(package) || name_of_package(input_, package) != name) return false;
  input_.read(package);  // so that it is kept
  return true;
}

std::optional<fs::path> ModelSearch::find_package(const std::string& name) const {
  if (!packages_) {
    packages_.emplace();
    for (const fs::path& folder : others_)
      for (const fs::path& package : input_.files_below(folder, "package.xml"))
        packages_->emplace(name_of_package(input_, package), package.parent_path());
  }
  const auto found = packages_->find(name);
  if (found == packages_->end()) return std::nullopt;
  input_.read(found->second / "package.xml");  // so that it is kept
  return found->second;
}

// Finds `https://fuel.gazebosim.org/1.0/OWNER/models/NAME/VERSION/files/PATH` as SERVER/OWNER/models/NAME/VERSION/PATH
// in the cache, in lower case; without a version, or with `tip`, it is the newest.
fs::path ModelSearch::find_fetched(const std::string& uri) const {
  std::string address = uri.substr(uri.find("://") + 3);
  for (std::size_t at = address.find("%20"); at != std::string::npos; at = address.find("%20", at))
    address.replace(at, 3, " ");
  std::vector<std::string> parts;
  std::istringstream stream(address);
  for (std::string part; std::getline(stream, part, '/');)
    if (!part.empty() && part != "1.0" && part != "files") parts.push_back(part);
  constexpr std::size_t least_parts = 4;
  const bool is_model = parts.size() >= least_parts && parts[2] == "models";
  for (const fs::path& cache : others_) {
    if (!is_model) break;
    const fs::path model = cache / parts[0] / in_small_letters(parts[1]) / parts[2] / in_small_letters(parts[3]);
    if (!input_.is_folder(model)) continue;
    auto rest = parts.begin() + least_parts;
    const auto is_number = [](const std::string& part) { return parse_whole(part).has_value(); };
    const bool says_version = rest != parts.end() && (is_number(*rest) || *rest == "tip");
    fs::path found = model / (says_version && is_number(*rest) ? *rest : newest_version(model));
    if (says_version) ++rest;
    for (; rest != parts.end(); ++rest) found /= *rest;
    return found;
  }
  throw std::runtime_error(
      "Cohort does not download '" + uri + "'; expected model://NAME or a path" +
      (is_model ? ". After `gz fuel download -u \"" + uri + "\"`, Cohort finds the model in ~/.gz/fuel" : ""));
}

std::string ModelSearch::newest_version(const fs::path& model) const {
  constexpr int most_versions = 999;
  for (int version = most_versions; version > 0; --version)
    if (input_.is_folder(model / std::to_string(version))) return std::to_string(version);
  return "1";
}

fs::path ModelSearch::path_of(const std::string& uri, const fs::path& folder, bool is_model) const {
  fs::path path;
  if (uri.starts_with(model_scheme) || uri.starts_with(misspelt_scheme) || uri.starts_with(package_scheme)) {
    const std::string inside = fs::path(uri.substr(uri.find("://") + 3)).relative_path();  // also of package:///NAME
    const std::size_t slash = std::min(inside.find('/'), inside.size());
    const std::string name = inside.substr(0, slash);
    const fs::path rest = fs::path(inside.substr(slash)).relative_path();
    if (const auto found = look_for(name, folder, rest))
      path = *found / rest;
    else if (const auto beside = find_file_above(inside, folder))
      path = *beside;
    else
      is_model ? fail_to_find(name) : fail_to_find_file(inside, folder);
  } else if (!uri.starts_with(file_scheme) && uri.find("://") != std::string::npos) {
    path = find_fetched(uri);
  } else {
    const std::string written = uri.starts_with(file_scheme) ? uri.substr(file_scheme.size()) : uri;
    path = folder / written;
    const std::size_t slash = std::min(written.find('/'), written.size());
    if (written.find_first_not_of('.') < slash && !input_.is_file(path) && !input_.is_folder(path))
      if (const fs::path rest = fs::path(written.substr(slash)).relative_path();
          const auto found = look_for(written.substr(0, slash), folder, rest))
        path = *found / rest;
  }
  path = path.lexically_normal();
  return path.has_filename() ? path : path.parent_path();  // it ended in a slash
}

FoundModel ModelSearch::find(const std::string& uri, const fs::path& folder) const {
  const fs::path path = path_of(uri, folder, true);
  if (!input_.is_folder(path) && !input_.is_file(path)) throw std::runtime_error("there is no '" + path.string() + "'");
  const fs::path file = input_.is_folder(path) ? sdf_file_of(path) : path;
  if (const auto reason = input_.why_unreadable(file)) throw std::runtime_error(*reason + ": '" + file.string() + "'");
  return {file};
}

fs::path ModelSearch::find_file(const std::string& uri, const fs::path& folder) const {
  fs::path path = path_of(uri, folder, false);
  if (const auto reason = input_.why_unreadable(path)) throw std::runtime_error(*reason + ": '" + path.string() + "'");
  return path;
}

}  // namespace cohort::parsing
