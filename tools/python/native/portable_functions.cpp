// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tools/python/native/arrays.hpp"
#include "tools/python/native/parts.hpp"

namespace cohort::python {
namespace {

using Values = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

template <class Function>
Array computed(std::size_t count, Function function) {
  std::vector<double> results(count);
  for (std::size_t i = 0; i < count; ++i) results[i] = function(i);
  return owned_array(std::move(results), {count});
}

void add_unary(nb::module_& module, const char* name, double (*function)(double)) {
  module.def(name, [function](const Values& x) {
    return computed(x.shape(0), [&](std::size_t i) { return function(x(i)); });
  });
}

void add_binary(nb::module_& module, const char* name, double (*function)(double, double)) {
  module.def(name, [function](const Values& x, const Values& y) {
    if (x.shape(0) != y.shape(0)) throw std::invalid_argument("expected two arrays of the same size");
    return computed(x.shape(0), [&](std::size_t i) { return function(x(i), y(i)); });
  });
}

}  // namespace

void add_portable_functions(nb::module_& parent) {
  nb::module_ module = parent.def_submodule("functions");
  add_unary(module, "sin", ::sin);
  add_unary(module, "cos", ::cos);
  add_unary(module, "tan", ::tan);
  add_unary(module, "asin", ::asin);
  add_unary(module, "acos", ::acos);
  add_unary(module, "atan", ::atan);
  add_unary(module, "exp", ::exp);
  add_unary(module, "exp2", ::exp2);
  add_unary(module, "log", ::log);
  add_unary(module, "log2", ::log2);
  add_unary(module, "log10", ::log10);
  add_binary(module, "atan2", ::atan2);
  add_binary(module, "pow", ::pow);
}

}  // namespace cohort::python
