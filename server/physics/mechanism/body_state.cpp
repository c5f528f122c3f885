// SPDX-License-Identifier: Apache-2.0
#include "server/physics/mechanism/body_state.hpp"

#include <algorithm>
#include <utility>

namespace cohort::physics {

BodyState::BodyState(const Mechanism& mechanism) : dofs_(mechanism.dof_count()) {
  own_.resize(7 + static_cast<std::size_t>(dofs_) + mechanism.zero_coordinates().size());
  memory_.reference = own_.data();
  memory_.rotation = own_.data() + 3;
  memory_.velocities = own_.data() + 7;
  double* const coordinates = memory_.velocities + dofs_;
  std::copy(mechanism.zero_coordinates().begin(), mechanism.zero_coordinates().end(), coordinates);
  for (std::size_t i = 0; i < mechanism.zero_coordinates().size(); ++i) memory_.coordinates.push_back(coordinates + i);
}

BodyState::BodyState(const Mechanism& mechanism, Memory memory)
    : dofs_(mechanism.dof_count()), memory_(std::move(memory)) {}

Eigen::Quaterniond BodyState::root_rotation() const {
  const Eigen::Quaterniond rotation(memory_.rotation);
  return memory_.is_from_world ? rotation.conjugate() : rotation;
}

void BodyState::set_root_rotation(const Eigen::Quaterniond& rotation) {
  Eigen::Map<Eigen::Quaterniond>(memory_.rotation) = memory_.is_from_world ? rotation.conjugate() : rotation;
}

}  // namespace cohort::physics
