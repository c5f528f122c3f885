// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/core/pose.hpp"
#include "server/parsing/keys/extensions.hpp"

namespace cohort::parsing {

/// The values of the keys of an extension, from a file of any kind.
class KeyValues {
 public:
  using Value = std::variant<std::string, double, std::uint64_t, bool, Eigen::Vector2d, Eigen::Vector3d, Pose>;

  /// Adds a value; the values of a repeated key are kept in order.
  void add(std::string_view key, Value value) { values_[std::string(key)].push_back(std::move(value)); }
  bool has(std::string_view key) const { return values_.contains(key); }

  const std::string& text(std::string_view key) const { return std::get<std::string>(first(key)); }
  double real(std::string_view key) const { return std::get<double>(first(key)); }
  std::uint64_t whole(std::string_view key) const { return std::get<std::uint64_t>(first(key)); }
  bool flag(std::string_view key) const { return std::get<bool>(first(key)); }
  const Eigen::Vector2d& point(std::string_view key) const { return std::get<Eigen::Vector2d>(first(key)); }
  const Eigen::Vector3d& vector(std::string_view key) const { return std::get<Eigen::Vector3d>(first(key)); }
  const Pose& pose(std::string_view key) const { return std::get<Pose>(first(key)); }
  template <class Type>
  const Type& get(std::string_view key) const {
    return std::get<Type>(first(key));
  }

  /// Adds `prefix` to the front of each text of the key.
  void prefix_texts(std::string_view key, const std::string& prefix);

  /// Returns the texts of a repeated key; none if it is absent.
  std::vector<std::string> texts(std::string_view key) const { return all<std::string>(key); }
  std::vector<Eigen::Vector3d> vectors(std::string_view key) const { return all<Eigen::Vector3d>(key); }
  template <class Type>
  std::vector<Type> all(std::string_view key) const {
    std::vector<Type> found;
    if (const auto values = values_.find(key); values != values_.end())
      for (const Value& value : values->second) found.push_back(std::get<Type>(value));
    return found;
  }

 private:
  const Value& first(std::string_view key) const { return values_.find(key)->second.front(); }

  std::map<std::string, std::vector<Value>, std::less<>> values_;
};

/// Returns the value; nothing if the text is invalid for this key.
std::optional<KeyValues::Value> parse_value(std::string_view text, const ExtensionKey& key);

/// Returns a description of valid values of this key, such as "a number > 0".
std::string expected(const ExtensionKey& key);

/// Returns the message for a text that is invalid for this key.
std::string why_wrong(std::string_view text, const ExtensionKey& key);

}  // namespace cohort::parsing
