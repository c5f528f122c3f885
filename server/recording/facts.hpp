// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/description/experiment.hpp"
#include "server/recording/mcap/reading/mcap_reader.hpp"

/// Information about the run in a recording: metadata and attachments.
namespace cohort::recording {

/// Names of metadata records: the run and its machine, its input files, and its end.
inline constexpr const char* facts_name = "cohort";
inline constexpr const char* inputs_name = "cohort_inputs";
inline constexpr const char* end_name = "cohort_end";

/// Returns the facts of a run at its start: version, commit and arithmetic of the build, experiment, seed,
/// step, duration and robots, and the machine and time of day.
StringMap facts_of(const description::Experiment& experiment);

/// The input files of an experiment: a metadata record, and an attachment for each file.
StringMap entries_of(const description::KeptFiles& inputs);
Attachment attachment_of(const description::KeptFile& input);
/// Reads the input files. Throws McapError if the recording lacks any of them.
description::KeptFiles inputs_of(const McapReader& reader, const std::filesystem::path& file);

}  // namespace cohort::recording
