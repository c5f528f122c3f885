#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace cohort::description {

/// One thing wrong in a file that a user wrote.
struct Problem {
  std::filesystem::path file;
  int line = 0;         ///< from 1; 0 if not known
  std::string element;  ///< such as `world/model[box_3]/link/inertial/mass` or `teams[0].controller`; may be empty
  std::string message;  ///< what is wrong and what was expected

  /// `FILE:LINE: ELEMENT: MESSAGE`
  std::string text() const;
};

/// A world or experiment that cannot be used; `what()` has a line for each problem. Problems are ordered by file and
/// line, and the same one is kept once.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

}  // namespace cohort::description
