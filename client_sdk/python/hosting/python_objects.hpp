#pragma once

#define PY_SSIZE_T_CLEAN  // before Python.h: lengths of bytes are Py_ssize_t
#include <Python.h>

#include <cohort/controller.hpp>
#include <span>
#include <string>
#include <vector>

/// Objects of Python for C++, with the C interface of Python alone.
namespace cohort::python {

/// Holds Python's global lock as long as it lives, on any thread.
class Lock {
 public:
  Lock() {
    // Without this, Python would forget a thread that is not its own after each call, and what it keeps for it: the
    // values of context variables, how NumPy treats errors.
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

/// A reference to an object, owned by this. The lock has to be held wherever it is made, changed or destroyed.
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

/// Returns `object`. If it is null, throws std::runtime_error with the exception that Python has raised: ParameterError
/// for one of the package.
Owned checked(PyObject* object);

/// Returns what `cohort._hosting.Start` is made of, a dictionary.
Owned facts_of(const Start& start);
/// Tells the parameters which of them Python has asked for; `asked` is a list of names.
void note_asked(const Parameters& parameters, PyObject* asked);

/// Returns the memory of these values as an object of Python, which must not be used after them. It may be written to
/// if `is_written`.
Owned memory_of(std::vector<double>& values, bool is_written);

/// Returns how many values channels have.
std::size_t size_of(const std::vector<ChannelInfo>& channels);
/// Returns the neutral values of channels.
std::vector<double> neutral_of(const std::vector<ChannelInfo>& channels);
/// Returns channels as Command::set takes them.
std::vector<CommandChannel> command_channels_of(const std::vector<ChannelInfo>& channels);
/// Gives all values to a command, each brought into the range of its channel.
void set_all(Command& command, const std::vector<CommandChannel>& channels, std::span<const double> values);

/// Writes what `save` returned: bytes, or None if nothing can be saved.
void write_state(StateWriter& state, PyObject* saved);

}  // namespace cohort::python
