// SPDX-License-Identifier: Apache-2.0

// Controllers that experiments configure without code.

#include <gtest/gtest.h>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/hosting/plugin_loader.hpp"

namespace cohort {
namespace {

class DeclaredController : public testing::Test {
 protected:
  void start(const std::string& controller, std::vector<wire::Parameter> parameters) {
    host_.reset();
    plugin_.emplace(COHORT_BUILD_DIR "/lib/controllers/" + controller + ".so", std::vector<std::filesystem::path>());
    host_.emplace(plugin_->plugin());
    wire::Admit admit;
    admit.teams = {{"other", "none", {}}, {"team", controller, std::move(parameters)}};
    admit.robots = {{.robot = 0, .name = "r0", .team = 1}};
    host_->start(admit, descriptions_);
  }
  std::string failure_of(const std::string& controller, std::vector<wire::Parameter> parameters) {
    try {
      start(controller, std::move(parameters));
    } catch (const ControllerFailure& failure) {
      return failure.what();
    }
    return "";
  }
  std::vector<double> answer(const std::vector<double>& observation) {
    const std::vector<std::uint32_t> robots{0};
    const auto values = host_->answer({.robots = robots, .values = observation});
    return {values.begin(), values.end()};
  }

  const std::vector<wire::RobotDescription> descriptions_{
      {0,
       "cart",
       {{"eye/0/reading", "1"}, {"eye/1/reading", "1"}, {"ground.colour/0/rgb", "1", 3}},
       {{"wheel/left/velocity", "m/s", 1, -1, 1, 0},
        {"wheel/right/velocity", "m/s", 1, -1, 1, 0},
        {"lamp/0/rgb", "1", 3, 0, 1, 0.5}}}};
  std::optional<LoadedPlugin> plugin_;
  std::optional<ControllerHost> host_;
};

TEST_F(DeclaredController, ConstantSendsItsValuesAndKeepsTheRestNeutral) {
  start("constant", {{"wheel/right/velocity", {"0.25"}}, {"lamp/0/rgb", {"1", "0", "0.1"}}});
  EXPECT_EQ(answer({9, 9, 9, 9, 9}), (std::vector<double>{0, 0.25, 1, 0, 0.1}));
}

TEST_F(DeclaredController, ConstantRefusesValuesOutsideOfTheChannelsRange) {
  EXPECT_NE(failure_of("constant", {{"wheel/right/velocity", {"1.5"}}}).find("at most 1"), std::string::npos);
  EXPECT_NE(failure_of("constant", {{"lamp/0/rgb", {"1"}}}).find("expected 3 values, not 1"), std::string::npos);
  EXPECT_NE(failure_of("constant", {{"weel/right/velocity", {"1"}}}).find("the nearest are wheel/right/velocity"),
            std::string::npos);
}

TEST_F(DeclaredController, BraitenbergSumsWeightedObservationsWithinTheRange) {
  start("braitenberg", {{"wheel/left/velocity.bias", {"0.5"}},
                        {"wheel/left/velocity.eye/*/reading", {"-1", "0.5"}},
                        {"wheel/right/velocity.eye/1/reading", {"2"}},
                        {"wheel/right/velocity.ground.colour/0/rgb", {"0", "0", "1"}},
                        {"lamp/0/rgb.ground.colour/*/rgb", {"0.125"}}});
  EXPECT_EQ(answer({0.25, 0.5, 1, 2, -0.5}), (std::vector<double>{0.5, 0.5, 0.3125, 0.3125, 0.3125}));
  EXPECT_EQ(answer({9, 9, 0, 0, 0})[0], -1.0);
  EXPECT_EQ(answer({9, 9, 0, 0, 0})[1], 1.0);
}

TEST_F(DeclaredController, BraitenbergExplainsWrongWeights) {
  const auto has = [&](std::vector<wire::Parameter> parameters, const char* text) {
    const std::string failure = failure_of("braitenberg", std::move(parameters));
    EXPECT_NE(failure.find(text), std::string::npos) << failure;
  };
  has({}, "no parameters given");
  has({{"wheel/left/velocity.eye/*/reading", {"1", "2", "3"}}}, "expected one weight or 2");
  has({{"wheel/left/velocity.ear/0/reading", {"1"}}}, "the nearest are eye/0/reading");
  has({{"wheel/left/velocty.bias", {"1"}}}, "the nearest are wheel/left/velocity");
  has({{"wheel/left/velocity", {"1"}}}, "expected 'bias' and weights");
  has({{"wheel/left/velocity.bias", {"fast"}}}, "expected a number, not 'fast'");
}

}  // namespace
}  // namespace cohort
