// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/python/hosting/python_objects.hpp"

namespace cohort::python {

/// The handler for a Python object that drives all robots of this process, a `cohort._hosting.TeamAdapter`. The arrays
/// [robot, value] of that object refer to the memory of this one.
class PythonTeam final : public FrameHandler {
 public:
  /// `make_adapter`, which is called without arguments, must outlive this object. `name` is the name of the class, and
  /// identifies its saved states.
  PythonTeam(PyObject* make_adapter, std::string name);
  PythonTeam(const PythonTeam&) = delete;
  PythonTeam& operator=(const PythonTeam&) = delete;
  ~PythonTeam() override;

  void start(const wire::Admit& admit, std::span<const wire::RobotDescription> descriptions) override;
  std::span<const double> answer(const wire::Observation& frame) override;
  std::vector<RobotState> save() const override;
  std::vector<std::string> load(std::span<const RobotState> states) override;

 private:
  PyObject* make_adapter_;
  const std::string name_;
  Owned adapter_;
  std::vector<std::uint32_t> robots_;  // in ascending order of ids
  std::size_t observation_size_ = 0;   // size for one robot
  std::vector<double> neutral_;        // values of one robot
  std::vector<CommandChannel> command_channels_;
  SharedValues observations_;  // [robot, value]
  SharedValues commands_;
  std::vector<double> values_;
};

/// Returns a factory that drives robots with controllers from `maker`: one per robot, or one for all. `maker` is an
/// object of `cohort._hosting.Maker` that must outlive all controllers.
ControllerKind kind_of_maker(PyObject* maker);

}  // namespace cohort::python
