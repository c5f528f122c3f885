// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/parsing/world/read_world.hpp"

namespace cohort::test {

/// Reads a model that refers to no files.
inline description::ParsedModelPtr model_of_text(const std::string& text) {
  return parsing::model_reader(nullptr, {})(text);
}

}  // namespace cohort::test
