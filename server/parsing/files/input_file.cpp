// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/input_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "server/core/bounded_file.hpp"

namespace cohort::parsing {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_bytes_of_file = std::size_t{1} << 30U;
constexpr const char* is_a_folder = "this is a folder; expected a file";

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

// Returns the folders of Cohort, an empty entry, and the folders of other programs.
std::string folders_of_environment() {
  std::string path = variable("COHORT_MODEL_PATH");
  for (std::size_t at = path.find("::"); at != std::string::npos; at = path.find("::")) path.erase(at, 1);
  while (path.ends_with(':')) path.pop_back();
  std::string others;
  const auto add = [&](const std::string& folders, const std::string& inside) {
    std::istringstream stream(folders);
    for (std::string folder; std::getline(stream, folder, ':');)
      if (!folder.empty()) others += ":" + folder + inside;
  };
  for (const char* const name :
       {"GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH", "GAZEBO_MODEL_PATH", "ROS_PACKAGE_PATH"})
    add(variable(name), "");
  add(variable("AMENT_PREFIX_PATH"), "/share");
  add(variable("COHORT_ALLOW_FILES"), "");
  const std::string home = variable("HOME");
  for (const char* const cache : {"/.gz/fuel", "/.ignition/fuel"})
    if (std::error_code none; !home.empty() && fs::is_directory(home + cache, none)) add(home + cache, "");
  return others.empty() ? path : path + ":" + others;
}

}  // namespace

std::optional<std::string> why_unreadable(const fs::path& file) {
  const auto because = [](const std::error_code& error) { return "the file cannot be read: " + error.message(); };
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) return "there is no such file";
  if (error) return because(error);
  if (fs::is_directory(status)) return is_a_folder;
  if (!fs::is_regular_file(status)) return "this is not a regular file";
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return because({errno, std::generic_category()});
  close(descriptor);
  return std::nullopt;
}

fs::path without_links(const fs::path& file) {
  std::error_code none;
  const fs::path folder = fs::absolute(file, none).parent_path();
  const fs::path real = fs::canonical(folder, none);
  return none || real / "" == (folder / "").lexically_normal() ? file : real / file.filename();
}

InputFiles::InputFiles() {
  std::error_code removed_meanwhile;
  working_folder_ = fs::current_path(removed_meanwhile);
  model_path_ = folders_of_environment();
  std::istringstream stream(model_path_);
  for (std::string folder; std::getline(stream, folder, ':');)
    if (!folder.empty()) trusted_.add(absolute(folder));
}

InputFiles::InputFiles(std::shared_ptr<const KeptFiles> kept)
    : source_(std::move(kept)),
      working_folder_(source_->working_folder),
      model_path_(source_->model_path),
      settings_(source_->settings) {
  for (const std::string& folder : source_->folders) folders_.insert(key_of(folder));
  // Recordings from before keys were normalised have paths with "..". An exact match of the key has priority.
  for (const bool is_key : {true, false})
    for (const KeptFile& file : source_->files)
      if (std::string key = key_of(file.path); (key == file.path) == is_key) kept_.emplace(std::move(key), &file.bytes);
}

void InputFiles::trust(const fs::path& file, const std::vector<fs::path>& last_model_folders) {
  trusted_.add_around(absolute(file));
  for (const fs::path& folder : last_model_folders) trusted_.add(absolute(folder).parent_path());
}

void InputFiles::add(const fs::path& file, std::string bytes) { files_[key_of(file)] = std::move(bytes); }

void InputFiles::add_expanded(const fs::path& file, std::string bytes) {
  add(file, std::move(bytes));
  expanded_.insert(key_of(file));
}

void InputFiles::set_in(const fs::path& file, std::vector<std::string> settings) {
  settings_of_[key_of(file)] = std::move(settings);
}

const std::vector<std::string>& InputFiles::settings_of(const fs::path& file) const {
  static const std::vector<std::string> none;
  const auto found = settings_of_.find(key_of(file));
  return found == settings_of_.end() ? none : found->second;
}

fs::path InputFiles::absolute(const fs::path& path) const { return (working_folder_ / path).lexically_normal(); }

std::string InputFiles::key_of(const fs::path& path) const {
  const fs::path key = absolute(path);
  return (key.has_filename() || key == key.root_path() ? key : key.parent_path()).string();
}

const std::string* InputFiles::find(const std::string& key) const {
  if (const auto added = files_.find(key); added != files_.end()) return &added->second;
  const auto found = kept_.find(key);
  return found == kept_.end() ? nullptr : found->second;
}

std::optional<std::string> InputFiles::why_unreadable(const fs::path& file) const {
  const std::string key = key_of(file);
  if (find(key) != nullptr) return std::nullopt;
  if (!source_) {
    if (auto reason = parsing::why_unreadable(key)) return reason;
    if (trusted_.contains(key)) return std::nullopt;
    return "the file is outside of all allowed folders; use --allow-files " + fs::path(key).parent_path().string() +
           " to allow it";
  }
  return folders_.contains(key) ? is_a_folder : "the file is not among those from which the experiment was read";
}

const std::string& InputFiles::read(const fs::path& file) {
  const std::string key = key_of(file);
  if (const std::string* const known = find(key)) return *known;
  if (auto reason = why_unreadable(file)) throw std::runtime_error(*std::move(reason));
  return files_.emplace(key, read_bounded(key, most_bytes_of_file)).first->second;
}

std::string InputFiles::content(const fs::path& file) const {
  const std::string key = key_of(file);
  const std::string* const known = find(key);
  return known != nullptr ? *known : read_bounded(key, most_bytes_of_file);
}

std::uintmax_t InputFiles::size(const fs::path& file) const {
  const std::string key = key_of(file);
  if (const std::string* const known = find(key)) return known->size();
  std::error_code error;
  const std::uintmax_t size = fs::file_size(key, error);
  if (error) throw std::runtime_error("the file cannot be read: " + error.message());
  return size;
}

bool InputFiles::is_file(const fs::path& file) const {
  const std::string key = key_of(file);
  std::error_code none;
  return find(key) != nullptr || (!source_ && fs::is_regular_file(key, none));
}

bool InputFiles::is_folder(const fs::path& folder) {
  std::string key = key_of(folder);
  if (folders_.contains(key)) return true;
  std::error_code none;
  if (source_ || !fs::is_directory(key, none)) return false;
  folders_.insert(std::move(key));
  return true;
}

std::vector<fs::path> InputFiles::files_below(const fs::path& folder, const std::string& name) const {
  constexpr int most_entries = 100'000;
  const fs::path top = key_of(folder);
  std::vector<fs::path> found;
  if (source_) {
    for (const auto& [key, bytes] : kept_) {
      const fs::path file = key;
      if (file.filename() == name && !file.lexically_relative(top).native().starts_with("..")) found.push_back(file);
    }
    return found;
  }
  std::error_code error;
  int count = 0;
  if (fs::is_regular_file(top / name, error)) return {top / name};
  for (fs::recursive_directory_iterator each(top, fs::directory_options::skip_permission_denied, error);
       !error && each != fs::recursive_directory_iterator(); each.increment(error)) {
    if (++count > most_entries) return {};
    std::error_code none;
    if (!each->is_directory(none) || each->is_symlink(none) || !fs::is_regular_file(each->path() / name, none))
      continue;
    found.push_back(each->path() / name);
    each.disable_recursion_pending();
  }
  std::ranges::sort(found);
  return found;
}

KeptFiles InputFiles::kept() const {
  KeptFiles kept;
  if (source_) kept = *source_;
  kept.working_folder = working_folder_.string();
  kept.model_path = model_path_;
  kept.settings = settings_;
  kept.folders.assign(folders_.begin(), folders_.end());
  kept.files.reserve(kept.files.size() + files_.size());
  for (const auto& [path, bytes] : files_) kept.files.push_back({path, bytes});
  std::ranges::sort(kept.files, {}, &KeptFile::path);
  return kept;
}

}  // namespace cohort::parsing
