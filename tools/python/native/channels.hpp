// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <vector>

#include "server/core/channel.hpp"

namespace cohort::python {

/// Returns a list of tuples (name, unit, offset, size, lower, upper, neutral).
nanobind::list channel_tuples(const std::vector<Channel>& channels);

}  // namespace cohort::python
