// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

/// NumPy arrays of C++ data.
namespace cohort::python {

namespace nb = nanobind;

using Array = nb::ndarray<nb::numpy, double, nb::c_contig>;
using ConstArray = nb::ndarray<nb::numpy, const double, nb::c_contig>;

/// Returns an array that owns its values.
template <class Value>
nb::ndarray<nb::numpy, Value, nb::c_contig> owned_array(std::vector<Value> values,
                                                        std::initializer_list<std::size_t> shape) {
  auto* kept = new std::vector<Value>(std::move(values));
  const nb::capsule owner(kept, [](void* vector) noexcept { delete static_cast<std::vector<Value>*>(vector); });
  return {kept->data(), shape, owner};
}

/// Returns an array of values that `owner` keeps alive.
template <class Value>
nb::ndarray<nb::numpy, Value, nb::c_contig> view_of(Value* values, std::initializer_list<std::size_t> shape,
                                                    nb::handle owner) {
  return {values, shape, owner};
}

}  // namespace cohort::python
