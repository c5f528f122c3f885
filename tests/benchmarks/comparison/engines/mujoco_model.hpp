// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

namespace cohort::bench {

struct MujocoDelete {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using MujocoModel = std::unique_ptr<mjModel, MujocoDelete>;
using MujocoData = std::unique_ptr<mjData, MujocoDelete>;

/// Compiles a model in MuJoCo's XML. Throws std::runtime_error if it is invalid.
MujocoModel compile_mujoco(const std::string& text);

/// Advances by a step. Throws std::runtime_error if MuJoCo has warned, because its results are then invalid.
void step_mujoco(const mjModel& model, mjData& data);

}  // namespace cohort::bench
