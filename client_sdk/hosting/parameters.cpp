// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/include/cohort/parameters.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "client_sdk/hosting/nearest.hpp"

namespace cohort {
namespace {

std::string quoted(const std::vector<std::string>& values) {
  if (values.size() == 1) return "'" + values.front() + "'";
  std::string list = "[";
  for (std::size_t i = 0; i < values.size(); ++i) list += (i == 0 ? "" : ", ") + values[i];
  return list + "]";
}

ParameterError unexpected(const Parameter& parameter, const std::string& expected) {
  return {parameter.name, "expected " + expected + ", not " + quoted(parameter.values)};
}

double number_of(const Parameter& parameter, const std::string& text, const char* expected) {
  double number = 0.0;
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + (has_plus ? 1 : 0), end, number);
  if (error != std::errc() || rest != end || !std::isfinite(number)) throw unexpected(parameter, expected);
  return number;
}

const std::string& single(const Parameter& parameter, const char* expected) {
  if (parameter.values.size() != 1) throw unexpected(parameter, expected);
  return parameter.values.front();
}

}  // namespace

ParameterError::ParameterError(std::string name, const std::string& message)
    : std::runtime_error("parameter '" + name + "': " + message), name_(std::move(name)) {}

Parameters::Parameters(std::vector<Parameter> parameters) : parameters_(std::move(parameters)) {}

double Parameters::real(std::string_view name, double fallback) const { return has(name) ? real(name) : fallback; }

double Parameters::real(std::string_view name) const {
  constexpr const char* expected = "a number";
  const Parameter& parameter = get(name);
  return number_of(parameter, single(parameter, expected), expected);
}

std::vector<double> Parameters::reals(std::string_view name) const {
  std::vector<double> numbers;
  const Parameter* const parameter = find(name);
  if (parameter == nullptr) return numbers;
  for (const std::string& value : parameter->values)
    numbers.push_back(number_of(*parameter, value, "a number or a list of numbers"));
  return numbers;
}

bool Parameters::flag(std::string_view name, bool fallback) const {
  constexpr const char* expected = "true or false";
  const Parameter* const parameter = find(name);
  if (parameter == nullptr) return fallback;
  const std::string& value = single(*parameter, expected);
  if (value != "true" && value != "false") throw unexpected(*parameter, expected);
  return value == "true";
}

std::string Parameters::text(std::string_view name, std::string_view fallback) const {
  return has(name) ? text(name) : std::string(fallback);
}

std::string Parameters::text(std::string_view name) const { return single(get(name), "a single value"); }

std::vector<std::string> Parameters::texts(std::string_view name) const {
  const Parameter* const parameter = find(name);
  return parameter == nullptr ? std::vector<std::string>() : parameter->values;
}

void Parameters::check_all_were_asked_for() const {
  const auto left_over = std::find_if(parameters_.begin(), parameters_.end(), [&](const Parameter& parameter) {
    return std::find(asked_.begin(), asked_.end(), parameter.name) == asked_.end();
  });
  if (left_over == parameters_.end()) return;
  std::string message = "unknown parameter";
  if (asked_.empty()) throw ParameterError(left_over->name, message + "; the controller has no parameters");
  constexpr std::size_t shown = 3;
  message += "; the nearest are";
  const char* separator = " ";
  for (const std::string& name : nearest_names(left_over->name, asked_, shown)) {
    message += separator + name;
    separator = ", ";
  }
  throw ParameterError(left_over->name, message);
}

const Parameter* Parameters::find(std::string_view name) const {
  if (std::find(asked_.begin(), asked_.end(), name) == asked_.end()) asked_.emplace_back(name);
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [&](const Parameter& parameter) { return parameter.name == name; });
  return found == parameters_.end() ? nullptr : &*found;
}

const Parameter& Parameters::get(std::string_view name) const {
  const Parameter* const parameter = find(name);
  if (parameter == nullptr) throw ParameterError(std::string(name), "required by the controller, but not given");
  return *parameter;
}

}  // namespace cohort
