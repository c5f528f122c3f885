// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/description/samples.hpp"
#include "server/parsing/files/input_file.hpp"

namespace cohort::parsing {

/// Reads comma-separated values:
///
///     # anything
///     distance [m],angle [rad],reading_0 [1],reading_1 [1]
///     0.01,-1.5708,0.9,0.2
///
/// The first line that is neither empty nor a comment names the columns and their units; readings are numbered from 0.
/// Then follow the positions, ordered by distance and then by angle, with every angle at every distance. Throws
/// InputError with all problems except consequences of others.
Samples read_samples(const std::filesystem::path& file);
Samples read_samples(InputFiles& input, const std::filesystem::path& file);

/// Returns the samples as text, from which they can be read again without loss.
std::string samples_as_text(const Samples& samples);

}  // namespace cohort::parsing
