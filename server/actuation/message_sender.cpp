#include "server/actuation/message_sender.hpp"

#include <limits>

namespace cohort::actuation {

std::vector<Channel> MessageSender::channels() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto size = static_cast<std::uint32_t>(device_.message_size);
  return {{device_.name + "/0/sending", "1", 1, 0.0, 1.0, 0.0},
          {device_.name + "/0/message", "1", size, -infinity, infinity, 0.0}};
}

}  // namespace cohort::actuation
