#include "server/actuation/loudspeaker.hpp"

namespace cohort::actuation {

std::vector<Channel> Loudspeaker::channels() const {
  return {{speaker_.name + "/0/frequency", "Hz", 1, 0.0, speaker_.max_frequency, 0.0},
          {speaker_.name + "/0/intensity", "1", 1, 0.0, speaker_.max_intensity, 0.0}};
}

}  // namespace cohort::actuation
