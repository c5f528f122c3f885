// SPDX-License-Identifier: Apache-2.0
#include "server/description/model.hpp"

namespace cohort::description {

Model::Model() = default;
Model::Model(const Model& other) = default;
Model::Model(Model&& other) noexcept = default;
Model& Model::operator=(const Model& other) = default;
Model& Model::operator=(Model&& other) noexcept = default;
Model::~Model() = default;

}  // namespace cohort::description
