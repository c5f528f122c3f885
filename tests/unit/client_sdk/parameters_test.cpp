// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cohort/parameters.hpp>
#include <functional>

namespace cohort {
namespace {

Parameters some() {
  return Parameters({{"gain", {"-1.5e-2"}},
                     {"plus", {"+2"}},
                     {"weights", {"1", "2", "3"}},
                     {"none", {}},
                     {"name", {"left"}},
                     {"invert", {"true"}},
                     {"text", {"1,5"}},
                     {"endless", {"inf"}}});
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "";
}

TEST(ParametersTest, ReturnsTheValueOfTheFileOrTheFallback) {
  const Parameters parameters = some();
  EXPECT_EQ(parameters.real("gain", 7.0), -0.015);
  EXPECT_EQ(parameters.real("plus"), 2.0);
  EXPECT_EQ(parameters.real("absent", 7.0), 7.0);
  EXPECT_EQ(parameters.reals("weights"), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(parameters.reals("gain"), std::vector<double>{-0.015});
  EXPECT_TRUE(parameters.reals("absent").empty());
  EXPECT_TRUE(parameters.reals("none").empty());
  EXPECT_EQ(parameters.text("name"), "left");
  EXPECT_EQ(parameters.text("absent", "right"), "right");
  EXPECT_EQ(parameters.texts("weights").size(), 3u);
  EXPECT_TRUE(parameters.flag("invert", false));
  EXPECT_TRUE(parameters.flag("absent", true));
}

TEST(ParametersTest, ReportsAnInvalidValue) {
  const Parameters parameters = some();
  EXPECT_EQ(message_of([&] { parameters.real("text"); }), "parameter 'text': expected a number, not '1,5'");
  EXPECT_EQ(message_of([&] { parameters.real("weights", 0.0); }),
            "parameter 'weights': expected a number, not [1, 2, 3]");
  EXPECT_EQ(message_of([&] { parameters.reals("endless"); }),
            "parameter 'endless': expected a number or a list of numbers, not 'inf'");
  EXPECT_EQ(message_of([&] { parameters.flag("gain", false); }),
            "parameter 'gain': expected true or false, not '-1.5e-2'");
  EXPECT_EQ(message_of([&] { parameters.text("none"); }), "parameter 'none': expected a single value, not []");
  EXPECT_EQ(message_of([&] { parameters.real("absent"); }),
            "parameter 'absent': required by the controller, but not given");
}

TEST(ParametersTest, ThatAreNotReadAreAnErrorOfTheFile) {
  const Parameters misspelt(std::vector{Parameter{"gian", {"1"}}});
  EXPECT_EQ(message_of([&] { misspelt.check_all_were_asked_for(); }),
            "parameter 'gian': unknown parameter; the controller has no parameters");
  misspelt.real("gain", 1.0);
  misspelt.real("speed", 1.0);
  EXPECT_EQ(message_of([&] { misspelt.check_all_were_asked_for(); }),
            "parameter 'gian': unknown parameter; the nearest are gain, speed");
  misspelt.has("gian");
  EXPECT_EQ(message_of([&] { misspelt.check_all_were_asked_for(); }), "");
}

}  // namespace
}  // namespace cohort
