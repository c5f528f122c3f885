// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/named_world.hpp"

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/parsing/world/read_world.hpp"
#include "tools/cli/common/installed_files.hpp"

namespace cohort::tool {

description::World read_named_world(const std::filesystem::path& name, std::optional<std::uint64_t> seed,
                                    parsing::Xacro xacro) {
  const std::filesystem::path file = experiment_called(name);
  if (parsing::kind_of_file(file) == parsing::FileKind::sdf)
    return parsing::read_world_or_model(file, seed.value_or(1), installed_model_folders(), xacro);
  return parsing::read_experiment(file, seed, {}, installed_model_folders()).world;
}

}  // namespace cohort::tool
