// SPDX-License-Identifier: Apache-2.0
#include "server/recording/facts.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <ctime>
#include <fstream>

#include "client_sdk/math/portable_math.hpp"
#include "server/recording/mcap/format/mcap_error.hpp"
#include "server/simulation/build_identity.hpp"

namespace cohort::recording {
namespace {

const std::string input_prefix = "inputs";  // precedes the absolute path in the name of an attachment

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32] = {};
  const std::size_t size = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return {text, size};
}

// Returns a numbered name: numbers keep the order of lists that are stored as entries.
std::string numbered(const std::string& name, std::size_t number) {
  const std::string digits = std::to_string(number);
  return name + "_" + std::string(5 - std::min<std::size_t>(5, digits.size()), '0') + digits;
}

void add_list(StringMap& entries, const std::string& name, const std::vector<std::string>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) entries[numbered(name, i)] = values[i];
}

std::vector<std::string> list_of(const StringMap& entries, const std::string& name) {
  std::vector<std::string> values;
  for (auto entry = entries.find(numbered(name, 0)); entry != entries.end();
       entry = entries.find(numbered(name, values.size())))
    values.push_back(entry->second);
  return values;
}

std::string media_type_of(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".yaml" || extension == ".yml") return "application/yaml";
  if (extension == ".sdf" || extension == ".urdf" || extension == ".config" || extension == ".dae")
    return "application/xml";
  if (extension == ".png") return "image/png";
  if (extension == ".csv") return "text/csv";
  return "application/octet-stream";
}

}  // namespace

StringMap facts_of(const description::Experiment& experiment) {
  std::string not_portable;
  for (const std::string& function : functions_not_portable())
    not_portable += (not_portable.empty() ? "" : " ") + function;
  utsname machine{};
  uname(&machine);
  return {
      {"version", this_build().version},
      {"commit", this_build().commit},
      {"arithmetic", this_build().arithmetic},
      {"experiment", experiment.name},
      {"world", experiment.world.name},
      {"seed", std::to_string(experiment.seed)},
      {"step_ns", std::to_string(experiment.world.step.count())},
      {"duration_ns", std::to_string(experiment.duration.count())},
      {"robots", std::to_string(experiment.world.robots.size())},
      {"compiler", __VERSION__},
      {"architecture", machine.machine},
      {"system", std::string(machine.sysname) + " " + machine.release},
      {"host", machine.nodename},
      {"cpu", cpu_model()},
      {"functions_not_portable", not_portable},
      {"started", utc_now()},
  };
}

StringMap entries_of(const description::KeptFiles& inputs) {
  StringMap entries = {{"experiment", inputs.experiment},
                       {"working_folder", inputs.working_folder},
                       {"model_path", inputs.model_path},
                       {"files", std::to_string(inputs.files.size())}};
  add_list(entries, "last_model_folder", inputs.last_model_folders);
  add_list(entries, "folder", inputs.folders);
  add_list(entries, "setting", inputs.settings);
  return entries;
}

Attachment attachment_of(const description::KeptFile& input) {
  const auto bytes = std::as_bytes(std::span(input.bytes));
  return {{}, {}, input_prefix + input.path, media_type_of(input.path), {bytes.begin(), bytes.end()}};
}

description::KeptFiles inputs_of(const McapReader& reader, const std::filesystem::path& file) {
  const std::optional<Metadata> metadata = reader.metadata(inputs_name);
  if (!metadata)
    throw McapError(file, 0,
                    "the metadata '" + std::string(inputs_name) +
                        "' with the world of the run is missing: the run was not read from an experiment file, or the "
                        "beginning of the recording is lost");
  StringMap entries = metadata->entries;
  description::KeptFiles inputs;
  inputs.experiment = entries["experiment"];
  inputs.working_folder = entries["working_folder"];
  inputs.model_path = entries["model_path"];
  inputs.last_model_folders = list_of(entries, "last_model_folder");
  inputs.folders = list_of(entries, "folder");
  inputs.settings = list_of(entries, "setting");
  for (const AttachmentIndex& index : reader.attachments()) {
    if (!index.name.starts_with(input_prefix)) continue;
    const Attachment attachment = reader.attachment(index);
    const auto* const text = reinterpret_cast<const char*>(attachment.data.data());
    inputs.files.push_back({index.name.substr(input_prefix.size()), std::string(text, attachment.data.size())});
  }
  std::ranges::sort(inputs.files, {}, &description::KeptFile::path);
  if (std::to_string(inputs.files.size()) != entries["files"])
    throw McapError(
        file, 0,
        "it contains " + std::to_string(inputs.files.size()) + " input files of its run, expected " + entries["files"]);
  return inputs;
}

}  // namespace cohort::recording
