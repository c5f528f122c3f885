// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/description/world.hpp"
#include "server/parsing/model/read_model.hpp"
#include "server/parsing/sdf/extension_values.hpp"
#include "server/parsing/sdf/sdf_files.hpp"
#include "server/parsing/world/later_object.hpp"
#include "server/parsing/world/read_population.hpp"

namespace cohort::parsing {

/// How a file with a model instead of a world is read.
enum class LoneModel { none, at_origin, on_plane };

/// Reads one world, or a single model.
class WorldReader {
 public:
  WorldReader(InputFiles& input, const std::filesystem::path& file, std::uint64_t seed,
              const std::vector<std::filesystem::path>& last_model_folders)
      : seed_(seed),
        files_(input, file, last_model_folders, problems_, world_.warnings),
        shape_files_(files_),
        report_(files_, problems_, world_.warnings) {
    world_.file = file;
  }

  World read(LoneModel lone, const std::vector<LaterObject>& later);
  /// Reads a world with only the model of the file.
  World read_model_file();

 private:
  World finished();
  void read_model_alone(const SdfFile& file);
  void read_settings(const Element& world);
  void read_wind(const Element& world, const Element& velocity);
  void read_models(const Element& world, const SdfFile& file);
  void read_lights(const Element& world, const SdfFile& file);
  void read_inline_model(const Element& element, const SdfFile& file);
  void add_included_model(const Include& include, const Pose& X_WM);
  void add_part(const SdfFile& unread, const std::string& name, const Pose& X_WM);
  void read_extensions(const Element& world);
  void read_setting(const Element* element, const Extension& extension);
  void read_reference(const Element* element, const Extension& extension, bool all_is_read);
  void add_material_pair(const ExtensionValues& values);
  void add_breakable_joint(const ExtensionValues& values);
  /// Returns the index of the material that `key` names; reports an unknown one.
  std::optional<std::uint32_t> find_material(const ExtensionValues& values, const char* key) const;
  ModelReading reading(bool is_static, const SdfFile& file) {
    return {is_static, file.sound, report_, shape_files_, world_.materials};
  }
  void add_population(WrittenPopulation written);
  std::size_t count_of_bodies(std::size_t model) const;
  /// Returns the file of a model; null if there is none or it is invalid, and then calls `problem`.
  template <class Report>
  const SdfFile* find_model(const std::string& uri, const Report& problem);
  /// Returns the index in World::models of the model in a file, which all its includes share.
  std::size_t shared_model(const SdfFile& file, bool is_static);
  void add_later(const LaterObject& object);
  std::vector<Model> renamed(std::size_t model, const std::string& name) const;
  /// Adds the bodies of a model, and returns the index of the first in World::models.
  std::size_t add_models(std::vector<Model> bodies);
  /// Adds an instance with all bodies of the model. Returns false if a name is in use.
  bool add_instance(const std::string& name, std::size_t model, const Pose& X_WM);

  std::uint64_t seed_;
  World world_;
  std::vector<Problem> problems_;
  SdfFiles files_;
  ShapeFiles shape_files_;
  SdfReport report_;
  std::map<std::pair<const SdfFile*, bool>, std::size_t> shared_;
  std::map<const SdfFile*, std::optional<std::size_t>> parts_;  // likewise; nothing if it cannot be read
  std::map<std::size_t, std::size_t> bodies_;  // number of bodies, for models with several, by the index of the first
  std::set<std::string> names_;
};

}  // namespace cohort::parsing
