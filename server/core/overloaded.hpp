// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cohort {

/// Combines functions into one overload set, for std::visit.
template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace cohort
