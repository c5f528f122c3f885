#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/process.hpp"

namespace cohort::view {

/// A test that drives `cohort view` by a script: browser.mjs in a browser without a window, client.mjs without one.
class Viewing : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::string(COHORT_NODE).empty() || std::string(COHORT_NPM).empty())
      GTEST_SKIP() << "there is no node or npm: tools/install-packages tools/packages-node.txt";
    std::filesystem::create_directories(folder);
    const int lock = open((folder / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    flock(lock, LOCK_EX);
    install();
    close(lock);
  }

  static bool has_browser() { return !std::string(COHORT_CHROMIUM).empty(); }

  /// Starts a script, whose arguments these are.
  static testing::Process start_script(const std::string& script, std::vector<std::string> arguments) {
    return testing::Process(command(script, std::move(arguments)), environment());
  }
  /// Runs it to its end; it says itself what is wrong.
  static void run_script(const std::string& script, std::vector<std::string> arguments) {
    const testing::Ended ended = testing::run_to_end(command(script, std::move(arguments)), environment());
    EXPECT_EQ(ended.exit_code, 0) << ended.out << ended.err;
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
    testing::Process& process() { return process_; }

   private:
    static std::vector<std::string> with_port(std::vector<std::string> arguments) {
      std::vector<std::string> command = {testing::cohort_program(), "view"};
      command.insert(command.end(), arguments.begin(), arguments.end());
      if (std::ranges::find(arguments, "--port") == arguments.end()) command.insert(command.end(), {"--port", "0"});
      return command;
    }
    testing::Process process_;
    std::string address_;
  };

 private:
  static std::vector<std::string> command(const std::string& script, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {COHORT_NODE, (folder / script).string()});
    return arguments;
  }
  static testing::Process::Environment environment() { return {{"COHORT_CHROMIUM", COHORT_CHROMIUM}}; }

  static void install() {
    const std::filesystem::path source = COHORT_SOURCE_DIR "/tests/view";
    for (const char* name : {"package.json", "package-lock.json", "browser.mjs", "client.mjs"})
      std::filesystem::copy_file(source / name, folder / name, std::filesystem::copy_options::overwrite_existing);
    const std::string wanted = testing::read_file(folder / "package-lock.json");
    if (testing::read_file(folder / "installed") == wanted) return;
    const testing::Ended ended =
        testing::run_to_end({COHORT_NPM, "ci", "--no-audit", "--no-fund", "--prefix", folder.string()});
    ASSERT_EQ(ended.exit_code, 0) << ended.out << ended.err;
    testing::write_file(folder / "installed", wanted);
  }

  inline static const std::filesystem::path folder = COHORT_NODE_FOLDER;
};

}  // namespace cohort::view
