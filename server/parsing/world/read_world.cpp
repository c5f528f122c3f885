// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/world/read_world.hpp"

#include <exception>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/world/world_reader.hpp"

namespace cohort::parsing {
namespace {

// Any other exception of a library is a problem of the file, except out of memory, which the file did not cause.
template <class Read>
World read_or_input_error(const std::filesystem::path& file, Read&& read) {
  try {
    return read();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError({{file, 0, "", std::string("cannot be read: ") + error.what()}});
  }
}

std::string flaws_of(const InputError& error) {
  std::string flaws;
  for (const Problem& problem : error.problems())
    flaws += (flaws.empty() ? "" : "; ") + (problem.line > 0 ? "line " + std::to_string(problem.line) + ": " : "") +
             (problem.element.empty() ? "" : problem.element + ": ") + problem.message;
  return flaws;
}

ParsedModelPtr read_model_text(const std::string& text, const std::shared_ptr<const KeptFiles>& inputs,
                               const std::filesystem::path& folder) {
  InputFiles input(inputs);
  const std::filesystem::path file = folder / (trimmed(text).starts_with('<') ? "(model).sdf" : "(model).yaml");
  input.add(file, text);
  constexpr std::uint64_t no_seed = 0;  // nothing is drawn
  const std::vector<std::filesystem::path> folders(inputs->last_model_folders.begin(),
                                                   inputs->last_model_folders.end());
  try {
    World alone =
        read_or_input_error(file, [&] { return WorldReader(input, file, no_seed, folders).read_model_file(); });
    if (alone.models.size() > 1)
      throw InputError(
          {{file, 0, "", "the model has several root links, which are separate bodies; expected one root link"}});
    return std::make_shared<const ParsedModel>(
        ParsedModel{text, alone.models.front(), std::move(alone.materials), std::move(alone.warnings)});
  } catch (const InputError& error) {
    throw description::ModelTextError("the text of the model: " + flaws_of(error), input.lacks_file());
  }
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

ModelReader model_reader(std::shared_ptr<const KeptFiles> inputs, std::filesystem::path folder) {
  if (inputs == nullptr) inputs = std::make_shared<const KeptFiles>();
  return [inputs = std::move(inputs), folder = std::move(folder)](const std::string& text) {
    return read_model_text(text, inputs, folder);
  };
}

}  // namespace cohort::parsing
