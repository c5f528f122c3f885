// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/python/hosting/python_controller.hpp"

#include <algorithm>
#include <string>

namespace cohort::python {

PythonController::PythonController(PyObject* make_adapter) {
  const Lock lock;
  adapter_ = checked(PyObject_CallNoArgs(make_adapter));
}

PythonController::~PythonController() {
  const Lock lock;
  step_ = Owned();
  adapter_ = Owned();
  observation_ = SharedValues();
  command_ = SharedValues();
}

void PythonController::start(const Start& start) {
  const Lock lock;
  observation_.resize(size_of(start.observation_channels));
  command_.resize(size_of(start.command_channels));
  neutral_ = neutral_of(start.command_channels);
  command_channels_ = command_channels_of(start.command_channels);
  const Owned facts = facts_of(start);
  const Owned observation = observation_.view(false);
  const Owned command = command_.view(true);
  const Owned asked =
      checked(PyObject_CallMethod(adapter_.get(), "start", "OOO", facts.get(), observation.get(), command.get()));
  note_asked(start.parameters, asked.get());
  step_ = checked(PyObject_GetAttrString(adapter_.get(), "step"));
}

void PythonController::step(const Observation& observation, Command& command) {
  const Lock lock;
  std::ranges::copy(observation.values({0, static_cast<std::uint32_t>(observation_.size())}),
                    observation_.values().begin());
  std::ranges::copy(neutral_, command_.values().begin());
  checked(PyObject_CallFunction(step_.get(), "KL", static_cast<unsigned long long>(observation.tick()),
                                static_cast<long long>(observation.time().count())));
  set_all(command, command_channels_, command_.values());
}

void PythonController::save(StateWriter& state) const {
  const Lock lock;
  write_state(state, checked(PyObject_CallMethod(adapter_.get(), "save", nullptr)).get());
}

void PythonController::load(StateReader& state) {
  const Lock lock;
  std::string bytes;
  state.read(bytes);
  checked(PyObject_CallMethod(adapter_.get(), "load", "y#", bytes.data(), static_cast<Py_ssize_t>(bytes.size())));
}

}  // namespace cohort::python
