#pragma once

#include <sdf/Element.hh>
#include <string>
#include <string_view>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/sdf/sdf_files.hpp"

namespace cohort::parsing {

/// Where checks of SDF elements put what they find.
class SdfReport {
 public:
  SdfReport(const SdfFiles& files, std::vector<Problem>& problems, std::vector<Problem>& warnings)
      : files_(files), problems_(problems), warnings_(warnings) {}

  /// `child` is added to the path of the element, for a child that is not there.
  void problem(const sdf::ElementPtr& element, std::string message, std::string_view child = {}) const;
  /// As `problem`, and throws InputError with all problems so far: for what costs too much to go on after.
  [[noreturn]] void stop(const sdf::ElementPtr& element, std::string message) const;
  void warning(const sdf::ElementPtr& element, std::string message) const;
  /// Only the first time that it is said of a file.
  void warning_once(const sdf::ElementPtr& element, const std::string& message) const;
  /// Returns whether the file of the element was not written for Cohort.
  bool is_foreign(const sdf::ElementPtr& element) const { return files_.is_foreign(element); }
  /// What is wrong in a file of ours, and only told of one that was not written for Cohort, where `remedy` says what is
  /// done instead. True if it is to be remedied.
  bool flaw(const sdf::ElementPtr& element, const std::string& message, const std::string& remedy) const;
  /// How many problems there are so far.
  std::size_t count() const { return problems_.size(); }
  /// What is wrong from `count` on is only told, as it is in a file that was not written for Cohort; `remedy` says what
  /// is done instead. True if there is any.
  bool forgive(const sdf::ElementPtr& element, std::size_t count, const std::string& remedy) const;
  /// Where it is, without a message.
  Problem place_of(const sdf::ElementPtr& element) const;
  void problem(Problem problem) const { problems_.push_back(std::move(problem)); }

 private:
  const SdfFiles& files_;
  std::vector<Problem>& problems_;
  std::vector<Problem>& warnings_;
};

}  // namespace cohort::parsing
