// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/description/model.hpp"

namespace cohort::description {

/// A model that was read from a separate text, independently of any world.
struct ParsedModel {
  std::string text;  ///< in SDF, URDF or YAML
  Model model;
  std::vector<std::string> materials;  ///< to which `model` refers by index; the first has no name
  std::vector<Problem> warnings{};     ///< features of the text that are not simulated
};
using ParsedModelPtr = std::shared_ptr<const ParsedModel>;

/// The error that the text of a model cannot be read, with all problems of the text.
class ModelTextError : public std::invalid_argument {
 public:
  ModelTextError(const std::string& text, bool lacks) : std::invalid_argument(text), lacks_file(lacks) {}
  bool lacks_file;  ///< a file to which the text refers is not there
};

/// Reads the text of a model. Throws ModelTextError. Callable from any thread.
using ModelReader = std::function<ParsedModelPtr(const std::string& text)>;

}  // namespace cohort::description
