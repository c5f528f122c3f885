// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "server/description/population.hpp"
#include "server/parsing/keys/extensions.hpp"
#include "server/parsing/sdf/sdf_report.hpp"

namespace cohort::parsing {

/// A `cohort:population` as it is written.
struct WrittenPopulation {
  const Element* uri_element;
  std::string uri;
  Population population;  ///< without its model
};

/// Reads a population; returns nothing, with a report, if the element is invalid.
std::optional<WrittenPopulation> read_population(const Element* element, const Extension& extension,
                                                 const SdfReport& report);

}  // namespace cohort::parsing
