#pragma once

#include <optional>
#include <sdf/Element.hh>
#include <string>

#include "server/parsing/keys/extensions.hpp"
#include "server/parsing/sdf/sdf_report.hpp"
#include "server/parsing/world/placement.hpp"

namespace cohort::parsing {

/// A `cohort:population` as it is written.
struct Population {
  sdf::ElementPtr uri_element;
  sdf::ElementPtr placement_element;
  std::string uri;
  Placement placement;
  bool may_be_fewer = false;  ///< than there are to be, if there is no room
};

/// Nothing if anything is wrong with the element; the report then has it. `seed` is that of the run.
std::optional<Population> read_population(const sdf::ElementPtr& element, const Extension& extension,
                                          std::uint64_t seed, const SdfReport& report);

}  // namespace cohort::parsing
