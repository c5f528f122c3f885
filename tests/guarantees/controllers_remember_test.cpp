// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cinttypes>
#include <csignal>
#include <cstdio>
#include <map>
#include <mutex>

#include "client_sdk/hosting/plugin_loader.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/run/in_process.hpp"
#include "tests/support/controlled_run.hpp"
#include "tests/support/worlds/sbot_layout.hpp"

// A run continues from a snapshot with the state of its controllers.
namespace cohort::test {
namespace {

using session::SessionSnapshot;
using Snapshots = std::map<std::uint64_t, SessionSnapshot>;

struct Case {
  const char* experiment;
  double seconds;
  bool has_memory = true;
  std::uint64_t seed = 1;  // the first with controller state
};
void PrintTo(const Case& tested, std::ostream* out) { *out << tested.experiment; }

std::string file_of(const Case& tested) {
  return COHORT_SOURCE_DIR "/worlds/experiments/" + std::string(tested.experiment) + ".yaml";
}

constexpr std::size_t few = 3;

// Returns true also if no controller has state.
bool remembers_something(const SessionSnapshot& snapshot) {
  const auto is_blank = [](const std::optional<ControllerState>& state) {
    return state && std::ranges::all_of(state->bytes, [](std::byte byte) { return byte == std::byte{0}; });
  };
  const auto is_empty = [](const std::optional<ControllerState>& state) { return state && state->bytes.empty(); };
  return std::ranges::all_of(snapshot.controllers, is_empty) || !std::ranges::all_of(snapshot.controllers, is_blank);
}

// An experiment whose controllers are in this process.
class RunHere {
 public:
  RunHere(const Case& tested, std::uint32_t threads, const SessionSnapshot* from = nullptr)
      : experiment_(parsing::read_experiment(file_of(tested), tested.seed,
                                             std::chrono::nanoseconds(std::llround(tested.seconds * 1e9)))),
        simulation_(experiment_, threads) {
    for (const description::Team& team : experiment_.teams) {
      plugins_.push_back(std::make_unique<LoadedPlugin>(team.controller, default_plugin_directories()));
      kinds_.push_back(kind_of(plugins_.back()->plugin()));
    }
    if (from == nullptr) return;
    options_.from = std::make_shared<SessionSnapshot>(*from);
    session::restore(*from, simulation_);
  }

  /// Returns the hash at the end. Keeps the first and the last snapshots with controller state, converted to bytes and
  /// back.
  std::uint64_t finish(Snapshots* snapshots = nullptr) {
    session::RunListener listener;
    listener.can_save = [&](const auto& take) {
      constexpr std::uint64_t interval = 110;
      if (snapshots == nullptr || simulation_.tick() % interval != interval - 1) return;
      SessionSnapshot snapshot = session::snapshot_from_bytes(session::to_bytes(take()));
      if (!remembers_something(snapshot)) return;
      snapshots->emplace(simulation_.tick(), std::move(snapshot));
      if (snapshots->size() > few) snapshots->erase(std::next(snapshots->begin()));
    };
    result_ = session::run_in_process(experiment_, simulation_, kinds_, options_, listener, never);
    EXPECT_EQ(result_.end, session::RunResult::End::finished) << result_.error;
    return result_.state_hash;
  }
  bool has_unsaved() const {
    return std::ranges::any_of(result_.events, [](const auto& event) { return event.kind == "unsaved"; });
  }

 private:
  description::Experiment experiment_;
  Simulation simulation_;
  std::vector<std::unique_ptr<LoadedPlugin>> plugins_;
  std::vector<ControllerKind> kinds_;
  session::RunOptions options_;
  session::RunResult result_;
};

class ControllersRemember : public ::testing::TestWithParam<Case> {
 protected:
  std::string summary_of(const std::vector<std::string>& arguments) {
    return run_experiment(file_of(GetParam()), arguments)["state_hash"];
  }
  std::string seconds_ = std::to_string(GetParam().seconds);
  std::string seed_ = std::to_string(GetParam().seed);
  ScratchFolder folder_;
};

TEST_P(ControllersRemember, ARunFromASnapshotOfAnyTickHasTheSameBits) {
  Snapshots snapshots;
  const std::uint64_t straight = RunHere(GetParam(), 2).finish(&snapshots);
  bool state_matters = false;
  for (const auto& [tick, snapshot] : snapshots) {
    for (const std::uint32_t threads : {1u, 2u}) {
      RunHere again(GetParam(), threads, &snapshot);
      EXPECT_EQ(again.finish(), straight) << "from tick " << tick << " with " << threads << " threads";
      EXPECT_FALSE(again.has_unsaved());
    }
    SessionSnapshot forgotten = snapshot;
    forgotten.controllers.clear();
    RunHere other(GetParam(), 2, &forgotten);
    state_matters = other.finish() != straight || state_matters;
    EXPECT_TRUE(other.has_unsaved()) << "and it is told";
  }
  EXPECT_FALSE(snapshots.empty());
  EXPECT_EQ(state_matters, GetParam().has_memory) << "without what they remember it is another run";
}

TEST_P(ControllersRemember, InAnyPlaceAndFromAnyPlace) {
  Snapshots snapshots;
  char expected[17];
  std::snprintf(expected, sizeof expected, "%016" PRIx64, RunHere(GetParam(), 2).finish(&snapshots));
  ASSERT_FALSE(snapshots.empty());
  const std::string tick = std::to_string(snapshots.begin()->first);
  int combination = 0;  // each place meets each number of threads, as saver and after it
  for (const std::string saved_by : {"process", "per-robot"}) {
    const ReservedDomain domain;
    const std::string file = (folder_ / (saved_by + ".snap")).string();
    Process run({cohort_program(), "run", file_of(GetParam()), "--seed", seed_, "--duration", seconds_, "--paused",
                 "--controllers", saved_by, "--domain", domain.text()});
    for (const std::vector<std::string>& what : {std::vector<std::string>{"step", tick}, {"save", file}, {"resume"}}) {
      std::vector<std::string> ctl = {cohort_program(), "ctl",       "--domain",
                                      domain.text(),    "--timeout", patience_in_seconds};
      ctl.insert(ctl.end(), what.begin(), what.end());
      const Ended ended = run_to_end(ctl);
      ASSERT_EQ(ended.exit_code, 0) << ended.err << run.output();
      EXPECT_EQ(ended.out.find("without state"), std::string::npos) << ended.out;
    }
    ASSERT_EQ(run.wait_for_exit(), 0) << run.output();
    EXPECT_NE(run.output().find(expected), std::string::npos) << "saving changes nothing: " << run.output();
    for (const std::string placement : {"inprocess", "process", "per-robot"}) {
      const std::string threads = combination++ % 2 == 0 ? "1" : "2";
      EXPECT_EQ(summary_of({"--controllers", placement, "--seed", seed_, "--duration", seconds_, "--from", file,
                            "--threads", threads}),
                expected)
          << saved_by << " to " << placement << " with " << threads << " threads";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheExperiment, ControllersRemember,
                         ::testing::Values(Case{"aggregation", 20.0}, Case{"assembly", 20.0, true, 2},
                                           Case{"retrieval", 40.0, true, 3}, Case{"lifting", 40.0}, Case{"chain", 60.0},
                                           Case{"phototaxis", 5.0, false}),
                         [](const auto& tested) { return std::string(tested.param.experiment); });

// Robots whose commands depend on all frames so far, with pending frames.
class ServedMemory : public ::testing::Test {
 protected:
  static constexpr const char* policy = ", delay: 2, parameters: {speed: 0.1}";
  const std::string plugin_ = test_controller("remembering");
  const FieldOfRobots field_{4, 20.0, policy, plugin_};
  const std::string expected_ = reference(field_);

  void attach(ControlledRun& run) {
    for (const char* robots : {"0..1", "2..3"})
      hosts_.push_back(std::make_unique<Process>(FieldOfRobots::host(run.domain(), robots, plugin_)));
  }
  std::vector<std::unique_ptr<Process>> hosts_;
};

TEST_F(ServedMemory, GivesTheSameBitsAfterGoingBack) {
  ControlledRun run(field_, {"--paused", "--keep-snapshots", "1"}, false);
  attach(run);
  run.done({"step", "1234"});
  run.done({"back", "7"});
  EXPECT_EQ(run.tick(), 700u);
  run.done({"step", "500"});
  run.done({"back", "3.5"});
  run.done({"resume"});
  const auto summary = run.finish();
  EXPECT_EQ(summary["state_hash"], expected_);
  EXPECT_TRUE(events_of(summary, "unsaved").empty()) << summary["events"].dump(1);
}

TEST_F(ServedMemory, IsLoadedByConnectedAndByNewControllers) {
  const std::string file = (field_ / "saved.snap").string();
  {
    ControlledRun run(field_, {"--paused"}, false);
    attach(run);
    run.done({"step", "777"});
    run.done({"save", file});
    run.done({"step", "300"});
    run.done({"load", file});
    EXPECT_EQ(run.tick(), 777u);
    const std::string again = (field_ / "again.snap").string();
    run.done({"save", again});
    EXPECT_TRUE(read_file(file) == read_file(again)) << "nothing has happened since";
    run.done({"resume"});
    EXPECT_EQ(run.finish()["state_hash"], expected_);
  }
  ControlledRun run(field_, {"--from", file}, false);
  Process one(FieldOfRobots::host(run.domain(), "1..3", plugin_)),
      other(FieldOfRobots::host(run.domain(), "0", plugin_));
  EXPECT_EQ(run.finish()["state_hash"], expected_);
}

TEST_F(ServedMemory, IsReportedAsMissingIfAControllerDoesNotSave) {
  const FieldOfRobots field(2, 20.0, "", test_controller("misbehaving"));
  const std::string file = (field / "saved.snap").string();
  ControlledRun run(field, {"--paused"}, false);
  Process host(FieldOfRobots::host(run.domain(), "all", test_controller("misbehaving")));
  run.done({"step", "10"});
  const std::string saved = run.done({"save", file});
  EXPECT_NE(saved.find("team 'swarm' ("), std::string::npos) << saved;
  EXPECT_NE(saved.find("without state"), std::string::npos) << saved;
  run.done({"save", file});
  for (int times = 0; times < 2; ++times) run.done({"load", file});
  run.done({"shutdown"});
  const auto unsaved = events_of(run.finish(), "unsaved");
  ASSERT_EQ(unsaved.size(), 1u) << "once";
  EXPECT_NE(unsaved[0]["text"].get<std::string>().find("misbehaving"), std::string::npos) << unsaved[0].dump();
  const std::vector<std::string> told = lines_of(run.server().output());
  const auto warnings = std::ranges::count_if(told, [&](const std::string& line) {
    return line.find("warning: ") != std::string::npos &&
           line.find(unsaved[0]["text"].get<std::string>()) != std::string::npos;
  });
  EXPECT_EQ(warnings, 1) << "once, also where the run goes on: " << run.server().output();
}

TEST_F(ServedMemory, FailsTheSnapshotByNameIfItCannotBeSaved) {
  const std::string controller = test_controller("misbehaving");
  const FieldOfRobots field(2, 3.0, "", controller);
  const std::string file = (field / "saved.snap").string();
  const std::map<std::string, std::string> whys = {{"throw in save", "a fault on purpose"},
                                                   {"save too much", "the maximum is 1048576"}};
  for (const auto& [fault, why] : whys) {
    ControlledRun run(field, {"--paused", "--keep-snapshots", "0.5"}, false);
    Process host(FieldOfRobots::host(run.domain(), "all", controller),
                 {{"COHORT_TEST_FAULT", fault}, {"COHORT_TEST_ROBOT", "swarm/sbot_1"}});
    run.done({"step", "10"});
    const Ended saved = run_to_end(run.ctl({"--timeout", patience_in_seconds, "save", file}));
    EXPECT_NE(saved.exit_code, 0) << saved.out;
    for (const std::string& said : {std::string("team 'swarm'"), std::string("'swarm/sbot_1'"), why})
      EXPECT_NE(saved.err.find(said), std::string::npos) << said << ": " << saved.err;
    EXPECT_FALSE(std::filesystem::exists(file));
    run.done({"resume"});
    const auto summary = run.finish();
    EXPECT_EQ(summary["ticks"], 300);
    EXPECT_EQ(host.wait_for_exit(), 0) << host.output();
    const auto unsaved = events_of(summary, "unsaved");
    ASSERT_EQ(unsaved.size(), 1u) << "once: " << summary["events"].dump(1);
    EXPECT_NE(unsaved[0]["text"].get<std::string>().find(why), std::string::npos) << unsaved[0].dump();
  }
}

TEST_F(ServedMemory, IsNotAwaitedForeverFromAStoppedController) {
  const std::string file = (field_ / "saved.snap").string();
  ControlledRun run(field_, {"--paused"}, false);
  attach(run);
  run.done({"step", "50"});
  hosts_[1]->signal(SIGSTOP);
  const std::string saved = run.done({"save", file});
  EXPECT_NE(saved.find("without state"), std::string::npos) << saved;
  hosts_[1]->signal(SIGCONT);
  run.done({"resume"});
  EXPECT_EQ(run.finish()["state_hash"], expected_) << "and the run goes on as it would have";
}

// The snapshots of ticks 0, 100 … have the state of all controllers; connected controllers load it too.
TEST_F(ServedMemory, RewindsTheRunWhenLostWithAProcess) {
  const FieldOfRobots field(4, 20.0, std::string(policy) + ", on_lost: rewind", plugin_);
  ControlledRun run(field, {"--paused", "--keep-snapshots", "1"}, false);
  attach(run);
  run.done({"step", "1234"});
  hosts_[1]->signal(SIGKILL);
  run.done({"resume"});
  ASSERT_TRUE(run.server().wait_for_output("waiting for swarm/sbot_2 and 1 more")) << run.server().output();
  hosts_.push_back(std::make_unique<Process>(FieldOfRobots::host(run.domain(), "2..3", plugin_)));
  const auto summary = run.finish();
  EXPECT_EQ(summary["state_hash"], expected_) << "the hash of the undisturbed run";
  const auto rewound = events_of(summary, "rewound");
  ASSERT_EQ(rewound.size(), 1u) << summary["events"].dump(1);
  EXPECT_NE(rewound[0]["text"].get<std::string>().find("to tick 1200"), std::string::npos) << rewound[0];
  EXPECT_TRUE(events_of(summary, "unsaved").empty()) << summary["events"].dump(1);
}

TEST_F(ServedMemory, IsReportedWhenLostIfTheRunContinues) {
  ControlledRun run(field_, {"--paused"}, false);
  attach(run);
  run.done({"step", "100"});
  hosts_[1]->signal(SIGKILL);
  run.done({"resume"});
  ASSERT_TRUE(run.server().wait_for_output("waiting for swarm/sbot_2 and 1 more")) << run.server().output();
  hosts_.push_back(std::make_unique<Process>(FieldOfRobots::host(run.domain(), "2..3", plugin_)));
  const auto summary = run.finish();
  EXPECT_NE(summary["state_hash"], expected_) << "it is another run";
  const auto forgotten = events_of(summary, "forgotten");
  ASSERT_EQ(forgotten.size(), 1u) << summary["events"].dump(1);
  EXPECT_NE(forgotten[0]["text"].get<std::string>().find("swarm/sbot_2"), std::string::npos) << forgotten[0];
}

TEST_F(ServedMemory, CannotBeRewoundWithoutSnapshots) {
  const FieldOfRobots field(1, 1.0, ", on_lost: rewind");
  const Ended ended = run_to_end({cohort_program(), "run", field.file()});
  EXPECT_EQ(ended.exit_code, 2) << ended.err;
  EXPECT_NE(ended.err.find("'--keep-snapshots 10' keeps one"), std::string::npos) << ended.err;
  EXPECT_EQ(run_to_end({cohort_program(), "run", field.file(), "--controllers", "inprocess"}).exit_code, 0);
}

// A client written from docs/protocol.md that drives robot 0 correctly, and sends any state that the test chooses.
class Liar {
 public:
  using Lie = std::function<void(wire::Writer<wire::ControllerState>&, wire::ControllerState)>;

  explicit Liar(std::uint32_t domain)
      : participant_(wire::Participant::client(domain)),
        commands_(participant_),
        joins_(participant_),
        states_(participant_),
        wanted_(participant_,
                {[this](const wire::ControllerState& wanted, const wire::Sender&) {
                   const std::lock_guard lock(mutex_);
                   wire::ControllerState here = wanted;
                   here.kind = wire::StateKind::here;
                   if (lie_) lie_(states_, here);
                 },
                 {}},
                wire::partition_of(id), 4),
        frames_(participant_,
                {[this](const wire::Observation& frame, const wire::Sender&) {
                   const std::vector<double> still(sbot_command_size, 0.0);
                   commands_.write({id, frame.run, frame.epoch, frame.tick, frame.robots, still});
                 },
                 {}},
                wire::partition_of(id)) {
    wire::Join join;
    join.client = id;
    join.controller = "liar";
    join.robots = {"0"};
    joins_.write(join);
  }
  void tell(Lie lie) {
    const std::lock_guard lock(mutex_);
    lie_ = std::move(lie);
  }

 private:
  static constexpr std::uint64_t id = 0xabcdef;
  std::mutex mutex_;
  Lie lie_;
  wire::Participant participant_;
  wire::Writer<wire::Command> commands_;
  wire::Writer<wire::Join> joins_;
  wire::Writer<wire::ControllerState> states_;
  wire::Reader<wire::ControllerState> wanted_;
  wire::Reader<wire::Observation> frames_;
};

TEST_F(ServedMemory, IsIgnoredFromADishonestClient) {
  const FieldOfRobots field(2, 20.0, ", parameters: {speed: 0.1}", plugin_);
  const std::string file = (field / "saved.snap").string();
  ControlledRun run(field, {"--paused"}, false);
  const Process honest(FieldOfRobots::host(run.domain(), "1", plugin_));
  Liar liar(run.domain().number());
  run.done({"step", "10"});
  const auto bytes_as = [](std::span<const std::byte> bytes, wire::ControllerState here) {
    here.size = bytes.size();
    here.data = {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
    return here;
  };
  const std::vector<std::byte> noise(1000, std::byte{0x5a});
  const std::vector<std::byte> too_much(wire::largest_state_part + 1);
  const std::vector<std::byte> of_another = pack(std::vector<RobotState>{{1, ControllerState{"Remembering", noise}}});
  const std::map<std::string, Liar::Lie> lies = {
      {"noise", [&](auto& states, auto here) { states.write(bytes_as(noise, here)); }},
      {"of another's robot", [&](auto& states, auto here) { states.write(bytes_as(of_another, here)); }},
      {"too much at once", [&](auto& states, auto here) { states.write(bytes_as(too_much, here)); }},
      {"more than can be",
       [&](auto& states, auto here) {
         here = bytes_as(noise, here);
         here.size = std::uint64_t{1} << 60;
         states.write(here);
       }},
      {"of another lease, run and tick, and of no kind",
       [&](auto& states, auto here) {
         here = bytes_as(noise, here);
         for (auto* number : {&here.epoch, &here.tick}) {
           ++*number;
           states.write(here);
           --*number;
         }
         ++here.run;
         states.write(here);
         here.kind = static_cast<wire::StateKind>(9);
         states.write(here);
       }},
      {"silence", {}}};
  for (const auto& [name, lie] : lies) {
    liar.tell(lie);
    const std::string saved = run.done({"save", file});
    EXPECT_NE(saved.find("'swarm'"), std::string::npos) << name << ": " << saved;
    run.done({"step", "3"});
    const SessionSnapshot snapshot = session::read_snapshot(file);
    ASSERT_EQ(snapshot.controllers.size(), 2u) << name;
    EXPECT_FALSE(snapshot.controllers[0]) << name;
    EXPECT_TRUE(snapshot.controllers[1] && snapshot.controllers[1]->bytes.size() == sizeof(double)) << name;
  }
  run.done({"shutdown"});
  const auto rejected = events_of(run.finish(), "rejected");
  EXPECT_TRUE(std::ranges::any_of(rejected, [](const auto& event) {
    const std::string text = event["text"];
    return text.starts_with("malformed") && text.find("liar") != std::string::npos;
  })) << rejected;
}

}  // namespace
}  // namespace cohort::test
