#pragma once

#include <Python.h>

#include <cohort/controller.hpp>
#include <cstdint>
#include <string>
#include <vector>

/// Calls controllers that are written in Python. With the C interface of Python alone: for the extension module of the
/// package and for the plugin by which `cohort` runs files of Python.
namespace cohort::python {

/// Holds Python's global lock as long as it lives, on any thread.
class Lock {
 public:
  Lock() : state_(PyGILState_Ensure()) {}
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  ~Lock() { PyGILState_Release(state_); }

 private:
  PyGILState_STATE state_;
};

/// A reference to an object, owned by this. The lock has to be held wherever it is made, changed or destroyed.
class Owned {
 public:
  Owned() = default;
  explicit Owned(PyObject* object) : object_(object) {}
  Owned(Owned&& other) noexcept : object_(other.release()) {}
  Owned& operator=(Owned&& other) noexcept {
    if (this != &other) Py_XSETREF(object_, other.release());
    return *this;
  }
  ~Owned() { Py_XDECREF(object_); }

  PyObject* get() const { return object_; }
  PyObject* release() {
    PyObject* const object = object_;
    object_ = nullptr;
    return object;
  }
  explicit operator bool() const { return object_ != nullptr; }

 private:
  PyObject* object_ = nullptr;
};

/// Returns `object`. Throws std::runtime_error, with the exception that Python has raised, if it is null.
Owned checked(PyObject* object);

/// One robot's controller: an object of `cohort._hosting.Adapter`, which calls the class of the user. Observations and
/// commands are arrays of NumPy that show the memory of this object.
class PythonController final : public Controller {
 public:
  /// `make_adapter` is called without arguments. Throws std::runtime_error with what Python raises.
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
  std::vector<double> observation_;
  std::vector<double> command_;
  std::vector<double> neutral_;
  std::vector<CommandChannel> command_channels_;
};

}  // namespace cohort::python
