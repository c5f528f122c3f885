// SPDX-License-Identifier: Apache-2.0
#include "tools/python/native/channels.hpp"

#include <nanobind/stl/string.h>

#include <cstddef>

namespace cohort::python {

nanobind::list channel_tuples(const std::vector<Channel>& channels) {
  nanobind::list tuples;
  std::size_t offset = 0;
  for (const Channel& channel : channels) {
    tuples.append(nanobind::make_tuple(channel.name, channel.unit, offset, channel.size, channel.lower, channel.upper,
                                       channel.neutral));
    offset += channel.size;
  }
  return tuples;
}

}  // namespace cohort::python
