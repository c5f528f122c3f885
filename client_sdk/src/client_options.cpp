// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>

#include "client_sdk/include/cohort/client.hpp"
#include "client_sdk/include/cohort/control.hpp"
#include "client_sdk/include/cohort/observer.hpp"
#include "idl/text/domains.hpp"

namespace cohort {
namespace {

template <class Options>
void take(Options& options) {
  if (const char* server = std::getenv("COHORT_SERVER"); server != nullptr) options.server = server;
  if (const char* domain = std::getenv("COHORT_DOMAIN"); domain != nullptr)
    options.domain = domain_of_this_process(parse_domains(domain));
  if (const char* secure = std::getenv("COHORT_SECURE"); secure != nullptr) options.secure = secure;
}

}  // namespace

void take_environment(ClientOptions& options) { take(options); }
void take_environment(ControlOptions& options) { take(options); }
void take_environment(ObserverOptions& options) { take(options); }

std::vector<std::string> split_selectors(std::string_view list) {
  std::vector<std::string> parts;
  while (!list.empty()) {
    const std::string_view part = list.substr(0, list.find(','));
    if (!part.empty()) parts.emplace_back(part);
    list.remove_prefix(std::min(list.size(), part.size() + 1));
  }
  return parts;
}

}  // namespace cohort
