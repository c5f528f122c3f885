// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "server/description/world.hpp"
#include "server/parsing/files/xacro.hpp"

namespace cohort::tool {

/// Reads the world of a model, a world or an experiment: a file, or the name of one that is installed with Cohort.
/// `seed`, if given, replaces that of the experiment. Throws InputError, or std::invalid_argument for an unknown name.
description::World read_named_world(const std::filesystem::path& name, std::optional<std::uint64_t> seed,
                                    parsing::Xacro xacro);

}  // namespace cohort::tool
