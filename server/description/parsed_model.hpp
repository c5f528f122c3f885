#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/description/model.hpp"

namespace cohort::description {

/// A model that was read from a text of its own, apart from any world.
struct ParsedModel {
  std::string text;  ///< in SDF, URDF or YAML
  Model model;
  std::vector<std::string> materials;  ///< that `model` refers to by their places here; the first has no name
  std::vector<Problem> warnings{};     ///< what the text asks for and is not simulated
};
using ParsedModelPtr = std::shared_ptr<const ParsedModel>;

/// Reads the text of a model. Throws std::invalid_argument with all that is wrong with it. Callable from any thread.
using ModelReader = std::function<ParsedModelPtr(const std::string& text)>;

}  // namespace cohort::description
