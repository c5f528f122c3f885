// SPDX-License-Identifier: Apache-2.0
#pragma once

#define PY_SSIZE_T_CLEAN  // before Python.h: makes lengths of bytes Py_ssize_t
#include <Python.h>

#include <cohort/controller.hpp>
#include <span>
#include <string>
#include <vector>

/// Python objects for C++, using only Python's C interface.
namespace cohort::python {

/// Holds Python's global interpreter lock (GIL) during its lifetime, on any thread.
class Lock {
 public:
  Lock() {
    // Without this, Python would discard the state of a foreign thread after each call: the values of context
    // variables, and NumPy's error settings.
    if (PyGILState_GetThisThreadState() == nullptr) {
      PyGILState_Ensure();
      PyEval_SaveThread();
    }
    state_ = PyGILState_Ensure();
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  ~Lock() { PyGILState_Release(state_); }

 private:
  PyGILState_STATE state_;
};

/// An owned reference to a Python object. The GIL must be held when the reference is created, changed or destroyed.
class Owned {
 public:
  Owned() = default;
  explicit Owned(PyObject* object) : object_(object) {}
  Owned(Owned&& other) noexcept : object_(other.release()) {}
  Owned& operator=(Owned&& other) noexcept {
    if (this == &other) return *this;
    PyObject* const before = object_;
    object_ = other.release();
    Py_XDECREF(before);
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

/// Returns `object`. If it is null, throws std::runtime_error with the current Python exception, or ParameterError for
/// one of the package.
Owned checked(PyObject* object);

/// Returns the arguments of `cohort._hosting.Start` as a dictionary.
Owned facts_of(const Start& start);
/// Marks the parameters that Python has read; `asked` is a list of names.
void note_asked(const Parameters& parameters, PyObject* asked);

/// An array of values in memory that Python owns, so that NumPy arrays that the user's code keeps remain valid. The GIL
/// must be held when the array is created, resized or destroyed.
class SharedValues {
 public:
  /// Allocates new memory, filled with zeros, if the size changes.
  void resize(std::size_t size);
  /// Returns a memoryview of the values, which is writable if `is_written`.
  Owned view(bool is_written) const;
  std::span<double> values() const { return values_; }
  std::size_t size() const { return values_.size(); }

 private:
  Owned bytes_;
  std::span<double> values_;
};

/// Returns the number of values of channels.
std::size_t size_of(const std::vector<ChannelInfo>& channels);
/// Returns the neutral values of channels.
std::vector<double> neutral_of(const std::vector<ChannelInfo>& channels);
/// Returns the channels in the type of Command::set.
std::vector<CommandChannel> command_channels_of(const std::vector<ChannelInfo>& channels);
/// Sets all values of a command, each clamped to the range of its channel.
void set_all(Command& command, const std::vector<CommandChannel>& channels, std::span<const double> values);

/// Writes the result of a Python `save`: bytes, or None if the state cannot be saved.
void write_state(StateWriter& state, PyObject* saved);

}  // namespace cohort::python
