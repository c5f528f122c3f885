#pragma once

#include "server/description/experiment.hpp"
#include "server/recording/mcap/reading/mcap_reader.hpp"

/// What a recording says of its run beside messages: metadata and attachments.
namespace cohort::recording {

/// Names of metadata: what ran and where, what it was read from, and how it ended.
inline constexpr const char* facts_name = "cohort";
inline constexpr const char* inputs_name = "cohort_inputs";
inline constexpr const char* end_name = "cohort_end";

/// Returns the facts of the run that begins: version, commit and arithmetic of the build, experiment, seed, step,
/// duration, robots; machine and time of day.
StringMap facts_of(const description::Experiment& experiment);

/// What an experiment was read from, as metadata and, of each file, an attachment.
StringMap entries_of(const description::KeptFiles& inputs);
Attachment attachment_of(const description::KeptFile& input);
/// The same again. Throws McapError if the recording has none, or not all.
description::KeptFiles inputs_of(const McapReader& reader, const std::filesystem::path& file);

}  // namespace cohort::recording
