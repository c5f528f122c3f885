// SPDX-License-Identifier: Apache-2.0
#include "server/description/shortened.hpp"

#include "idl/text/printable.hpp"

namespace cohort::description {

std::string shortened(std::string text) {
  constexpr std::size_t longest = 4096;
  return text.size() <= longest ? text : printable(text, longest, Lines::kept);
}

}  // namespace cohort::description
