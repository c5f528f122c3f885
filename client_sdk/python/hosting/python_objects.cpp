// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/python/hosting/python_objects.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace cohort::python {
namespace {

std::string text_of(PyObject* object) {
  if (object == nullptr) return {};
  const Owned text(PyObject_Str(object));
  Py_ssize_t size = 0;
  const char* characters = text ? PyUnicode_AsUTF8AndSize(text.get(), &size) : nullptr;
  if (characters != nullptr) return {characters, static_cast<std::size_t>(size)};
  PyErr_Clear();
  return {};
}

// Throws the current Python exception: a ParameterError as the C++ one, any other as described by
// `cohort._hosting.describe`, with the lines that led to it.
[[noreturn]] void throw_raised() {
  PyObject *type = nullptr, *value = nullptr, *traceback = nullptr;
  PyErr_Fetch(&type, &value, &traceback);
  PyErr_NormalizeException(&type, &value, &traceback);
  const Owned owned_type(type), owned_value(value), owned_traceback(traceback);
  if (!owned_value) throw std::runtime_error("Python reported an error without an exception");
  if (owned_traceback) PyException_SetTraceback(owned_value.get(), owned_traceback.get());
  const Owned module(PyImport_ImportModule("cohort._hosting"));
  const auto call = [&](const char* function) {
    Owned result(module ? PyObject_CallMethod(module.get(), function, "O", owned_value.get()) : nullptr);
    if (!result) PyErr_Clear();
    return result;
  };
  if (const Owned problem = call("parameter_problem"); problem && problem.get() != Py_None)
    throw ParameterError(text_of(PyTuple_GetItem(problem.get(), 0)), text_of(PyTuple_GetItem(problem.get(), 1)));
  const std::string described = text_of(call("describe").get());
  throw std::runtime_error(described.empty() ? text_of(owned_value.get()) : described);
}

void put(PyObject* dictionary, const char* key, PyObject* value) {
  const Owned owned = checked(value);
  if (PyDict_SetItemString(dictionary, key, owned.get()) != 0) throw_raised();
}

PyObject* text(const std::string& text) {
  return PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace");
}

Owned channels_of(const std::vector<ChannelInfo>& channels) {
  Owned list = checked(PyList_New(0));
  for (const ChannelInfo& channel : channels) {
    const Owned tuple = checked(Py_BuildValue("(NNIIddd)", text(channel.name), text(channel.unit), channel.offset,
                                              channel.size, channel.lower, channel.upper, channel.neutral));
    if (PyList_Append(list.get(), tuple.get()) != 0) throw_raised();
  }
  return list;
}

template <class Item, class ToPython>
Owned list_of(const std::vector<Item>& items, const ToPython& to_python) {
  Owned list = checked(PyList_New(0));
  for (const Item& item : items) {
    const Owned made = checked(to_python(item));
    if (PyList_Append(list.get(), made.get()) != 0) throw_raised();
  }
  return list;
}

PyObject* tuple_of(const Vector3& vector) { return Py_BuildValue("(ddd)", vector.x, vector.y, vector.z); }

PyObject* tuple_of(const FramePose& pose) {
  const auto& [p, q] = pose;
  return Py_BuildValue("(ddddddd)", p.x, p.y, p.z, q.w, q.x, q.y, q.z);
}

PyObject* tuple_of(const AxisInfo& axis) {
  return Py_BuildValue("(Ndddd)", tuple_of(axis.direction), axis.lower, axis.upper, axis.max_velocity, axis.max_effort);
}

PyObject* tuple_of(const JointInfo& joint) {
  const auto to_axis = [](const AxisInfo& axis) { return tuple_of(axis); };
  return Py_BuildValue("(NINNNNNdN)", text(joint.name), static_cast<unsigned>(joint.type),
                       joint.parent == JointInfo::world ? Py_NewRef(Py_None) : PyLong_FromUnsignedLong(joint.parent),
                       PyLong_FromUnsignedLong(joint.child), tuple_of(joint.pose), tuple_of(joint.frame),
                       list_of(joint.axes, to_axis).release(), joint.thread_pitch,
                       list_of(joint.devices, text).release());
}

// The arguments of `cohort.kinematic_tree.KinematicTree`.
Owned tree_of(const KinematicTree& tree) {
  const auto to_link = [](const LinkInfo& link) {
    return Py_BuildValue("(NdN)", text(link.name), link.mass, tuple_of(link.center_of_mass));
  };
  const auto to_joint = [](const JointInfo& joint) { return tuple_of(joint); };
  const auto to_sensor = [](const SensorInfo& sensor) {
    return Py_BuildValue("(NIN)", text(sensor.name), sensor.link, tuple_of(sensor.pose));
  };
  return checked(Py_BuildValue("(NNN)", list_of(tree.links, to_link).release(),
                               list_of(tree.joints, to_joint).release(), list_of(tree.sensors, to_sensor).release()));
}

Owned parameters_of(const Parameters& parameters) {
  Owned dictionary = checked(PyDict_New());
  for (const Parameter& parameter : parameters.all()) {
    Owned values = checked(PyList_New(0));
    for (const std::string& value : parameter.values) {
      const Owned item = checked(text(value));
      if (PyList_Append(values.get(), item.get()) != 0) throw_raised();
    }
    put(dictionary.get(), parameter.name.c_str(), values.release());
  }
  return dictionary;
}

const char* word_of(StartReason reason) {
  switch (reason) {
    case StartReason::first: return "first";
    case StartReason::takeover: return "takeover";
    case StartReason::reset: return "reset";
    case StartReason::restored: return "restored";
    case StartReason::going_on: return "going_on";
    case StartReason::check: return "check";
  }
  return "first";
}

}  // namespace

Owned checked(PyObject* object) {
  if (object == nullptr) throw_raised();
  return Owned(object);
}

Owned facts_of(const Start& start) {
  Owned facts = checked(PyDict_New());
  PyObject* const to = facts.get();
  put(to, "robot", PyLong_FromUnsignedLong(start.robot));
  put(to, "name", text(start.name));
  put(to, "model", text(start.model));
  put(to, "team", text(start.team));
  put(to, "controller", text(start.controller));
  put(to, "parameters", parameters_of(start.parameters).release());
  put(to, "reason", text(word_of(start.reason)));
  put(to, "tick", PyLong_FromUnsignedLongLong(start.tick));
  put(to, "seed", PyLong_FromUnsignedLongLong(start.seed));
  put(to, "step_ns", PyLong_FromLongLong(start.step.count()));
  put(to, "period", PyLong_FromUnsignedLong(start.period));
  put(to, "observation_channels", channels_of(start.observation_channels).release());
  put(to, "command_channels", channels_of(start.command_channels).release());
  put(to, "tree", tree_of(start.tree).release());
  return facts;
}

void note_asked(const Parameters& parameters, PyObject* asked) {
  for (Py_ssize_t i = 0; i < PyList_Size(asked); ++i) parameters.has(text_of(PyList_GetItem(asked, i)));
}

// Python never moves the memory of a bytearray of which there is a view, and aligns it like malloc.
void SharedValues::resize(std::size_t size) {
  if (bytes_ && size == values_.size()) return;
  bytes_ = checked(PyByteArray_FromStringAndSize(nullptr, static_cast<Py_ssize_t>(size * sizeof(double))));
  values_ = {reinterpret_cast<double*>(PyByteArray_AsString(bytes_.get())), size};
  std::ranges::fill(values_, 0.0);
}

Owned SharedValues::view(bool is_written) const {
  Owned view = checked(PyMemoryView_FromObject(bytes_.get()));
  return is_written ? std::move(view) : checked(PyObject_CallMethod(view.get(), "toreadonly", nullptr));
}

std::size_t size_of(const std::vector<ChannelInfo>& channels) {
  return channels.empty() ? 0 : std::size_t{channels.back().offset} + channels.back().size;
}

std::vector<double> neutral_of(const std::vector<ChannelInfo>& channels) {
  std::vector<double> neutral;
  for (const ChannelInfo& channel : channels) neutral.insert(neutral.end(), channel.size, channel.neutral);
  return neutral;
}

std::vector<CommandChannel> command_channels_of(const std::vector<ChannelInfo>& channels) {
  std::vector<CommandChannel> handles;
  for (const ChannelInfo& channel : channels)
    handles.push_back({channel.offset, channel.size, channel.lower, channel.upper});
  return handles;
}

void set_all(Command& command, const std::vector<CommandChannel>& channels, std::span<const double> values) {
  for (const CommandChannel& channel : channels)
    for (std::uint32_t i = 0; i < channel.size; ++i) command.set(channel, values[channel.offset + i], i);
}

void write_state(StateWriter& state, PyObject* saved) {
  if (saved == Py_None) return state.leave_out();
  char* bytes = nullptr;
  Py_ssize_t size = 0;
  if (PyBytes_AsStringAndSize(saved, &bytes, &size) != 0) throw_raised();
  state.write(std::string_view(bytes, static_cast<std::size_t>(size)));
}

}  // namespace cohort::python
