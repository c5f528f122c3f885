// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cohort/controller.hpp>
#include <vector>

#include "client_sdk/python/hosting/python_objects.hpp"

namespace cohort::python {

/// One robot's controller: an object of `cohort._hosting.Adapter`, which calls the user's class. Observations and
/// commands are NumPy arrays in memory that Python keeps as long as the arrays.
class PythonController final : public Controller {
 public:
  /// Calls `make_adapter` without arguments. Throws std::runtime_error with the Python exception.
  explicit PythonController(PyObject* make_adapter);
  PythonController(const PythonController&) = delete;
  PythonController& operator=(const PythonController&) = delete;
  ~PythonController() override;

  void start(const Start& start) override;
  void step(const Observation& observation, Command& command) override;
  void save(StateWriter& state) const override;
  void load(StateReader& state) override;

 private:
  Owned adapter_;
  Owned step_;  // its bound method
  SharedValues observation_;
  SharedValues command_;
  std::vector<double> neutral_;
  std::vector<CommandChannel> command_channels_;
};

}  // namespace cohort::python
