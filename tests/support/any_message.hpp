// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include "idl/messages/cdr.hpp"

namespace cohort::test {

/// Fills messages with random values, the same in each run. A float represents all of them exactly.
class AnyMessage {
 public:
  template <class Value>
  void fill(Value& value) {
    if constexpr (messages::RosMessage<Value>) {
      std::apply([&](const auto&... fields) { (fill(value.*fields.member), ...); }, Value::fields);
    } else if constexpr (std::is_same_v<Value, bool>) {
      value = random_() % 2 == 1;
    } else if constexpr (std::is_floating_point_v<Value>) {
      value = static_cast<Value>(static_cast<double>(random_() % 1'000'000) / 1024.0 - 300.0);
    } else {
      value = static_cast<Value>(random_());
    }
  }
  void fill(std::string& text) { text.assign(random_() % 6, 'x'); }
  template <class Value>
  void fill(std::vector<Value>& values) {
    values.resize(random_() % 5);
    for (Value& value : values) fill(value);
  }
  template <class Value, std::size_t count>
  void fill(std::array<Value, count>& values) {
    for (Value& value : values) fill(value);
  }

 private:
  std::mt19937_64 random_{7};
};

}  // namespace cohort::test
