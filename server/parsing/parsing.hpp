#pragma once

namespace cohort::description {}

/// Files to descriptions and back.
namespace cohort::parsing {
using namespace description;  // it speaks of nothing else
}
