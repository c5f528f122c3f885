// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "tests/support/node_folder.hpp"

namespace cohort::view {

/// A test that drives `cohort view` by a script: browser.mjs and exhibits.mjs in a browser without a window, client.mjs
/// without one.
class Viewing : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* script : {"in_page.mjs", "browser.mjs", "exhibits.mjs", "hands.mjs", "guest.mjs", "html.mjs",
                               "layout.mjs", "textures.mjs", "client.mjs"})
      if (const auto why_not = scripts.prepare(script)) GTEST_SKIP() << *why_not;
  }

  static bool has_browser() { return !std::string(COHORT_CHROMIUM).empty(); }

  /// Starts a script, whose arguments these are.
  static test::Process start_script(const std::string& script, std::vector<std::string> arguments) {
    return test::Process(scripts.command(script, std::move(arguments)), environment());
  }
  /// Runs it to its end, however long all of it takes; it says itself what is wrong, and what it waits for in vain.
  static void run_script(const std::string& name, std::vector<std::string> arguments) {
    test::Process script = start_script(name, std::move(arguments));
    while (script.running()) script.wait_for_exit();
    EXPECT_EQ(script.wait_for_exit(), 0) << script.output();
  }

  /// `cohort view` with these arguments, on a port of its own; the address of its page.
  class View {
   public:
    explicit View(std::vector<std::string> arguments) : process_(with_port(std::move(arguments))) {
      EXPECT_TRUE(process_.wait_for_output("http://")) << process_.output();
      const std::string output = process_.output();
      const std::size_t begin = output.find("http://");
      address_ = output.substr(begin, output.find('\n', begin) - begin);
    }
    const std::string& address() const { return address_; }
    std::string port() const {
      const std::size_t begin = address_.rfind(':') + 1;
      return address_.substr(begin, address_.find('/', begin) - begin);
    }
    test::Process& process() { return process_; }

   private:
    static std::vector<std::string> with_port(std::vector<std::string> arguments) {
      std::vector<std::string> command = {test::cohort_program(), "view"};
      command.insert(command.end(), arguments.begin(), arguments.end());
      if (std::ranges::find(arguments, "--port") == arguments.end()) command.insert(command.end(), {"--port", "0"});
      return command;
    }
    test::Process process_;
    std::string address_;
  };

 private:
  // A script is less patient than we are, to say itself what did not come.
  static test::Process::Environment environment() {
    const auto theirs = std::chrono::milliseconds(test::patience) / 2;
    return {{"COHORT_CHROMIUM", COHORT_CHROMIUM}, {"COHORT_PATIENCE", std::to_string(theirs.count())}};
  }

  inline static const test::NodeFolder scripts{COHORT_NODE, COHORT_NPM, COHORT_SOURCE_DIR "/tests/view",
                                               COHORT_NODE_FOLDER};
};

/// A test that needs a browser.
class InABrowser : public Viewing {
 protected:
  void SetUp() override {
    Viewing::SetUp();
    if (!has_browser() && !IsSkipped())
      GTEST_SKIP() << "there is no chromium: tools/dev/install-packages tools/dev/packages-browser.txt";
  }
};

}  // namespace cohort::view
