// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/requests/kept_for_client.hpp"

#include <algorithm>
#include <numeric>

namespace cohort::session {

std::string name_of(KeptForClient::Kind kind) {
  switch (kind) {
    case KeptForClient::Kind::saved_snapshot: return "saved snapshot";
    case KeptForClient::Kind::upload: return "uploaded data";
    case KeptForClient::Kind::recording: break;
  }
  return "recording";
}

std::vector<KeptForClient> what_goes(std::vector<KeptForClient> kept, std::size_t most) {
  std::ranges::stable_sort(kept, {}, &KeptForClient::since);
  std::size_t total = std::transform_reduce(kept.begin(), kept.end(), std::size_t{0}, std::plus<>(),
                                            [](const KeptForClient& each) { return each.bytes; });
  auto stays = kept.begin();
  for (; total > most; ++stays) total -= stays->bytes;
  kept.erase(stays, kept.end());
  return kept;
}

}  // namespace cohort::session
