#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace cohort {

/// One of a team's `parameters` in the experiment file. Keys of nested maps are joined by '.': `wheel: {radius: 0.02}`
/// is `wheel.radius`.
struct Parameter {
  std::string name;
  std::vector<std::string> values;  ///< one, or those of a list, as they are written
};

/// A parameter that is missing, not what it should be, or unknown to the controller. `what()` names it.
class ParameterError : public std::runtime_error {
 public:
  ParameterError(std::string name, const std::string& message);
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

/// What the experiment file gives a controller. Every parameter has to be asked for in `Controller::start`: one that
/// is left over is a mistake of the file, and the controller does not start. One thread at a time.
class Parameters {
 public:
  Parameters() = default;
  explicit Parameters(std::vector<Parameter> parameters);

  /// In the order of the file. Does not count as asking.
  const std::vector<Parameter>& all() const { return parameters_; }
  /// Whether the file has it. Counts as asking.
  bool has(std::string_view name) const { return find(name) != nullptr; }

  /// A finite number; `fallback` if the file has none of that name. Throws ParameterError if it is something else.
  double real(std::string_view name, double fallback) const;
  /// As above; throws ParameterError also if the file has none.
  double real(std::string_view name) const;
  /// A list of finite numbers, or one alone. Empty if the file has none.
  std::vector<double> reals(std::string_view name) const;
  /// `true` or `false`.
  bool flag(std::string_view name, bool fallback) const;
  /// A single text.
  std::string text(std::string_view name, std::string_view fallback) const;
  std::string text(std::string_view name) const;
  std::vector<std::string> texts(std::string_view name) const;

  /// Throws ParameterError for the first one that was never asked for.
  void check_all_were_asked_for() const;

 private:
  const Parameter* find(std::string_view name) const;
  const Parameter& get(std::string_view name) const;

  std::vector<Parameter> parameters_;
  mutable std::vector<std::string> asked_;  // for `check_all_were_asked_for`; changes nothing else
};

}  // namespace cohort
