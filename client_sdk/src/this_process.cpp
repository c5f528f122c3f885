// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/this_process.hpp"

#include <unistd.h>

#include <random>

namespace cohort {

std::uint64_t random_id() {
  std::random_device device;
  const std::uint64_t high = device();
  return high << 32 | device() | 1;
}

std::string host_name() {
  char name[256] = {};
  ::gethostname(name, sizeof(name) - 1);
  return name;
}

}  // namespace cohort
