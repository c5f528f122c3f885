// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/python/hosting/python_team.hpp"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "client_sdk/python/hosting/python_controller.hpp"

namespace cohort::python {
namespace {

// Runs user code. Turns any exception into a failure with the place and the reason.
template <class Failure = ControllerFailure, class Call>
decltype(auto) guarded(const std::string& name, const char* function, std::uint64_t tick, Call call) {
  try {
    return call();
  } catch (const std::exception& error) {
    throw Failure("the team controller '" + name + "' failed in " + function + " at tick " + std::to_string(tick) +
                  ": " + error.what());
  }
}

bool is_true(PyObject* object, const char* attribute) {
  const Owned value = checked(PyObject_GetAttrString(object, attribute));
  return PyObject_IsTrue(value.get()) == 1;
}

}  // namespace

PythonTeam::PythonTeam(PyObject* make_adapter, std::string name)
    : make_adapter_(make_adapter), name_(std::move(name)) {}

PythonTeam::~PythonTeam() {
  const Lock lock;
  adapter_ = Owned();
  observations_ = SharedValues();
  commands_ = SharedValues();
}

void PythonTeam::start(const wire::Admit& admit, std::span<const wire::RobotDescription> descriptions) {
  std::vector<Start> starts;
  for (const wire::AdmittedRobot& robot : admit.robots) starts.push_back(start_of(admit, robot, descriptions));
  std::ranges::sort(starts, {}, &Start::robot);
  if (starts.empty()) {
    robots_.clear();
    return;
  }
  for (const Start& start : starts)
    if (start.model != starts[0].model)
      throw ControllerFailure("the controller '" + name_ + "' drives all robots of a process together, but " +
                              starts[0].name + " and " + start.name +
                              " have different models; use one process per model");
  const bool is_same = starts[0].reason == StartReason::reset || starts[0].reason == StartReason::restored;
  const Lock lock;
  guarded(name_, "start", admit.tick, [&] {
    if (!adapter_ || !is_same) adapter_ = checked(PyObject_CallNoArgs(make_adapter_));
    robots_.clear();
    for (const Start& start : starts) robots_.push_back(start.robot);
    observation_size_ = size_of(starts[0].observation_channels);
    neutral_ = neutral_of(starts[0].command_channels);
    command_channels_ = command_channels_of(starts[0].command_channels);
    observations_.resize(robots_.size() * observation_size_);
    commands_.resize(robots_.size() * neutral_.size());
    const Owned facts = checked(PyList_New(0));
    for (const Start& start : starts)
      if (PyList_Append(facts.get(), facts_of(start).get()) != 0) checked(nullptr);
    const Owned asked = checked(PyObject_CallMethod(adapter_.get(), "start", "OOO", facts.get(),
                                                    observations_.view(false).get(), commands_.view(true).get()));
    for (const Start& start : starts) {
      note_asked(start.parameters, asked.get());
      start.parameters.check_all_were_asked_for();
    }
  });
}

std::span<const double> PythonTeam::answer(const wire::Observation& frame) {
  const std::size_t count = frame.robots.size();
  if (count > robots_.size() || frame.values.size() != count * observation_size_)
    throw ControllerFailure("the frame of tick " + std::to_string(frame.tick) +
                            " does not match the robots of this process");
  const Lock lock;
  return guarded(name_, "step", frame.tick, [&]() -> std::span<const double> {
    std::ranges::copy(frame.values, observations_.values().begin());
    for (std::size_t row = 0; row < count; ++row)
      std::ranges::copy(neutral_, commands_.values().begin() + static_cast<std::ptrdiff_t>(row * neutral_.size()));
    // None if all robots are due, else the rows of those due.
    Owned rows;
    if (count < robots_.size()) {
      rows = checked(PyList_New(0));
      for (const std::uint32_t robot : frame.robots) {
        const auto place = std::ranges::lower_bound(robots_, robot);
        if (place == robots_.end() || *place != robot)
          throw std::runtime_error("robot " + std::to_string(robot) + " is not driven by this process");
        const Owned number = checked(PyLong_FromSsize_t(place - robots_.begin()));
        if (PyList_Append(rows.get(), number.get()) != 0) checked(nullptr);
      }
    }
    checked(PyObject_CallMethod(adapter_.get(), "step", "KLO", static_cast<unsigned long long>(frame.tick),
                                static_cast<long long>(frame.time_ns), rows ? rows.get() : Py_None));
    values_.resize(count * neutral_.size());
    for (std::size_t row = 0; row < count; ++row) {
      Command command(std::span<double>(values_).subspan(row * neutral_.size(), neutral_.size()));
      set_all(command, command_channels_, commands_.values().subspan(row * neutral_.size(), neutral_.size()));
    }
    return values_;
  });
}

// The first robot has the state of all; the other states are empty.
std::vector<RobotState> PythonTeam::save() const {
  std::vector<RobotState> states;
  if (robots_.empty()) return states;
  const Lock lock;
  return guarded<SaveFailure>(name_, "save", 0, [&] {
    StateWriter writer;
    write_state(writer, checked(PyObject_CallMethod(adapter_.get(), "save", nullptr)).get());
    if (writer.bytes().size() > largest_state)
      throw StateError("its state has " + std::to_string(writer.bytes().size()) + " bytes; the maximum is " +
                       std::to_string(largest_state));
    for (const std::uint32_t robot : robots_) {
      RobotState& saved = states.emplace_back(RobotState{robot});
      if (writer.is_left_out()) continue;
      saved.state = {name_, {}};
      if (robot == robots_.front()) saved.state->bytes.assign(writer.bytes().begin(), writer.bytes().end());
    }
    return states;
  });
}

std::vector<std::string> PythonTeam::load(std::span<const RobotState> states) {
  const auto first = std::ranges::find_if(states, [&](const RobotState& state) {
    return !robots_.empty() && state.robot == robots_.front() && state.state.has_value();
  });
  if (first == states.end()) return {};
  if (first->state->controller != name_ || first->state->bytes.empty())
    return {"the saved state belongs to controller '" + first->state->controller +
            "' or to another group of robots; '" + name_ + "' starts without state"};
  const Lock lock;
  guarded(name_, "load", 0, [&] {
    StateReader reader(first->state->bytes);
    std::string bytes;
    reader.read(bytes);
    checked(PyObject_CallMethod(adapter_.get(), "load", "y#", bytes.data(), static_cast<Py_ssize_t>(bytes.size())));
  });
  return {};
}

ControllerKind kind_of_maker(PyObject* maker) {
  const Owned name = checked(PyObject_GetAttrString(maker, "name"));
  ControllerKind kind{.name = PyUnicode_AsUTF8AndSize(name.get(), nullptr), .create = {}};
  if (is_true(maker, "drives_all")) {
    kind.create_for_all = [maker, name = kind.name] { return std::make_unique<PythonTeam>(maker, name); };
  } else {
    kind.create = [maker] {
      return OwnedController(new PythonController(maker), [](Controller* made) { delete made; });
    };
  }
  return kind;
}

}  // namespace cohort::python
