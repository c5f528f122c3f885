// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace cohort {

/// A parameter under a team's key `parameters` in the experiment file. Keys of nested maps are joined by '.': `wheel:
/// {radius: 0.02}` is `wheel.radius`.
struct Parameter {
  std::string name;
  std::vector<std::string> values;  ///< the values of a list, or a single value, as written in the file
};

/// The error thrown if a parameter is missing, has the wrong type or is unknown to the controller. `what()` names the
/// parameter.
class ParameterError : public std::runtime_error {
 public:
  ParameterError(std::string name, const std::string& message);
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

/// The parameters of a controller in the experiment file. Read every parameter in `Controller::start`: a parameter that
/// is not read is reported as an error in the file, and the controller does not start. In a program with a loop of its
/// own, this is an error only if the program has read another parameter of the robot. Use an object on one thread at a
/// time.
class Parameters {
 public:
  Parameters() = default;
  explicit Parameters(std::vector<Parameter> parameters);

  /// Returns all parameters, in the order of the file. Does not mark them as read.
  const std::vector<Parameter>& all() const { return parameters_; }
  /// Returns true if the file contains the parameter. Marks it as read.
  bool has(std::string_view name) const { return find(name) != nullptr; }

  /// Returns a finite number, or `fallback` if the parameter is missing. Throws ParameterError if the parameter is not
  /// a finite number.
  double real(std::string_view name, double fallback) const;
  /// Returns a finite number. Throws ParameterError if the parameter is missing or not a finite number.
  double real(std::string_view name) const;
  /// Returns a list of finite numbers: one element for a single number, none if the parameter is missing.
  std::vector<double> reals(std::string_view name) const;
  /// Returns a flag, written as `true` or `false`, or `fallback` if the parameter is missing.
  bool flag(std::string_view name, bool fallback) const;
  /// Returns one string.
  std::string text(std::string_view name, std::string_view fallback) const;
  std::string text(std::string_view name) const;
  std::vector<std::string> texts(std::string_view name) const;

  /// Throws ParameterError for the first parameter that has not been read.
  void check_all_were_asked_for() const;
  /// Returns true if no parameter has been requested, not even a missing one.
  bool none_was_asked_for() const { return asked_.empty(); }

 private:
  const Parameter* find(std::string_view name) const;
  const Parameter& get(std::string_view name) const;

  std::vector<Parameter> parameters_;
  mutable std::vector<std::string> asked_;  // requested names, also of missing parameters
};

}  // namespace cohort
