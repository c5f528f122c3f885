#include "server/physics/solvers/newton_solver.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::physics {
namespace {

constexpr double most_elimination_work = 4e6;  // multiplications in one factorisation
constexpr int most_dofs_of_body = 64;
constexpr int most_minima = 10;
constexpr int most_steps = 30;  // steps of Newton's method, in all minima together
constexpr int most_shares = 20;
constexpr double flat = 0.1;  // share of the first slope at which a line search ends

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

// A limit of friction may still change by this multiple of the negligible error, as it would change the velocity of a
// free body.
constexpr double limits_tolerance = 100.0;

constexpr double immovable = 1e-12;  // response of a body that its user moves

double length_of(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace

bool NewtonSolver::solve(Problem& problem, double negligible) {
  if (!is_small(problem)) return false;
  problem_ = &problem;
  gather();
  start();
  if (!is_settled(0.1 * negligible) && !(prepare() && follow(negligible))) return false;
  apply();
  return true;
}

bool NewtonSolver::is_small(const Problem& problem) {
  sizes_.clear();
  for (int body = 0; body < problem.body_count(); ++body) sizes_.push_back(problem.equations(body).size());
  return std::ranges::all_of(sizes_, [](int size) { return size <= most_dofs_of_body; });
}

// Returns the velocity change by a unit impulse; 0: none.
double NewtonSolver::response_of(const Row& row) {
  const double inverse = row.limits == Row::Limits::cone ? row.cone_inverse : row.inverse;
  return inverse > 0.0 ? 1.0 / inverse : 0.0;
}

// Returns what the heavier of two bodies contributes to the response of a row.
double NewtonSolver::response_of_heavier(const Row& row, double response) const {
  const double* jacobian = problem_->numbers() + row.numbers;
  const double of_a = dot(jacobian, jacobian + row.stride_a, row.stride_a);
  const double least = row.body_b < 0 ? of_a : std::min(of_a, response - of_a);
  return least > immovable ? least : response;
}

void NewtonSolver::gather() {
  const std::vector<Row>& rows = problem_->rows();
  impulses_.assign(rows.size(), 0.0);
  terms_.clear();
  double least_response = unlimited;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const double response = response_of(row);
    if (row.limits == Row::Limits::coned || response == 0.0) continue;
    if (row.is_of_force) least_response = std::min(least_response, response_of_heavier(row, response));
    Term& term = terms_.emplace_back();
    term.row = i;
    term.lower = row.lower;
    term.upper = row.upper;
    if (row.limits == Row::Limits::cone) term.count = 2;
    for (std::size_t k = 0; k < term.count; ++k) impulses_[i + k] = term.impulse[k] = rows[i + k].impulse;
    term.compliance = response;
  }
  for (Term& term : terms_) soften(term, term.compliance, least_response);
  update_limits();
}

// `response`: what the bodies yield to a unit impulse. `least`: what the heaviest body yields.
void NewtonSolver::soften(Term& term, double response, double least) {
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

// Starts from the impulses of the last step.
void NewtonSolver::start() {
  matrix_.reset(sizes_);
  velocity_.resize(matrix_.length());
  momentum_.assign(matrix_.length(), 0.0);
  for (int body = 0; body < problem_->body_count(); ++body)
    std::copy_n(problem_->equations(body).velocity(), problem_->equations(body).stride(),
                velocity_.data() + matrix_.offset(body));
  for (std::size_t i = 0; i < impulses_.size(); ++i) {
    if (impulses_[i] == 0.0) continue;
    const Row& row = problem_->rows()[i];
    const double* numbers = problem_->numbers() + row.numbers;
    for (const int body : {row.body_a, row.body_b}) {
      if (body < 0) continue;
      const std::ptrdiff_t stride = problem_->equations(body).stride();
      add_scaled(impulses_[i], numbers, momentum_.data() + matrix_.offset(body), stride);
      add_scaled(impulses_[i], numbers + stride, velocity_.data() + matrix_.offset(body), stride);
      numbers += 2 * stride;
    }
  }
  for (Term& term : terms_)
    for (std::size_t i = 0; i < term.count; ++i) term.velocity[i] = along(row(term, i), velocity_);
  guess_loads();
}

// The loads of new contacts are not known yet; those that would stop the bodies are a first guess.
void NewtonSolver::guess_loads() {
  for (Term& term : terms_) {
    const Row& of = row(term);
    if (of.has_fixed_limits() || term.upper > 0.0) continue;
    double load = 0.0;
    for (int j = of.load_begin; j < of.load_end; ++j) {
      const Row& other = problem_->rows()[at(j)];
      load += std::max(0.0, (other.target - along(other, velocity_)) * other.inverse);
    }
    term.upper = std::min(of.cap, of.friction * load);
    term.lower = -term.upper;
  }
}

double NewtonSolver::along(const Row& row, const std::vector<double>& velocities) const {
  const double* jacobian = problem_->numbers() + row.numbers;
  double sum = dot(jacobian, velocities.data() + matrix_.offset(row.body_a), row.stride_a);
  if (row.body_b >= 0)
    sum += dot(jacobian + 2 * row.stride_a, velocities.data() + matrix_.offset(row.body_b), row.stride_b);
  return sum;
}

// Returns whether the impulses of the last step solve this one.
bool NewtonSolver::is_settled(double negligible) const {
  for (const Term& term : terms_) {
    std::array<double, 2> error{};
    for (std::size_t i = 0; i < term.count; ++i)
      error[i] = term.velocity[i] - row(term, i).target + term.forgotten * term.compliance * impulses_[term.row + i];
    const double response = response_of(row(term));
    if (term.count == 1) {
      const double impulse = impulses_[term.row];
      if (std::max(term.lower - impulse, impulse - term.upper) * response > negligible) return false;
      if (error[0] > negligible && impulse > term.lower) return false;
      if (error[0] < -negligible && impulse < term.upper) return false;
      continue;
    }
    const std::array<double, 2> impulse{impulses_[term.row], impulses_[term.row + 1]};
    const double length = length_of(impulse[0], impulse[1]);
    if ((length - term.upper) * response > negligible) return false;
    const double sliding = length > 0.0 ? -(error[0] * impulse[0] + error[1] * impulse[1]) / length : 0.0;
    if (length >= term.upper && sliding > 0.0)
      for (std::size_t i = 0; i < 2; ++i) error[i] += sliding * impulse[i] / length;
    if ((length > 0.0 || term.upper > 0.0) && length_of(error[0], error[1]) > negligible) return false;
  }
  return true;
}

// Returns false if a factorisation would cost too much.
bool NewtonSolver::prepare() {
  for (const Row& row : problem_->rows())
    if (row.body_b >= 0) matrix_.couple(row.body_a, row.body_b);
  if (!matrix_.order(most_elimination_work)) return false;
  is_factorised_ = false;
  for (Term& term : terms_) {
    const Row& first = row(term);
    term.blocks[0] = matrix_.block(first.body_a, first.body_a);
    if (first.body_b < 0) continue;
    term.blocks[1] = matrix_.block(first.body_b, first.body_b);
    term.blocks[2] = matrix_.block(first.body_a, first.body_b);
  }
  inertia_.clear();
  begin_.clear();
  for (int body = 0; body < problem_->body_count(); ++body) {
    const Equations& equations = problem_->equations(body);
    begin_.push_back(inertia_.size());
    inertia_.resize(inertia_.size() + at(equations.size() * equations.stride()), 0.0);
    equations.add_inertia(inertia_.data() + begin_.back());
  }
  return true;
}

// Finds minima until the rows do not yield any more. Returns false if it does not even find the first.
bool NewtonSolver::follow(double negligible) {
  int steps_left = most_steps;
  for (int minimum = 0; minimum < most_minima; ++minimum) {
    double moved = 0.0;
    if (!minimise(negligible, steps_left, moved)) {
      velocity_ = found_;
      return minimum > 0;
    }
    found_ = velocity_;
    for (const Term& term : terms_)
      for (std::size_t i = 0; i < term.count; ++i) impulses_[term.row + i] = term.impulse[i];
    const double yielded = update_guesses();
    const double limits = update_limits();
    if (minimum > 0 && moved <= negligible) return true;
    if (yielded <= negligible && limits <= limits_tolerance * negligible) return true;
  }
  return true;
}

// Returns false if no minimum was found in the steps that are left.
bool NewtonSolver::minimise(double negligible, int& steps_left, double& moved) {
  bool is_whole = false;
  for (; steps_left > 0; --steps_left) {
    const bool is_same = evaluate();
    if (is_whole && is_same) return true;
    if (!is_factorised_ || !is_same) factorise();
    const double greatest = find_step();
    moved = std::max(moved, greatest);
    const bool is_last = greatest <= negligible;
    const double share = is_last ? 1.0 : find_share();
    add_step(share);
    if (is_last) {
      evaluate();
      return true;
    }
    is_whole = share == 1.0;
  }
  return false;
}

void NewtonSolver::add_step(double share) {
  add_scaled(share, step_.data(), velocity_.data(), static_cast<std::ptrdiff_t>(velocity_.size()));
  add_scaled(share, step_momentum_.data(), momentum_.data(), static_cast<std::ptrdiff_t>(momentum_.size()));
  for (Term& term : terms_)
    for (std::size_t i = 0; i < term.count; ++i) term.velocity[i] += share * term.change[i];
}

// Computes the impulse at a share of the step, and its derivative.
void NewtonSolver::evaluate(Term& term, double share) const {
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

// Computes all impulses. Returns whether the present factors belong to their derivatives.
bool NewtonSolver::evaluate() {
  bool is_same = true;
  for (Term& term : terms_) {
    evaluate(term, 0.0);
    is_same = is_same && term.stiffness == term.factorised;
  }
  return is_same;
}

void NewtonSolver::factorise() {
  matrix_.clear();
  for (int body = 0; body < problem_->body_count(); ++body) {
    double* const into = matrix_.values(matrix_.block(body, body));
    const std::ptrdiff_t stride = problem_->equations(body).stride();
    std::copy_n(inertia_.data() + begin_[at(body)], sizes_[at(body)] * stride, into);
  }
  for (Term& term : terms_) {
    add_outer_products(term);
    term.factorised = term.stiffness;
  }
  matrix_.factorise();
  is_factorised_ = true;
}

void NewtonSolver::add_outer_products(const Term& term) {
  const auto add = [](double factor, const double* rows, int count, const double* columns, std::ptrdiff_t stride,
                      double* into) {
    for (int r = 0; r < count; ++r)
      if (rows[r] != 0.0) add_scaled(factor * rows[r], columns, into + r * stride, stride);
  };
  const auto add_lower = [](double factor, const double* rows, int count, const double* columns, std::ptrdiff_t stride,
                            double* into) {
    for (int r = 0; r < count; ++r)
      if (rows[r] != 0.0) add_scaled(factor * rows[r], columns, into + r * stride, (r / lanes + 1) * lanes);
  };
  const auto add_rows = [&](double stiffness, const Row& one, const Row& two) {
    if (stiffness == 0.0) return;
    const double* of_one = problem_->numbers() + one.numbers;
    const double* of_two = problem_->numbers() + two.numbers;
    add_lower(stiffness, of_one, sizes_[at(one.body_a)], of_two, one.stride_a, matrix_.values(term.blocks[0]));
    if (one.body_b < 0) return;
    const double* b_of_one = of_one + 2 * one.stride_a;
    const double* b_of_two = of_two + 2 * one.stride_a;
    add_lower(stiffness, b_of_one, sizes_[at(one.body_b)], b_of_two, one.stride_b, matrix_.values(term.blocks[1]));
    const bool is_a_later = term.blocks[2].row == one.body_a;
    add(stiffness, is_a_later ? of_one : b_of_one, sizes_[at(term.blocks[2].row)], is_a_later ? b_of_two : of_two,
        is_a_later ? one.stride_b : one.stride_a, matrix_.values(term.blocks[2]));
  };
  add_rows(term.stiffness[0], row(term), row(term));
  if (term.count == 1) return;
  add_rows(term.stiffness[1], row(term, 1), row(term, 1));
  add_rows(term.stiffness[2], row(term), row(term, 1));
  add_rows(term.stiffness[2], row(term, 1), row(term));
}

double NewtonSolver::find_step() {
  step_.resize(momentum_.size());
  for (std::size_t i = 0; i < step_.size(); ++i) step_[i] = -momentum_[i];
  for (const Term& term : terms_)
    for (std::size_t i = 0; i < term.count; ++i) {
      const Row& of = row(term, i);
      const double* jacobian = problem_->numbers() + of.numbers;
      add_scaled(term.impulse[i], jacobian, step_.data() + matrix_.offset(of.body_a), of.stride_a);
      if (of.body_b >= 0)
        add_scaled(term.impulse[i], jacobian + 2 * of.stride_a, step_.data() + matrix_.offset(of.body_b), of.stride_b);
    }
  matrix_.solve(step_.data());
  step_momentum_.assign(step_.size(), 0.0);
  for (int body = 0; body < problem_->body_count(); ++body) {
    const std::ptrdiff_t stride = problem_->equations(body).stride();
    for (int r = 0; r < sizes_[at(body)]; ++r)
      step_momentum_[matrix_.offset(body) + at(r)] =
          dot(inertia_.data() + begin_[at(body)] + r * stride, step_.data() + matrix_.offset(body), stride);
  }
  double greatest = 0.0;
  for (Term& term : terms_)
    for (std::size_t i = 0; i < term.count; ++i) {
      term.change[i] = along(row(term, i), step_);
      greatest = std::max(greatest, std::abs(term.change[i]));
    }
  return greatest;
}

// Computes the derivative of the function along the step at a share of it.
double NewtonSolver::slope(double share, double* curvature) {
  const auto length = static_cast<std::ptrdiff_t>(step_.size());
  *curvature = dot(step_.data(), step_momentum_.data(), length);
  double sum = dot(step_.data(), momentum_.data(), length) + share * *curvature;
  for (Term& term : terms_) {
    evaluate(term, share);
    const auto& [first, second] = term.change;
    sum -= term.impulse[0] * first;
    *curvature += term.stiffness[0] * first * first;
    if (term.count == 1) continue;
    sum -= term.impulse[1] * second;
    *curvature += term.stiffness[1] * second * second + 2.0 * term.stiffness[2] * first * second;
  }
  return sum;
}

// Finds the share of the step at which the function is least.
double NewtonSolver::find_share() {
  double curvature = 0.0;
  const double at_start = slope(0.0, &curvature);
  const double enough = flat * std::abs(at_start);
  double low = 0.0;
  double high = 1.0;
  double share = 1.0;
  for (int i = 0; i < most_shares; ++i) {
    const double there = slope(share, &curvature);
    if (std::abs(there) <= enough || (share == 1.0 && there <= 0.0)) break;
    (there < 0.0 ? low : high) = share;
    share -= there / curvature;
    if (!(share > low && share < high)) share = 0.5 * (low + high);
  }
  return share;
}

// Takes the impulses as the next guess. Returns the greatest velocity by which a row has yielded to a change of its
// impulse.
double NewtonSolver::update_guesses() {
  double greatest = 0.0;
  for (Term& term : terms_) {
    for (std::size_t i = 0; i < term.count; ++i) {
      const double guess = (1.0 - term.forgotten) * term.impulse[i];
      if (term.is_free) greatest = std::max(greatest, term.compliance * std::abs(guess - term.guess[i]));
      term.guess[i] = guess;
    }
  }
  return greatest;
}

// Computes the limits of friction from the impulses. Returns the greatest change of one that is reached, as the
// velocity change of a free body.
double NewtonSolver::update_limits() {
  double greatest = 0.0;
  for (Term& term : terms_) {
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

void NewtonSolver::apply() {
  for (const Term& term : terms_) {
    for (std::size_t i = 0; i < term.count; ++i) {
      Row& of = problem_->rows()[term.row + i];
      of.impulse = impulses_[term.row + i];
      of.set_limits(term.lower, term.upper);
    }
  }
  for (Row& row : problem_->rows())
    if (row.inverse == 0.0) row.impulse = 0.0;
  for (int body = 0; body < problem_->body_count(); ++body)
    std::copy_n(velocity_.data() + matrix_.offset(body), problem_->equations(body).stride(),
                problem_->equations(body).velocity());
}

}  // namespace cohort::physics
