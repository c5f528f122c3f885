#include "server/parsing/world/read_world.hpp"

#include <optional>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/schema/libsdformat_scope.hpp"
#include "server/parsing/world/world_reader.hpp"

namespace cohort::parsing {
namespace {

// Whatever else a library throws is wrong with the file.
template <class Read>
World read_or_input_error(const std::filesystem::path& file, Read&& read) {
  std::optional<World> world;
  std::optional<InputError> wrong;
  const auto failure = libsdformat_failure([&] {
    try {
      world = read();
    } catch (const InputError& error) {
      wrong = error;
    }
  });
  if (wrong) throw *wrong;
  if (failure) throw InputError({{file, 0, "", "cannot be read: " + *failure}});
  return *std::move(world);
}

}  // namespace

World read_world(const std::filesystem::path& named, std::uint64_t seed,
                 const std::vector<std::filesystem::path>& last_model_folders, const std::vector<LaterObject>& later) {
  const std::filesystem::path file = without_links(named);
  InputFiles disk;
  disk.trust(file, last_model_folders);
  return read_world(disk, file, seed, last_model_folders, later);
}

World read_world(InputFiles& input, const std::filesystem::path& file, std::uint64_t seed,
                 const std::vector<std::filesystem::path>& last_model_folders, const std::vector<LaterObject>& later) {
  return read_or_input_error(
      file, [&] { return WorldReader(input, file, seed, last_model_folders).read(LoneModel::none, later); });
}

World read_world_or_model(const std::filesystem::path& named, std::uint64_t seed,
                          const std::vector<std::filesystem::path>& last_model_folders, Xacro xacro) {
  const std::filesystem::path file = without_links(named);
  InputFiles disk;
  disk.trust(file, last_model_folders);
  if (xacro == Xacro::run) expand_named(disk, file);
  return read_or_input_error(
      file, [&] { return WorldReader(disk, file, seed, last_model_folders).read(LoneModel::at_origin, {}); });
}

World read_world_or_standing_model(InputFiles& input, const std::filesystem::path& file, std::uint64_t seed,
                                   const std::vector<std::filesystem::path>& last_model_folders) {
  return read_or_input_error(
      file, [&] { return WorldReader(input, file, seed, last_model_folders).read(LoneModel::on_plane, {}); });
}

std::size_t add_model(const std::string& text, const std::shared_ptr<const KeptFiles>& inputs, World& world) {
  const std::shared_ptr<const KeptFiles> kept = inputs ? inputs : std::make_shared<const KeptFiles>();
  InputFiles input(kept);
  const std::filesystem::path file =
      world.file.parent_path() / (trimmed(text).starts_with('<') ? "(model).sdf" : "(model).yaml");
  input.add(file, text);
  constexpr std::uint64_t no_seed = 0;  // nothing is drawn
  const std::vector<std::filesystem::path> folders(kept->last_model_folders.begin(), kept->last_model_folders.end());
  World alone = read_or_input_error(
      file, [&] { return WorldReader(input, file, no_seed, folders).read_model_file(world.materials); });
  if (alone.models.size() > 1)
    throw InputError({{file, 0, "", "the model has several roots, which are bodies of their own; expected one"}});
  world.materials = std::move(alone.materials);
  const auto before_seed_warnings = world.warnings.end() - static_cast<std::ptrdiff_t>(world.seed_warnings);
  world.warnings.insert(before_seed_warnings, alone.warnings.begin(), alone.warnings.end());
  world.models.push_back(alone.models.front());
  return world.models.size() - 1;
}

}  // namespace cohort::parsing
