// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/engines/mujoco_model.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace cohort::bench {
namespace {

// Replaces MuJoCo's default handlers, which write a file and wait for a key. An error is fatal.
void take_over_messages() {
  mju_user_error = [](const char* message) {
    std::fprintf(stderr, "cohort: error: MuJoCo: %s\n", message);
    std::_Exit(1);
  };
  mju_user_warning = [](const char*) {};  // step_mujoco checks for warnings
}

}  // namespace

MujocoModel compile_mujoco(const std::string& text) {
  take_over_messages();
  const char* const file = "bench.xml";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  const auto size = static_cast<int>(text.size());
#if mjVERSION_HEADER < 300  // Debian's 2.2
  const bool is_taken = mj_makeEmptyFileVFS(files.get(), file, size) == 0;
  if (is_taken) std::memcpy(files->filedata[mj_findFileVFS(files.get(), file)], text.data(), text.size());
#else
  const bool is_taken = mj_addBufferVFS(files.get(), file, text.data(), size) == 0;
#endif
  if (!is_taken) throw std::runtime_error("MuJoCo rejected the model");
  std::string message(1000, '\0');
  MujocoModel model(mj_loadXML(file, files.get(), message.data(), static_cast<int>(message.size())));
  mj_deleteVFS(files.get());
  if (!model) throw std::runtime_error("MuJoCo: " + message.substr(0, message.find('\0')));
  return model;
}

void step_mujoco(const mjModel& model, mjData& data) {
  mj_step(&model, &data);
  for (int i = 0; i < mjNWARNING; ++i) {
    const mjWarningStat& warning = data.warning[i];
    if (warning.number > 0) throw std::runtime_error(std::string("MuJoCo: ") + mju_warningText(i, warning.lastinfo));
  }
}

}  // namespace cohort::bench
