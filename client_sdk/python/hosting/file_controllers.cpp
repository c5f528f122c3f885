// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/python/hosting/file_controllers.hpp"

#include <map>
#include <string>

#include "client_sdk/python/hosting/python_team.hpp"

namespace cohort::python {
namespace {

PyObject* maker_in(const char* file) {
  // Kept until the process ends, like Python itself. Guarded by Python's lock.
  static auto& makers = *new std::map<std::string, Owned>;
  if (const auto known = makers.find(file); known != makers.end()) return known->second.get();
  const Owned module = checked(PyImport_ImportModule("cohort._hosting"));
  Owned maker = checked(PyObject_CallMethod(module.get(), "maker_in_program", "s", file));
  return makers.try_emplace(file, std::move(maker)).first->second.get();
}

ControllerKind kind_in_file(const char* file) {
  const Lock lock;
  return kind_of_maker(maker_in(file));
}

}  // namespace

const FileControllers file_controllers{.kind_in = kind_in_file};

}  // namespace cohort::python
