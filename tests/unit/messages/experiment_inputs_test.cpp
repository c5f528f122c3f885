// SPDX-License-Identifier: Apache-2.0
#include "server/messages/experiment_inputs.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace cohort::messages {
namespace {

using namespace std::chrono_literals;
using cohort::ExperimentFiles;

TEST(ExperimentFiles, ThatAreInvalidAreRefused) {
  const ExperimentFiles right{.seed = 1,
                              .duration = 1ns,
                              .experiment = "a.yaml",
                              .working_folder = "/here",
                              .model_path = {},
                              .last_model_folders = {"relative"},
                              .folders = {"/here"},
                              .files = {{"/here/a.yaml", "\1\2"}, {"/here/w.sdf", {"\0\xff", 2}}}};
  EXPECT_EQ(kept_files(right).files[1].bytes, std::string("\0\xff", 2));
  const std::vector<void (*)(ExperimentFiles&)> wrong = {
      [](ExperimentFiles& files) { files.experiment.clear(); },
      [](ExperimentFiles& files) { files.duration = -1ns; },
      [](ExperimentFiles& files) { files.working_folder = "here"; },
      [](ExperimentFiles& files) { files.folders = {""}; },
      [](ExperimentFiles& files) { files.files[0].path = "a.yaml"; },
      [](ExperimentFiles& files) { files.files[1].path = files.files[0].path; },
      [](ExperimentFiles& files) { std::swap(files.files[0], files.files[1]); },
  };
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    ExperimentFiles files = right;
    wrong[i](files);
    EXPECT_THROW(kept_files(files), std::invalid_argument) << i;
  }
}

}  // namespace
}  // namespace cohort::messages
