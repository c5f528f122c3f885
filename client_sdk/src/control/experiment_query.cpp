// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/control/experiment_query.hpp"

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "client_sdk/include/cohort/control.hpp"
#include "idl/messages/experiment_files.hpp"

namespace cohort {
namespace {

ExperimentFiles from_message(messages::ExperimentFiles message) {
  ExperimentFiles files{.seed = message.seed,
                        .duration = std::chrono::nanoseconds(message.duration_ns),
                        .experiment = std::move(message.experiment),
                        .working_folder = std::move(message.working_folder),
                        .model_path = std::move(message.model_path),
                        .last_model_folders = std::move(message.last_model_folders),
                        .folders = std::move(message.folders),
                        .files = {},
                        .settings = std::move(message.settings)};
  files.files.reserve(message.files.size());
  for (messages::ExperimentFile& file : message.files)
    files.files.push_back({std::move(file.path), {file.data.begin(), file.data.end()}});
  return files;
}

}  // namespace

ExperimentFiles query_experiment(const std::function<wire::Reply(const wire::GetExperiment&)>& ask) {
  const auto bad = [](const std::string& what) { return ControlError(what, ControlResult::bad_reply); };
  std::vector<std::uint8_t> bytes;
  std::uint64_t size = 0;
  std::optional<std::uint32_t> run;
  do {
    const wire::Reply reply = ask({bytes.size()});
    const auto* const part = reply.get<wire::DataPart>();
    if (part == nullptr) throw bad("the server's reply lacks the experiment");
    if (run && *run != reply.run) {  // another run may have another seed
      run.reset();
      bytes.clear();
      continue;
    }
    if (!run) size = part->size;
    run = reply.run;
    if (size > wire::largest_data) throw bad("the server announced an experiment that is too large");
    if (part->offset != bytes.size() || part->size != size || part->data.empty() ||
        part->data.size() > size - bytes.size())
      throw bad("the server sent the wrong part of the experiment");
    bytes.insert(bytes.end(), part->data.begin(), part->data.end());
  } while (!run || bytes.size() < size);
  try {
    return from_message(messages::decode<messages::ExperimentFiles>(std::as_bytes(std::span(bytes))));
  } catch (const messages::CdrError& error) {
    throw bad(std::string("the server sent an invalid experiment: ") + error.what());
  }
}

}  // namespace cohort
