// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/build_facts.hpp"

#include <fmt/format.h>

#include <cohort_build/facts.hpp>

#include "client_sdk/math/portable_math.hpp"
#include "idl/dds/survey.hpp"
#include "server/simulation/build_identity.hpp"

namespace cohort::tool {
namespace {

std::string mathematics() {
  const std::vector<std::string> foreign = functions_not_portable();
  return foreign.empty()
             ? "portable"
             : fmt::format("functions taken from the C library, not portable: {}", fmt::join(foreign, ", "));
}

}  // namespace

std::string version_text() {
  return fmt::format(
      "cohort {}\n"
      "commit        {}\n"
      "compiler      {}\n"
      "flags         {}\n"
      "architecture  {}\n"
      "libraries     Cyclone DDS {}, {}\n"
      "mathematics   {}\n"
      "arithmetic    {}",
      this_build().version, this_build().commit, build::compiler, build::flags, build::architecture,
      wire::dds_version(), build::libraries, mathematics(), this_build().arithmetic);
}

}  // namespace cohort::tool
