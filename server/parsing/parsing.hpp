// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort::description {}

/// Reading files into descriptions, and writing them.
namespace cohort::parsing {
using namespace description;  // all its names are of descriptions
}
