// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "server/description/model.hpp"
#include "server/parsing/model/model_places.hpp"

namespace cohort::parsing {

/// The bodies of a model whose links, joints and couplings have been read; a body is a set of links that these connect.
/// Most models have one.
class FreeBodies {
 public:
  explicit FreeBodies(const Model& model);

  std::size_t count() const { return count_; }
  /// Returns the parts of one body; the whole model if there is only one. Bodies after the first are named after their
  /// root links.
  Model body(std::size_t number, const Model& model) const;
  /// Returns the device scopes of each body. Elements that name a link or a joint of another body belong to that body.
  /// A scope without devices belongs to the first body.
  std::vector<std::vector<DeviceScope>> scopes(const Model& model, const std::vector<DeviceScope>& scopes) const;
  /// Returns the sensors of one body.
  std::vector<SensorPlace> sensors_of(std::size_t number, const Model& model,
                                      const std::vector<SensorPlace>& sensors) const;

 private:
  std::optional<std::size_t> body_of_name(const Model& model, const std::string& name) const;
  std::size_t body_of_element(const Model& model, const Element* element, const std::string& prefix) const;

  std::vector<std::size_t> body_of_link_;
  std::size_t count_ = 0;
};

}  // namespace cohort::parsing
