#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "client_sdk/hosting/controller_host.hpp"
#include "client_sdk/python/hosting/python_objects.hpp"

namespace cohort::python {

/// One object of Python that drives all robots of this process: an adapter of `cohort._hosting.TeamAdapter`. Its arrays
/// [robot, value] show the memory of this object.
class PythonTeam final : public FrameHandler {
 public:
  /// `make_adapter` is called without arguments, and must outlive this. `name`: of the class, by which states are told
  /// from those of others.
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
  std::vector<std::uint32_t> robots_;  // ascending ids
  std::size_t observation_size_ = 0;   // of one robot
  std::vector<double> neutral_;        // of one robot
  std::vector<CommandChannel> command_channels_;
  std::vector<double> observations_;  // [robot, value]
  std::vector<double> commands_;
  std::vector<double> values_;
};

/// Returns how to drive robots by what `maker` makes, an object of `cohort._hosting.Maker` that must outlive all
/// controllers: each robot by a controller, or all by one.
ControllerKind kind_of_maker(PyObject* maker);

}  // namespace cohort::python
