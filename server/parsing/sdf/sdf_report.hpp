// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/sdf/sdf_files.hpp"

namespace cohort::parsing {

/// Collects problems and warnings of checks of SDF elements.
class SdfReport {
 public:
  SdfReport(const SdfFiles& files, std::vector<Problem>& problems, std::vector<Problem>& warnings)
      : files_(files), problems_(problems), warnings_(warnings) {}

  /// `child` is added to the path of the element, for a missing child.
  void problem(const Element* element, std::string message, std::string_view child = {}) const;
  /// Does the same as `problem`, and throws InputError with all problems so far, if continuing would cost too much.
  [[noreturn]] void stop(const Element* element, std::string message) const;
  void warning(const Element* element, std::string message) const;
  /// Adds a warning once for each file.
  void warning_once(const Element* element, const std::string& message) const;
  /// Returns whether the file of the element was not written for Cohort.
  static bool is_foreign(const Element* element) { return element->node().file->is_foreign; }
  /// Reports a problem of a file written for Cohort. In a file from another source it is a warning, in which `remedy`
  /// is the repair. Returns true if the caller should repair it.
  bool flaw(const Element* element, const std::string& message, const std::string& remedy) const;
  /// Returns the number of problems so far.
  std::size_t count() const { return problems_.size(); }
  /// Turns problems from `count` on into warnings, as in a file from another source; `remedy` is the repair. Returns
  /// true if there are any.
  bool forgive(const Element* element, std::size_t count, const std::string& remedy) const;
  /// Returns the position of an element, without a message.
  Problem place_of(const Element* element) const;
  void problem(Problem problem) const { problems_.push_back(std::move(problem)); }

 private:
  const SdfFiles& files_;
  std::vector<Problem>& problems_;
  std::vector<Problem>& warnings_;
};

}  // namespace cohort::parsing
