#pragma once

#include "client_sdk/src/client.hpp"

namespace cohort {

/// What COHORT_SERVER, COHORT_DOMAIN and COHORT_SECURE say, where they are set, in place of what the options have.
/// Throws std::invalid_argument if the domain is none.
void take_environment(ClientOptions& options);

}  // namespace cohort
