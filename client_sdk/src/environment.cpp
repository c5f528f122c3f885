#include "client_sdk/src/environment.hpp"

#include <cstdlib>

#include "client_sdk/src/domains.hpp"

namespace cohort {

void take_environment(ClientOptions& options) {
  if (const char* server = std::getenv("COHORT_SERVER"); server != nullptr) options.server = server;
  if (const char* domain = std::getenv("COHORT_DOMAIN"); domain != nullptr)
    options.domain = domain_of_this_process(parse_domains(domain));
  if (const char* secure = std::getenv("COHORT_SECURE"); secure != nullptr) options.secure = secure;
}

}  // namespace cohort
