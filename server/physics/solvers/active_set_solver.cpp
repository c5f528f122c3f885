#include "server/physics/solvers/active_set_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "server/physics/mechanism/linear_system.hpp"

namespace cohort::physics {
namespace {

constexpr int most_rows = 16;

enum class Place : std::uint8_t { between, lower, upper };

class Guessing {
 public:
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): of each array only the first `count_` are ever read.
  explicit Guessing(Problem& problem)
      : problem_(problem),
        rows_(problem.rows()),
        count_(problem.row_count()),
        is_symmetric_(problem.equations(0).is_symmetric()) {
    for (int i = 0; i < count_; ++i) {
      const Row& row = row_at(i);
      const double* jacobian = problem.numbers() + row.numbers;
      wanted_[i] = row.target - dot(jacobian, row.velocity_a, row.stride_a);
      for (int j = 0; j <= i; ++j) gains_[i][j] = gains_[j][i] = gain(i, j);
      if (!is_symmetric_)
        for (int j = 0; j < i; ++j) gains_[j][i] = gain(j, i);
      gains_[i][i] *= 1.0 + give;
      gains_[i][i] += row.softness;
      impulses_[i] = row.impulse;
    }
    std::fill_n(places_.begin(), count_, Place::between);
    set_limits();
    for (int i = 0; i < count_; ++i) {
      if (impulses_[i] <= lower_[i] || row_at(i).inverse == 0.0) {
        places_[i] = Place::lower;
      } else {
        places_[i] = impulses_[i] >= upper_[i] ? Place::upper : Place::between;
      }
    }
  }

  bool run() {
    for (int guess = 0; guess < most_guesses; ++guess) {
      divide();
      is_symmetric_ ? solve() : solve_skew();
      const bool limits_hold = set_limits();
      if (places_hold() && limits_hold) return true;
    }
    return false;
  }

  void apply() {
    for (int i = 0; i < count_; ++i) {
      Row& row = rows_[static_cast<std::size_t>(i)];
      row.impulse = impulses_[i];
      row.set_limits(lower_[i], upper_[i]);
      add_scaled(row.impulse, problem_.numbers() + row.numbers + row.stride_a, row.velocity_a, row.stride_a);
    }
  }

 private:
  static constexpr int most_guesses = 6;
  // Compliance of each row as a share of its own response; without it, four legs on the floor have no unique loads.
  static constexpr double give = 1e-5;
  static constexpr double velocity_tolerance = 1e-10;  // [m/s or rad/s]
  static constexpr double impulse_tolerance = 1e-12;   // [N s or N m s]

  // Returns the velocity of row i by a unit impulse in row j.
  double gain(int i, int j) const {
    const Row& other = row_at(j);
    return dot(problem_.numbers() + row_at(i).numbers, problem_.numbers() + other.numbers + other.stride_a,
               other.stride_a);
  }
  const Row& row_at(int i) const { return rows_[static_cast<std::size_t>(i)]; }

  // Computes limits from the present impulses. Returns false if that moved the limit of a row that is at it.
  bool set_limits() {
    bool hold = true;
    for (int i = 0; i < count_; ++i) {
      const Row& row = row_at(i);
      if (row.has_fixed_limits()) {
        lower_[i] = row.lower;
        upper_[i] = row.upper;
        continue;
      }
      double load = 0.0;
      for (int j = row.load_begin; j < row.load_end; ++j) load += impulses_[j];
      const double limit = std::max(0.0, std::min(row.cap, row.friction * load));
      if (places_[i] != Place::between && std::abs(limit - upper_[i]) > impulse_tolerance) hold = false;
      lower_[i] = -limit;
      upper_[i] = limit;
    }
    return hold;
  }

  void divide() {
    free_count_ = bound_count_ = 0;
    for (int i = 0; i < count_; ++i) {
      if (places_[i] == Place::between) {
        free_[free_count_++] = i;
      } else {
        bound_[bound_count_++] = i;
        impulses_[i] = places_[i] == Place::lower ? lower_[i] : upper_[i];
      }
    }
  }
  // Returns the velocity that remains for a free row after the rows at their limits have acted.
  double left_for(int row) const {
    double left = wanted_[row];
    for (int j = 0; j < bound_count_; ++j) left -= gains_[row][bound_[j]] * impulses_[bound_[j]];
    return left;
  }

  // Solves for the impulses of the free rows by the factors L D L' of their gains.
  void solve() {
    std::array<double, most_rows> x{};
    std::array<double, most_rows> inverse{};  // inverse of D
    for (int i = 0; i < free_count_; ++i) {
      const auto& gains = gains_[free_[i]];
      double right = left_for(free_[i]);
      auto& factors = factors_[i];  // first L D, then L
      double diagonal = gains[free_[i]];
      for (int j = 0; j < i; ++j) {
        double value = gains[free_[j]];
        for (int k = 0; k < j; ++k) value -= factors[k] * factors_[j][k];
        factors[j] = value;
      }
      for (int j = 0; j < i; ++j) {
        const double factor = factors[j] * inverse[j];
        diagonal -= factor * factors[j];
        right -= factor * x[j];
        factors[j] = factor;
      }
      inverse[i] = 1.0 / diagonal;
      x[i] = right;
    }
    for (int i = free_count_ - 1; i >= 0; --i) {
      double value = x[i] * inverse[i];
      for (int j = i + 1; j < free_count_; ++j) value -= factors_[j][i] * x[j];
      x[i] = value;
      impulses_[free_[i]] = value;
    }
  }

  // Does the same for gains that are not symmetric.
  void solve_skew() {
    LinearSystem system;
    system.reset(free_count_);
    std::array<double, most_rows> x{};
    for (int i = 0; i < free_count_; ++i) {
      x[i] = left_for(free_[i]);
      for (int j = 0; j < free_count_; ++j) system(i, j) = gains_[free_[i]][free_[j]];
    }
    system.factorise();
    system.solve(x.data());
    for (int i = 0; i < free_count_; ++i) impulses_[free_[i]] = x[i];
  }

  // Returns whether the impulses agree with the guess; otherwise moves the rows that do not.
  bool places_hold() {
    bool hold = true;
    for (int i = 0; i < count_; ++i) {
      if (places_[i] == Place::between) {
        if (impulses_[i] < lower_[i] - impulse_tolerance) {
          places_[i] = Place::lower;
          hold = false;
        } else if (impulses_[i] > upper_[i] + impulse_tolerance) {
          places_[i] = Place::upper;
          hold = false;
        }
        continue;
      }
      if (lower_[i] == upper_[i] || row_at(i).inverse == 0.0) continue;
      double missing = wanted_[i];
      for (int j = 0; j < count_; ++j) missing -= gains_[i][j] * impulses_[j];
      if (places_[i] == Place::lower ? missing > velocity_tolerance : missing < -velocity_tolerance) {
        places_[i] = Place::between;
        hold = false;
      }
    }
    return hold;
  }

  Problem& problem_;
  std::vector<Row>& rows_;
  int count_;
  bool is_symmetric_;
  int free_count_ = 0;
  int bound_count_ = 0;
  std::array<std::array<double, most_rows>, most_rows> gains_;  // velocity of row i by a unit impulse in row j
  std::array<std::array<double, most_rows>, most_rows> factors_;
  std::array<int, most_rows> free_;   // rows between their limits
  std::array<int, most_rows> bound_;  // rows at a limit
  std::array<double, most_rows> wanted_;
  std::array<double, most_rows> impulses_;
  std::array<double, most_rows> lower_;
  std::array<double, most_rows> upper_;
  std::array<Place, most_rows> places_;
};

}  // namespace

bool solve_by_active_set(Problem& problem) {
  if (problem.body_count() != 1 || problem.row_count() > most_rows) return false;
  const auto is_cone = [](const Row& row) { return row.limits == Row::Limits::cone; };
  if (std::any_of(problem.rows().begin(), problem.rows().end(), is_cone)) return false;
  Guessing guessing(problem);
  if (!guessing.run()) return false;
  guessing.apply();
  return true;
}

}  // namespace cohort::physics
