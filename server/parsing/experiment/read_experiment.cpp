// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/experiment/read_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "idl/text/printable.hpp"
#include "server/description/experiment.hpp"
#include "server/description/input_error.hpp"
#include "server/description/select_robots.hpp"
#include "server/parsing/experiment/joint_motors.hpp"
#include "server/parsing/experiment/read_ros2.hpp"
#include "server/parsing/experiment/read_schedule.hpp"
#include "server/parsing/experiment/read_teams.hpp"
#include "server/parsing/files/input_file.hpp"
#include "server/parsing/keys/experiment_keys.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/parsing/world/physics_settings.hpp"
#include "server/parsing/world/read_world.hpp"
#include "server/parsing/yaml/setting.hpp"
#include "server/parsing/yaml/yaml_document.hpp"
#include "server/parsing/yaml/yaml_map.hpp"
#include "server/parsing/yaml/yaml_values.hpp"

namespace cohort::parsing {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_threads = 1024;

// Returns the one team of a world without an experiment; none if there are no robots.
std::vector<Team> team_of_all(const World& world) {
  if (world.robots.empty()) return {};
  Team team;
  team.name = "robots";
  for (std::uint32_t robot = 0; robot < world.robots.size(); ++robot) team.robots.push_back(robot);
  team.policy.required = false;
  return {team};
}

YamlMap map_of_experiment(const YamlNode& document, const YamlReport& report) {
  return {document, "", names_of_keys(experiment_part("experiment", "")), report};
}

// Selects the robots and objects of the document again, for a world whose instances have changed. The rest of the
// experiment stays unchanged.
void select_again(const YamlNode& document, const fs::path& file, Experiment& experiment) {
  std::vector<Problem> problems;
  const YamlReport report(file, problems);
  const YamlMap top = map_of_experiment(document, report);
  Experiment read;
  read.world = std::move(experiment.world);
  read.teams = read_teams(top, &read.world, report);
  ScheduleReader(top, file, report).read(read);
  Recorded& recorded = experiment.recorded;
  if (recorded.selectors != read.recorded.selectors) {
    try {
      read.recorded.observed = select_robots(read.world, recorded.selectors);
    } catch (const std::invalid_argument& error) {
      problems.push_back({file, 0, "record.robots", error.what()});
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  for (Team& team : experiment.teams) {
    const auto again = std::ranges::find(read.teams, team.name, &Team::name);
    if (again != read.teams.end()) team.robots = std::move(again->robots);
  }
  experiment.world = std::move(read.world);
  experiment.events = std::move(read.events);
  experiment.reactions = std::move(read.reactions);
  experiment.spawners = std::move(read.spawners);
  experiment.stops = std::move(read.stops);
  experiment.prints = std::move(read.prints);
  experiment.history.objects = std::move(read.history.objects);
  recorded.observed = std::move(read.recorded.observed);
}

class ExperimentReader {
 public:
  /// `input` must outlive this.
  ExperimentReader(InputFiles& input, const fs::path& file, const std::vector<fs::path>& last_model_folders)
      : input_(input), last_model_folders_(last_model_folders), report_(file, problems_) {
    experiment_.file = file;
  }

  Experiment read(std::optional<std::uint64_t> seed, std::optional<std::chrono::nanoseconds> duration);

 private:
  Experiment read_without_experiment(std::optional<std::uint64_t> seed,
                                     std::optional<std::chrono::nanoseconds> duration);
  YamlPtr load();
  YamlPtr with_settings(YamlPtr document);
  void read_world_of(const YamlMap& top, const std::vector<LaterObject>& later);
  void read_step(const YamlMap& top);

  InputFiles& input_;
  std::vector<fs::path> last_model_folders_;
  Experiment experiment_;
  std::vector<Problem> problems_;
  YamlReport report_;
  std::vector<std::string> settings_of_world_;
  bool world_is_read_ = false;
};

Experiment ExperimentReader::read(std::optional<std::uint64_t> seed, std::optional<std::chrono::nanoseconds> duration) {
  if (kind_of_file(input_, experiment_.file) == FileKind::sdf) return read_without_experiment(seed, duration);
  const YamlPtr document = with_settings(load());
  const YamlMap top = map_of_experiment(*document, report_);
  experiment_.name = printable(experiment_.file.stem().string());

  const std::uint64_t written_seed =
      top.whole("seed", 0, std::numeric_limits<std::uint64_t>::max()).value_or(experiment_.seed);
  experiment_.seed = seed.value_or(written_seed);
  if (!duration) top.require("duration", "simulated time in seconds");
  experiment_.duration = duration.value_or(read_seconds(top, "duration").value_or(experiment_.duration));
  top.require("world", "path of the world file, relative to this file");
  top.require("teams", "list of teams with their robots and controllers");
  const ScheduleReader schedule(top, experiment_.file, report_);
  read_world_of(top, schedule.later_objects());
  read_step(top);
  if (top.has("threads"))
    experiment_.threads = static_cast<unsigned>(top.whole("threads", 1, most_threads).value_or(1));
  if (top.has("physics"))
    experiment_.world.physics =
        with_values(experiment_.world.physics, read_physics_map(top.where("physics"), top.path_to("physics"), report_));
  experiment_.teams = read_teams(top, world_is_read_ ? &experiment_.world : nullptr, report_);
  experiment_.ros2 = read_ros2(top, world_is_read_ ? &experiment_.world : nullptr, experiment_.teams, report_);
  if (world_is_read_) schedule.read(experiment_);
  experiment_.select_again = [document, file = experiment_.file](Experiment& experiment) {
    select_again(*document, file, experiment);
  };

  if (!problems_.empty()) throw InputError(std::move(problems_));
  return std::move(experiment_);
}

Experiment ExperimentReader::read_without_experiment(std::optional<std::uint64_t> seed,
                                                     std::optional<std::chrono::nanoseconds> duration) {
  if (auto reason =
          input_.why_unreadable(input_.absolute(experiment_.file)))  // the path under which it is read and kept
    throw InputError({{experiment_.file, 0, "", std::move(*reason)}});
  experiment_.name = printable(experiment_.file.stem().string());
  input_.set_in(experiment_.file, input_.settings());
  experiment_.seed = seed.value_or(experiment_.seed);
  experiment_.duration = duration.value_or(duration_without_experiment);
  experiment_.world = read_world_or_standing_model(input_, experiment_.file, experiment_.seed, last_model_folders_);
  experiment_.teams = team_of_all(experiment_.world);
  experiment_.select_again = [](Experiment& experiment) { experiment.teams = team_of_all(experiment.world); };
  return std::move(experiment_);
}

YamlPtr ExperimentReader::load() {
  const fs::path& file = experiment_.file;
  if (auto reason = input_.why_unreadable(file)) throw InputError({{file, 0, "", std::move(*reason)}});
  const YamlDocument document = parse_yaml(input_.read(file));
  if (document.error) throw InputError({{file, document.error->line, "", document.error->message}});
  return document.root;
}

// Leaves the settings below `world` to the file that it names.
YamlPtr ExperimentReader::with_settings(YamlPtr document) {
  for (const std::string& text : input_.settings()) {
    const Setting setting = parse_setting(text);
    if (setting.path.front() == "world" && setting.path.size() > 1)
      settings_of_world_.push_back(text);
    else
      document = with_setting(document, setting, report_);
  }
  return document;
}

void ExperimentReader::read_world_of(const YamlMap& top, const std::vector<LaterObject>& later) {
  const std::optional<std::string> name = top.text("world");
  if (!name) return;
  const fs::path world = (experiment_.file.parent_path() / *name).lexically_normal();
  if (const auto reason = input_.why_unreadable(world)) {
    top.problem("world", *reason + ": '" + world.string() + "'");
    return;
  }
  input_.set_in(world, settings_of_world_);
  try {
    experiment_.world = read_world(input_, world, experiment_.seed, last_model_folders_, later);
    world_is_read_ = true;
  } catch (const InputError& error) {
    problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
  }
}

void ExperimentReader::read_step(const YamlMap& top) {
  constexpr std::chrono::nanoseconds longest = std::chrono::seconds(1);
  constexpr double rounding = 1e-3;  // in ns: 1/100 s has no exact binary representation
  const std::optional<std::chrono::nanoseconds> step = read_seconds(top, "step");
  if (!step) return;
  const double nanoseconds = *top.real("step") * 1e9;
  if (*step > longest || std::abs(nanoseconds - std::round(nanoseconds)) > rounding)
    top.problem("step", "expected a whole number of nanoseconds, at most 1 s");
  experiment_.world.step = *step;
}

// Keeps the files that were read, for the experiment and for texts that arrive while its world runs.
void keep_inputs(Experiment& experiment, std::shared_ptr<const KeptFiles> kept) {
  experiment.read_model = model_reader(kept, experiment.world.file.parent_path());
  experiment.inputs = std::move(kept);
}

Experiment read_from(InputFiles& disk, const fs::path& file, std::optional<std::uint64_t> seed,
                     std::optional<std::chrono::nanoseconds> duration,
                     const std::vector<fs::path>& last_model_folders) {
  Experiment experiment = ExperimentReader(disk, file, last_model_folders).read(seed, duration);
  KeptFiles kept = disk.kept();
  kept.experiment = file.string();
  for (const fs::path& folder : last_model_folders) kept.last_model_folders.push_back(folder.string());
  keep_inputs(experiment, std::make_shared<const KeptFiles>(std::move(kept)));
  return experiment;
}

// Lets `disk` read the file and what lies below its folders, and expands the file itself if it may run xacro.
void open_files(InputFiles& disk, const fs::path& file, const std::vector<fs::path>& last_model_folders, Xacro xacro) {
  disk.trust(file, last_model_folders);
  if (xacro == Xacro::run) expand_named(disk, file);
}

}  // namespace

Experiment read_experiment(const fs::path& named, std::optional<std::uint64_t> seed,
                           std::optional<std::chrono::nanoseconds> duration,
                           const std::vector<fs::path>& last_model_folders, Xacro xacro,
                           const std::vector<std::string>& settings) {
  const fs::path file = without_links(named);
  InputFiles disk;
  open_files(disk, file, last_model_folders, xacro);
  disk.set(settings);
  return read_from(disk, file, seed, duration, last_model_folders);
}

Experiment read_experiment_with_joint_motors(const fs::path& named, std::optional<std::uint64_t> seed,
                                             std::optional<std::chrono::nanoseconds> duration,
                                             const std::vector<fs::path>& last_model_folders, Xacro xacro,
                                             const std::vector<std::string>& settings) {
  const fs::path file = without_links(named);
  InputFiles disk;
  open_files(disk, file, last_model_folders, xacro);
  disk.set(settings);
  Experiment plain = read_from(disk, file, seed, duration, last_model_folders);
  // The settings are of the file itself, and not of the one that would include it.
  if (!settings.empty() || !holds_lone_model(disk, file)) return plain;
  const auto text = text_with_joint_motors(plain.world, file.filename().string());
  if (!text) return plain;
  const fs::path with_motors = file.parent_path() / (file.stem().string() + " (joint motors).sdf");
  disk.add(with_motors, *text);
  try {
    Experiment driven = read_from(disk, with_motors, seed, duration, last_model_folders);
    driven.world.warnings = plain.world.warnings;
    return driven;
  } catch (const InputError& error) {
    plain.world.warnings.push_back(
        {file, 0, "",
         std::string("the page cannot move the joints of this model, because the model cannot be included: ") +
             error.what()});
    return plain;
  }
}

Experiment read_experiment_texts(const std::vector<KeptFile>& texts, std::optional<std::uint64_t> seed,
                                 std::optional<std::chrono::nanoseconds> duration,
                                 const std::vector<fs::path>& last_model_folders) {
  const fs::path file = without_links(texts.at(0).path);
  InputFiles disk;
  disk.trust(file, last_model_folders);
  for (const KeptFile& text : texts) disk.add(without_links(text.path), text.bytes);
  return read_from(disk, file, seed, duration, last_model_folders);
}

Experiment read_experiment(std::shared_ptr<const KeptFiles> kept, std::optional<std::uint64_t> seed,
                           std::optional<std::chrono::nanoseconds> duration) {
  InputFiles input(kept);
  const std::vector<fs::path> last_model_folders(kept->last_model_folders.begin(), kept->last_model_folders.end());
  Experiment experiment = ExperimentReader(input, kept->experiment, last_model_folders).read(seed, duration);
  keep_inputs(experiment, std::move(kept));
  return experiment;
}

}  // namespace cohort::parsing
