#include "server/physics/solvers/yielding_rows.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::physics {
namespace {

// Compliance of rows as a share of what the bodies yield to an impulse. More compliance makes a minimum easier to find,
// less makes the next guess better.
constexpr double yielding_one_sided = 1e-3;  // contacts and limits of joints
constexpr double yielding_two_sided = 1e-2;  // friction and motors
// A contact forgets this share of its guess, so that it yields a little to its load. Otherwise the loads of a body on
// more points than it needs would drift. Friction remembers all of its guess: a body at rest does not creep.
constexpr double forgotten_share = 1e-3;
// Rows without any limit have no guess: loops may contradict each other by the sum of their gaps.
constexpr double yielding_without_limit = 1e-5;
// If masses differ much, the rows of light bodies carry the loads of heavy ones. Their compliance is at most this
// multiple of what the heaviest body yields.
constexpr double yielding_of_heaviest = 0.1;

constexpr double immovable = 1e-12;  // response of a body that its user moves

double length_of(double x, double y) { return std::sqrt(x * x + y * y); }

// Returns the velocity change by a unit impulse; 0: none.
double response_of(const Row& row) {
  const double inverse = row.limits == Row::Limits::cone ? row.cone_inverse : row.inverse;
  return inverse > 0.0 ? 1.0 / inverse : 0.0;
}

}  // namespace

// Returns what the heavier of two bodies contributes to the response of a row.
double YieldingRows::response_of_heavier(const Row& row, double response) const {
  const double* jacobian = problem_->numbers() + row.numbers;
  const double of_a = dot(jacobian, jacobian + row.stride_a, row.stride_a);
  const double least = row.body_b < 0 ? of_a : std::min(of_a, response - of_a);
  return least > immovable ? least : response;
}

void YieldingRows::gather(Problem& problem) {
  problem_ = &problem;
  const std::vector<Row>& rows = problem_->rows();
  impulses_.assign(rows.size(), 0.0);
  terms_.clear();
  double least_response = unlimited;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const double response = response_of(row);
    if (row.limits == Row::Limits::coned || response == 0.0) continue;
    if (row.is_of_force) least_response = std::min(least_response, response_of_heavier(row, response));
    YieldingRow& term = terms_.emplace_back();
    term.row = i;
    term.lower = row.lower;
    term.upper = row.upper;
    if (row.limits == Row::Limits::cone) term.count = 2;
    for (std::size_t k = 0; k < term.count; ++k) impulses_[i + k] = term.impulse[k] = rows[i + k].impulse;
    term.compliance = response;
  }
  for (YieldingRow& term : terms_) soften(term, term.compliance, least_response);
  update_limits();
}

// `response`: what the bodies yield to a unit impulse. `least`: what the heaviest body yields.
void YieldingRows::soften(YieldingRow& term, double response, double least) const {
  const Row& of = row(term);
  const bool is_above = of.lower > -unlimited;
  const bool is_below = of.upper < unlimited;
  const bool is_two_sided = !of.has_fixed_limits() || (is_above && is_below);
  if (!is_two_sided && !is_above && !is_below) {
    term.compliance = of.softness + yielding_without_limit * response;
    term.forgotten = 1.0;
  } else {
    double at_first = (is_two_sided ? yielding_two_sided : yielding_one_sided) * response;
    if (of.is_of_force) at_first = std::min(at_first, yielding_of_heaviest * least);
    const double at_last = of.softness + (is_two_sided ? 0.0 : forgotten_share * at_first);
    term.compliance = at_first + at_last;
    term.forgotten = at_last / term.compliance;
  }
  for (std::size_t i = 0; i < term.count; ++i) term.guess[i] = (1.0 - term.forgotten) * term.impulse[i];
}

bool YieldingRows::are_settled(double negligible) const {
  return std::ranges::all_of(terms_, [&](const YieldingRow& term) { return is_settled(term, negligible); });
}

bool YieldingRows::is_settled(const YieldingRow& term, double negligible) const {
  std::array<double, 2> error{};
  for (std::size_t i = 0; i < term.count; ++i)
    error[i] = term.velocity[i] - row(term, i).target + term.forgotten * term.compliance * impulses_[term.row + i];
  const double response = response_of(row(term));
  if (term.count == 1) {
    const double impulse = impulses_[term.row];
    return std::max(term.lower - impulse, impulse - term.upper) * response <= negligible &&
           (error[0] <= negligible || impulse <= term.lower) && (error[0] >= -negligible || impulse >= term.upper);
  }
  const std::array<double, 2> impulse{impulses_[term.row], impulses_[term.row + 1]};
  const double length = length_of(impulse[0], impulse[1]);
  if ((length - term.upper) * response > negligible) return false;
  const double sliding = length > 0.0 ? -(error[0] * impulse[0] + error[1] * impulse[1]) / length : 0.0;
  if (length >= term.upper && sliding > 0.0)
    for (std::size_t i = 0; i < 2; ++i) error[i] += sliding * impulse[i] / length;
  return (length == 0.0 && term.upper == 0.0) || length_of(error[0], error[1]) <= negligible;
}

void YieldingRows::evaluate(YieldingRow& term, double share) const {
  const double stiffness = 1.0 / term.compliance;
  std::array<double, 2> wanted{};
  for (std::size_t i = 0; i < term.count; ++i)
    wanted[i] = term.guess[i] + (row(term, i).target - term.velocity[i] - share * term.change[i]) * stiffness;
  if (term.count == 1) {
    term.impulse[0] = std::clamp(wanted[0], term.lower, term.upper);
    term.is_free = term.impulse[0] == wanted[0];
    term.stiffness[0] = term.is_free ? stiffness : 0.0;
    return;
  }
  const double length = length_of(wanted[0], wanted[1]);
  term.is_free = length <= term.upper;
  if (term.is_free) {
    term.impulse = wanted;
    term.stiffness = {stiffness, stiffness, 0.0};
    return;
  }
  const double part = term.upper / length;
  const std::array<double, 2> direction{wanted[0] / length, wanted[1] / length};
  for (std::size_t i = 0; i < 2; ++i) {
    term.impulse[i] = part * wanted[i];
    term.stiffness[i] = part * stiffness * (1.0 - direction[i] * direction[i]);
  }
  term.stiffness[2] = -part * stiffness * direction[0] * direction[1];
}

double YieldingRows::update_guesses() {
  for (const YieldingRow& term : terms_)
    for (std::size_t i = 0; i < term.count; ++i) impulses_[term.row + i] = term.impulse[i];
  double greatest = 0.0;
  for (YieldingRow& term : terms_) {
    for (std::size_t i = 0; i < term.count; ++i) {
      const double guess = (1.0 - term.forgotten) * term.impulse[i];
      if (term.is_free) greatest = std::max(greatest, term.compliance * std::abs(guess - term.guess[i]));
      term.guess[i] = guess;
    }
  }
  return greatest;
}

double YieldingRows::update_limits() {
  double greatest = 0.0;
  for (YieldingRow& term : terms_) {
    const Row& of = row(term);
    if (of.has_fixed_limits()) continue;
    double load = 0.0;
    for (int j = of.load_begin; j < of.load_end; ++j) load += impulses_[at(j)];
    const double limit = std::max(0.0, std::min(of.cap, of.friction * load));
    const double impulse = term.count == 1 ? std::abs(term.impulse[0]) : length_of(term.impulse[0], term.impulse[1]);
    constexpr double rounding = 1e-9;
    if (impulse >= std::min(limit, term.upper) * (1.0 - rounding))
      greatest = std::max(greatest, std::abs(limit - term.upper) * response_of(of));
    term.upper = limit;
    term.lower = -limit;
  }
  return greatest;
}

void YieldingRows::apply() const {
  for (const YieldingRow& term : terms_) {
    for (std::size_t i = 0; i < term.count; ++i) {
      Row& of = problem_->rows()[term.row + i];
      of.impulse = impulses_[term.row + i];
      of.set_limits(term.lower, term.upper);
    }
  }
  for (Row& row : problem_->rows())
    if (row.inverse == 0.0) row.impulse = 0.0;
}

}  // namespace cohort::physics
