// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace cohort::description {

/// An error in a file that a user wrote.
struct Problem {
  std::filesystem::path file;
  int line = 0;         ///< from 1; 0 if not known
  std::string element;  ///< such as `world/model[box_3]/link/inertial/mass` or `teams[0].controller`; may be empty
  std::string message;  ///< description of the error and of the expected value

  /// `FILE:LINE: ELEMENT: MESSAGE`
  std::string text() const;
};

/// An error in a world or an experiment; `what()` has a line for each problem. Problems are ordered by file and line,
/// without duplicates.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

}  // namespace cohort::description
