// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/python/plugin/interpreter.hpp"

#include <Python.h>
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "idl/include/cohort/version.h"

// This library is not linked against Python: it looks up the functions below in the user's Python.
namespace cohort::python {
namespace {

namespace fs = std::filesystem;

// Prints where the interpreter and its shared library are.
constexpr const char* tell_where = R"(import os, sys, sysconfig
value = sysconfig.get_config_var
folders = [value("LIBDIR"), value("LIBPL"), os.path.join(sys.base_prefix, "lib")]
names = [value("INSTSONAME"), value("LDLIBRARY")]
files = [os.path.join(folder, name) for folder in folders for name in names if folder and name and ".so" in name]
print(sys.executable)
print(next(filter(os.path.exists, files), ""))
)";

struct Found {
  std::string interpreter;  // its name in messages
  std::string executable{};
  std::string library{};
};

std::string advice() {
  return ". Set COHORT_PYTHON to a Python interpreter in which the Python package of Cohort is installed";
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end + 1) {
    end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
  }
  return lines;
}

Found find_interpreter() {
  const char* named = std::getenv("COHORT_PYTHON");
  Found found{named != nullptr && *named != '\0' ? named : "python3"};
  const std::string command =
      R"(exec "${COHORT_PYTHON:-python3}" -c ')" + std::string(tell_where) + "' < /dev/null 2>&1";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> output(::popen(command.c_str(), "re"), ::pclose);
  std::string said;
  std::array<char, 4096> buffer{};
  while (output != nullptr && std::fgets(buffer.data(), buffer.size(), output.get()) != nullptr) said += buffer.data();
  const std::vector<std::string> lines = lines_of(said);
  if (lines.size() < 2 || !fs::path(lines[lines.size() - 2]).is_absolute())
    throw std::runtime_error("the Python interpreter '" + found.interpreter + "' cannot be run (" +
                             (lines.empty() ? "no output" : lines.back()) + ")" + advice());
  found.executable = lines[lines.size() - 2];
  found.library = lines.back();
  if (found.library.empty())
    throw std::runtime_error("the Python interpreter " + found.executable +
                             " cannot be embedded: its shared library (libpython3.….so) is not installed. Install it "
                             "(on Debian: the package libpython3.11), or set COHORT_PYTHON to another Python");
  return found;
}

// The functions used of Python's stable interface.
struct Python {
  Found found = find_interpreter();
  void* library = ::dlopen(found.library.c_str(), RTLD_NOW | RTLD_GLOBAL);  // extension modules bind to it

  // Deprecated, but the stable interface has no replacement.
  void (*set_program_name)(const wchar_t*) = function("Py_SetProgramName");
  decltype(&Py_DecodeLocale) decode_locale = function("Py_DecodeLocale");
  decltype(&Py_InitializeEx) initialize = function("Py_InitializeEx");
  decltype(&PyEval_SaveThread) save_thread = function("PyEval_SaveThread");
  decltype(&PyGILState_Ensure) lock = function("PyGILState_Ensure");
  decltype(&PyGILState_Release) unlock = function("PyGILState_Release");
  decltype(&PySys_GetObject) sys = function("PySys_GetObject");
  decltype(&PyUnicode_DecodeFSDefault) text_of_path = function("PyUnicode_DecodeFSDefault");
  decltype(&PyList_Insert) insert = function("PyList_Insert");
  decltype(&Py_DecRef) release = function("Py_DecRef");
  decltype(&PyImport_ImportModule) import = function("PyImport_ImportModule");
  decltype(&PyCapsule_Import) import_capsule = function("PyCapsule_Import");
  decltype(&PyErr_Fetch) fetch_error = function("PyErr_Fetch");
  decltype(&PyObject_Str) text_of = function("PyObject_Str");
  decltype(&PyUnicode_AsUTF8AndSize) utf8 = function("PyUnicode_AsUTF8AndSize");

  struct Address {
    void* address;
    template <class Function>
    operator Function*() const {  // NOLINT(google-explicit-constructor)
      return reinterpret_cast<Function*>(address);
    }
  };
  Address function(const char* name) const {
    void* const address = library != nullptr ? ::dlsym(library, name) : nullptr;
    if (address != nullptr) return {address};
    const char* const error = ::dlerror();
    throw std::runtime_error("the Python interpreter " + found.executable + " cannot be embedded: " +
                             (error != nullptr ? error : "its shared library cannot be loaded") + advice());
  }

  // Returns the message of the current Python exception.
  std::string raised() const {
    PyObject *type = nullptr, *value = nullptr, *traceback = nullptr;
    fetch_error(&type, &value, &traceback);
    PyObject* const text = value != nullptr ? text_of(value) : nullptr;
    const char* const characters = text != nullptr ? utf8(text, nullptr) : nullptr;
    std::string said = characters != nullptr ? characters : "an exception without a message";
    for (PyObject* const object : {type, value, traceback, text}) release(object);
    return said;
  }
};

// Returns the folder of the package if this plugin is in a build tree.
fs::path package_of_build_tree() {
  Dl_info here{};
  if (::dladdr(reinterpret_cast<const void*>(&controllers_of_package), &here) == 0) return {};
  fs::path folder = fs::absolute(here.dli_fname).parent_path().parent_path().parent_path() / "python";
  std::error_code ignored;
  return fs::is_directory(folder / "cohort", ignored) ? folder : fs::path();
}

void put_first_on_path(const Python& python, const fs::path& folder) {
  PyObject* const path = python.sys("path");  // borrowed
  PyObject* const text = python.text_of_path(folder.c_str());
  if (path == nullptr || text == nullptr || python.insert(path, 0, text) != 0) python.raised();
  python.release(text);
}

Python start_interpreter() {
  Python python;
  // From the name of its program, Python finds its libraries and its virtual environment. It keeps the pointer.
  wchar_t* const name = python.decode_locale(python.found.executable.c_str(), nullptr);
  if (name == nullptr) throw std::runtime_error(python.found.executable + " is not a valid path in this locale");
  python.set_program_name(name);
  python.initialize(0);  // without signal handlers
  if (const fs::path folder = package_of_build_tree(); !folder.empty()) put_first_on_path(python, folder);
  python.save_thread();
  return python;
}

const FileControllers& import_package() {
  static const Python python = start_interpreter();
  const PyGILState_STATE state = python.lock();
  // Import it first, because errors of PyCapsule_Import lack the reason of a failed import.
  PyObject* const module = python.import("cohort._hosting");
  const void* const capsule = module != nullptr ? python.import_capsule(FileControllers::capsule, 0) : nullptr;
  const std::string error = capsule != nullptr ? "" : python.raised();
  python.release(module);
  python.unlock(state);
  if (capsule == nullptr)
    throw std::runtime_error("the Python interpreter " + python.found.executable +
                             " cannot import the Python package of Cohort (" + error + ")" + advice());
  const auto& controllers = *static_cast<const FileControllers*>(capsule);
  if (std::string_view(controllers.version) != COHORT_VERSION)
    throw std::runtime_error("the Python package of Cohort in " + python.found.executable + " has version " +
                             controllers.version + ", expected " + COHORT_VERSION + ", the version of this program");
  return controllers;
}

}  // namespace

const FileControllers& controllers_of_package() {
  static const FileControllers& controllers = import_package();
  return controllers;
}

}  // namespace cohort::python
