#include "server/actuation/user_action.hpp"

namespace cohort::actuation {

std::vector<Channel> UserAction::channels() const { return {{action_.name + "/0/value", "1", 1, 0.0, 1.0, 0.0}}; }

void UserAction::apply(std::span<const double> values) { mount_.actions.command(number_, values[0]); }

}  // namespace cohort::actuation
