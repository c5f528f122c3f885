#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "server/description/model.hpp"
#include "server/parsing/model/model_places.hpp"

namespace cohort::parsing {

/// The bodies of a model whose links and joints are read: each is what joints connect. Mostly there is one.
class FreeBodies {
 public:
  explicit FreeBodies(const Model& model);

  std::size_t count() const { return count_; }
  /// The parts of one body; all of the model if there is no other. Those after the first are called after their root.
  Model body(std::size_t number, const Model& model) const;
  /// Where the devices of each body stand: what names a link or a joint of another one is left to that. A scope without
  /// devices is one of the first body.
  std::vector<std::vector<DeviceScope>> scopes(const Model& model, const std::vector<DeviceScope>& scopes) const;
  /// The sensors of one body.
  std::vector<SensorPlace> sensors_of(std::size_t number, const Model& model,
                                      const std::vector<SensorPlace>& sensors) const;

 private:
  std::optional<std::size_t> body_of_name(const Model& model, const std::string& name) const;
  std::size_t body_of_element(const Model& model, const sdf::ElementPtr& element, const std::string& prefix) const;

  std::vector<std::size_t> body_of_link_;
  std::size_t count_ = 0;
};

}  // namespace cohort::parsing
