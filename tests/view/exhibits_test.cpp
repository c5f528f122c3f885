// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "server/description/experiment.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/simulation/simulation.hpp"
#include "tests/view/viewing.hpp"

namespace cohort::view {
namespace {

// Tests how the page shows each kind of thing, in a world that has one of each.
class WhatThePageShows : public InABrowser {
 protected:
  // Records an experiment and drives the page of its recording.
  void show(const std::string& experiment, const std::string& seconds, const std::string& scenario,
            const std::vector<std::string>& more = {}) {
    const std::filesystem::path recording = scratch / "run.mcap";
    test::run_experiment(experiment, {"--controllers", "inprocess", "--duration", seconds, "--record", recording,
                                      "--record-snapshots", "1"});
    const View view({recording});
    std::vector<std::string> arguments = {scenario, view.address()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_script("exhibits.mjs", arguments);
  }
  void show_exhibits(const std::string& scenario) {
    show(COHORT_SOURCE_DIR "/tests/view/exhibits/experiment.yaml", "4", scenario);
  }
  test::ScratchFolder scratch;
};

TEST_F(WhatThePageShows, IsFilmed) { show_exhibits("films"); }
TEST_F(WhatThePageShows, IsHeardWithItsFrequencyAndFromWhereItIs) { show_exhibits("sounds"); }
TEST_F(WhatThePageShows, IsSeenFromWhereverPeopleFly) { show_exhibits("moves_camera"); }
TEST_F(WhatThePageShows, LooksAgainAsItWasLeft) { show_exhibits("keeps_looks"); }
TEST_F(WhatThePageShows, HasNamesTrailsContactsGripsAndRaysWhereTheyAre) { show_exhibits("draws_overlays"); }
TEST_F(WhatThePageShows, CastsShadowsAndHasTheColoursOfMeshes) { show_exhibits("draws_shapes"); }

TEST_F(WhatThePageShows, HasTheTexturesOfVisualsAndMeshes) {
  show(COHORT_SOURCE_DIR "/tests/view/exhibits/textures.yaml", "0.1", "draws_textures");
}

TEST_F(WhatThePageShows, HasHillsAsHighAsTheirGround) {
  const std::string hills = COHORT_SOURCE_DIR "/worlds/experiments/rough_terrain.yaml";
  const description::Experiment experiment = parsing::read_experiment(hills);
  const Simulation simulation(experiment, 1);
  const geometry::Scene& solids = simulation.world().scene();
  nlohmann::json places = nlohmann::json::array();
  for (const double x : {-1.31, -0.47, 0.22, 0.93, 1.62})
    for (const double y : {-1.53, -0.18, 0.71, 1.44}) {
      const auto hit = solids.cast_ray({x, y, 10.0}, -Eigen::Vector3d::UnitZ(), 20.0);
      if (hit && geometry::is_ground(solids.solid(hit->solid).shape())) places.push_back({x, y, 10.0 - hit->distance});
    }
  ASSERT_GT(places.size(), 10u);
  test::write_file(scratch / "heights.json", places.dump());
  show(hills, "0.1", "draws_hills", {scratch / "heights.json"});
}

}  // namespace
}  // namespace cohort::view
