#include "server/physics/solvers/group_solver.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::physics {
namespace {

// Number of solutions, each with friction limits from the loads of the previous one, and of guesses for each solution.
constexpr int most_solutions = 12;
constexpr int most_guesses = 12;
constexpr double limit_tolerance = 1e-7;  // [N s or N m s]
// Multiplications of one factorisation; above this number, sequential impulses are cheaper.
constexpr double most_work = 3e6;
// Compliance of each row as a share of its own response. Without it, legs on the floor have no unique loads, and
// connections that form a loop contradict each other by the sum of their gaps.
constexpr double give = 1e-5;
constexpr double give_between_bodies = 1e-4;
constexpr double velocity_tolerance = 1e-9;  // [m/s or rad/s]
constexpr double impulse_tolerance = 1e-11;  // [N s or N m s]

}  // namespace

bool GroupSolver::solve(Problem& problem) {
  count_ = problem.row_count();
  rows_ = &problem.rows();
  order_bodies(problem);
  order_rows(problem);
  if (!find_envelope(problem)) return false;
  gather(problem);
  place_by_last_impulses();
  is_factorised_ = false;
  for (int solution = 0; solution < most_solutions; ++solution) {
    if (!solve_within_limits()) return false;
    if (set_limits() <= limit_tolerance) break;
  }
  apply(problem);
  return true;
}

// Solves with fixed limits: a linear complementarity problem. All rows that disagree with their place move at once
// while that reduces their number, otherwise one at a time. Source: Judice and Pires, "A block principal pivoting
// algorithm for large-scale strictly monotone linear complementarity problems", Computers and Operations Research 21,
// 1994.
bool GroupSolver::solve_within_limits() {
  constexpr int most_blocks_in_vain = 3;
  int fewest = count_ + 1;
  int blocks_left = most_blocks_in_vain;
  for (int guess = 0; guess < most_guesses; ++guess) {
    if (!is_factorised_) factorise();
    solve_between();
    const int wrong = find_wrong_places();
    if (wrong == 0) return true;
    if (wrong < fewest) {
      fewest = wrong;
      blocks_left = most_blocks_in_vain;
    } else {
      --blocks_left;
    }
    bool goes_on = true;
    for (int p = count_ - 1; p >= 0 && goes_on; --p) {
      if (places_[at(p)] == better_[at(p)]) continue;
      places_[at(p)] = better_[at(p)];
      goes_on = blocks_left >= 0;
    }
    is_factorised_ = false;
  }
  return false;
}

// Orders the bodies by Cuthill and McKee: breadth first from a body with few neighbours, so that coupled bodies have
// similar ranks.
void GroupSolver::order_bodies(const Problem& problem) {
  const int bodies = problem.body_count();
  if (neighbours_.size() < at(bodies)) neighbours_.resize(at(bodies));
  for (int body = 0; body < bodies; ++body) neighbours_[at(body)].clear();
  for (const Row& row : *rows_) {
    if (row.body_b < 0) continue;
    std::vector<int>& of_a = neighbours_[at(row.body_a)];
    if (std::find(of_a.begin(), of_a.end(), row.body_b) != of_a.end()) continue;
    of_a.push_back(row.body_b);
    neighbours_[at(row.body_b)].push_back(row.body_a);
  }
  const auto has_fewer = [&](int one, int two) {
    const std::size_t first = neighbours_[at(one)].size();
    const std::size_t second = neighbours_[at(two)].size();
    return first != second ? first < second : one < two;
  };
  rank_.assign(at(bodies), -1);
  queue_.clear();
  while (queue_.size() < at(bodies)) {
    int root = -1;
    for (int body = 0; body < bodies; ++body)
      if (rank_[at(body)] < 0 && (root < 0 || has_fewer(body, root))) root = body;
    std::size_t next = queue_.size();
    rank_[at(root)] = static_cast<int>(queue_.size());
    queue_.push_back(root);
    for (; next < queue_.size(); ++next) {
      std::vector<int>& around = neighbours_[at(queue_[next])];
      std::sort(around.begin(), around.end(), has_fewer);
      for (const int body : around) {
        if (rank_[at(body)] >= 0) continue;
        rank_[at(body)] = static_cast<int>(queue_.size());
        queue_.push_back(body);
      }
    }
  }
}

// Orders rows by the later of their two bodies.
void GroupSolver::order_rows(const Problem& problem) {
  const auto rank_of = [&](const Row& row) {
    return std::max(rank_[at(row.body_a)], row.body_b < 0 ? -1 : rank_[at(row.body_b)]);
  };
  row_of_.clear();
  queue_.assign(at(problem.body_count()) + 1, 0);  // reused: start of the rows of each rank
  for (const Row& row : *rows_) ++queue_[at(rank_of(row)) + 1];
  for (std::size_t rank = 1; rank < queue_.size(); ++rank) queue_[rank] += queue_[rank - 1];
  row_of_.resize(at(count_));
  position_of_.resize(at(count_));
  for (int i = 0; i < count_; ++i) {
    const int position = queue_[at(rank_of((*rows_)[at(i)]))]++;
    row_of_[at(position)] = i;
    position_of_[at(i)] = position;
  }
}

// Returns false if the factorisation would cost too much.
bool GroupSolver::find_envelope(const Problem& problem) {
  first_position_.assign(at(problem.body_count()), count_);
  for (int p = 0; p < count_; ++p) {
    const Row& row = (*rows_)[at(row_of_[at(p)])];
    for (const int body : {row.body_a, row.body_b})
      if (body >= 0) first_position_[at(body)] = std::min(first_position_[at(body)], p);
  }
  start_.resize(at(count_));
  begin_.resize(at(count_));
  std::size_t size = 0;
  double work = 0.0;
  for (int p = 0; p < count_; ++p) {
    const Row& row = (*rows_)[at(row_of_[at(p)])];
    start_[at(p)] = first_position_[at(row.body_a)];
    if (row.body_b >= 0) start_[at(p)] = std::min(start_[at(p)], first_position_[at(row.body_b)]);
    begin_[at(p)] = size;
    const double width = p - start_[at(p)] + 1;
    size += at(p - start_[at(p)] + 1);
    work += 0.5 * width * width;
  }
  if (work > most_work) return false;
  gains_.assign(size, 0.0);
  factors_.resize(size);
  return true;
}

void GroupSolver::gather(const Problem& problem) {
  wanted_.resize(at(count_));
  impulses_.resize(at(count_));
  for (int p = 0; p < count_; ++p) {
    const Row& row = (*rows_)[at(row_of_[at(p)])];
    wanted_[at(p)] = row.target - problem.velocity(row);
    impulses_[at(p)] = row.impulse;
    const double* jacobian_a = problem.numbers() + row.numbers;
    const double* jacobian_b = jacobian_a + 2 * row.stride_a;
    for (int q = start_[at(p)]; q <= p; ++q) {
      const Row& other = (*rows_)[at(row_of_[at(q)])];
      const double* response_a = problem.numbers() + other.numbers + other.stride_a;
      const double* response_b = response_a + other.stride_a + other.stride_b;
      double sum = 0.0;
      if (row.body_a == other.body_a) sum += dot(jacobian_a, response_a, row.stride_a);
      if (row.body_a == other.body_b) sum += dot(jacobian_a, response_b, row.stride_a);
      if (row.body_b >= 0 && row.body_b == other.body_a) sum += dot(jacobian_b, response_a, row.stride_b);
      if (row.body_b >= 0 && row.body_b == other.body_b) sum += dot(jacobian_b, response_b, row.stride_b);
      gain(p, q) = sum;
    }
    double& own = gain(p, p);
    own += own * (row.body_b < 0 ? give : give_between_bodies) + row.softness;
  }
}

void GroupSolver::place_by_last_impulses() {
  places_.assign(at(count_), Place::between);
  lower_.assign(at(count_), 0.0);
  upper_.assign(at(count_), 0.0);
  set_limits();
  for (int p = 0; p < count_; ++p) {
    const bool is_idle = (*rows_)[at(row_of_[at(p)])].inverse == 0.0;
    if (is_idle || impulses_[at(p)] <= lower_[at(p)]) {
      places_[at(p)] = Place::lower;
    } else if (impulses_[at(p)] >= upper_[at(p)]) {
      places_[at(p)] = Place::upper;
    }
  }
}

// Computes limits from the present impulses. Returns the greatest change of the limit of a row that is at it.
double GroupSolver::set_limits() {
  double greatest = 0.0;
  for (int p = 0; p < count_; ++p) {
    const Row* row = &(*rows_)[at(row_of_[at(p)])];
    if (row->inverse == 0.0) continue;  // both limits are zero
    if (row->has_fixed_limits()) {
      lower_[at(p)] = row->lower;
      upper_[at(p)] = row->upper;
      continue;
    }
    if (row->limits == Row::Limits::coned) --row;  // it shares the limit of the row before
    double load = 0.0;
    for (int j = row->load_begin; j < row->load_end; ++j) load += impulses_[at(position_of_[at(j)])];
    const double limit = std::max(0.0, std::min(row->cap, row->friction * load));
    // A row between its old limits may be beyond the new ones.
    if (places_[at(p)] != Place::between || std::abs(impulses_[at(p)]) > limit)
      greatest = std::max(greatest, std::abs(limit - upper_[at(p)]));
    lower_[at(p)] = -limit;
    upper_[at(p)] = limit;
  }
  return greatest;
}

// Computes the factors L D L' of the free rows.
void GroupSolver::factorise() {
  inverse_.assign(at(count_), 0.0);
  for (int p = 0; p < count_; ++p) {
    const int start = start_[at(p)];
    double* const factors = factors_.data() + begin_[at(p)];  // first L D, then L; column q is at q - start
    if (places_[at(p)] != Place::between) {
      std::fill_n(factors, p - start + 1, 0.0);
      continue;
    }
    for (int q = start; q < p; ++q) {
      if (places_[at(q)] != Place::between) {
        factors[q - start] = 0.0;
        continue;
      }
      const int from = std::max(start, start_[at(q)]);
      const double* const theirs = factors_.data() + begin_[at(q)] + (from - start_[at(q)]);
      const double* const ours = factors + (from - start);
      double value = gain(p, q);
      for (int k = 0; k < q - from; ++k) value -= ours[k] * theirs[k];
      factors[q - start] = value;
    }
    double diagonal = gain(p, p);
    for (int q = start; q < p; ++q) {
      const double factor = factors[q - start] * inverse_[at(q)];
      diagonal -= factor * factors[q - start];
      factors[q - start] = factor;
    }
    inverse_[at(p)] = 1.0 / diagonal;
  }
  is_factorised_ = true;
}

// Computes the impulses of the free rows, with the others at their limits.
void GroupSolver::solve_between() {
  x_ = wanted_;
  for (int p = 0; p < count_; ++p)
    if (places_[at(p)] != Place::between)
      impulses_[at(p)] = places_[at(p)] == Place::lower ? lower_[at(p)] : upper_[at(p)];
  for (int p = 0; p < count_; ++p) {
    const bool is_bound = places_[at(p)] != Place::between;
    for (int q = start_[at(p)]; q < p; ++q) {
      const bool other_is_bound = places_[at(q)] != Place::between;
      if (other_is_bound && !is_bound) x_[at(p)] -= gain(p, q) * impulses_[at(q)];
      if (is_bound && !other_is_bound) x_[at(q)] -= gain(p, q) * impulses_[at(p)];
    }
  }
  for (int p = 0; p < count_; ++p) {
    if (places_[at(p)] != Place::between) continue;
    const double* const factors = factors_.data() + begin_[at(p)];
    for (int q = start_[at(p)]; q < p; ++q) x_[at(p)] -= factors[q - start_[at(p)]] * x_[at(q)];
  }
  for (int p = 0; p < count_; ++p) x_[at(p)] *= inverse_[at(p)];  // zero for rows at a limit
  for (int p = count_ - 1; p >= 0; --p) {
    if (places_[at(p)] != Place::between) continue;
    impulses_[at(p)] = x_[at(p)];
    const double* const factors = factors_.data() + begin_[at(p)];
    for (int q = start_[at(p)]; q < p; ++q) x_[at(q)] -= factors[q - start_[at(p)]] * x_[at(p)];
  }
}

// Returns the number of rows that disagree with their place, and finds the new place of each.
int GroupSolver::find_wrong_places() {
  x_ = wanted_;  // the velocity error
  for (int p = 0; p < count_; ++p) {
    x_[at(p)] -= gain(p, p) * impulses_[at(p)];
    for (int q = start_[at(p)]; q < p; ++q) {
      x_[at(p)] -= gain(p, q) * impulses_[at(q)];
      x_[at(q)] -= gain(p, q) * impulses_[at(p)];
    }
  }
  int wrong = 0;
  better_ = places_;
  for (int p = 0; p < count_; ++p) {
    Place& place = better_[at(p)];
    if (place == Place::between) {
      if (impulses_[at(p)] < lower_[at(p)] - impulse_tolerance) place = Place::lower;
      if (impulses_[at(p)] > upper_[at(p)] + impulse_tolerance) place = Place::upper;
    } else if (lower_[at(p)] < upper_[at(p)]) {
      if (place == Place::lower && x_[at(p)] > velocity_tolerance) place = Place::between;
      if (place == Place::upper && x_[at(p)] < -velocity_tolerance) place = Place::between;
    }
    if (place != places_[at(p)]) ++wrong;
  }
  return wrong;
}

void GroupSolver::apply(Problem& problem) {
  for (int p = 0; p < count_; ++p) {
    Row& row = problem.rows()[at(row_of_[at(p)])];
    row.impulse = impulses_[at(p)];
    row.set_limits(lower_[at(p)], upper_[at(p)]);
    const double* response = problem.numbers() + row.numbers + row.stride_a;
    add_scaled(row.impulse, response, row.velocity_a, row.stride_a);
    if (row.velocity_b != nullptr)
      add_scaled(row.impulse, response + row.stride_a + row.stride_b, row.velocity_b, row.stride_b);
  }
}

}  // namespace cohort::physics
