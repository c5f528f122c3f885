#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/physics/multibody/rows.hpp"

namespace cohort::physics {

/// Solves the rows of connected bodies at once by an active-set method, as solve_by_active_set does for one body. It
/// guesses which rows are at a limit, starting with those of the last step, and solves the others as linear equations.
/// The guess is corrected until every row agrees with it. It is for connections at light links, such as an arm that
/// lifts a robot, where sequential impulses need hundreds of passes. Friction in a disc is a pyramid here, as in
/// solve_directly.
///
/// The equations are factorised within their envelope (George and Liu, "Computer solution of large sparse positive
/// definite systems", 1981, chapter 4). The bodies are in the order of Cuthill and McKee. The cost grows linearly with
/// the number of rows if bodies form a chain or a tree. Reuses its memory; each worker has one.
class GroupSolver {
 public:
  /// Returns false, without any change, if it would cost too much or no guess was right.
  bool solve(Problem& problem);

 private:
  enum class Place : std::uint8_t { between, lower, upper };
  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

  void order_bodies(const Problem& problem);
  void order_rows(const Problem& problem);
  bool find_envelope(const Problem& problem);
  void gather(const Problem& problem);
  void place_by_last_impulses();
  double set_limits();
  bool solve_within_limits();
  void factorise();
  void solve_between();
  int find_wrong_places();
  void apply(Problem& problem);
  double& gain(int p, int q) { return gains_[begin_[at(p)] + at(q - start_[at(p)])]; }

  int count_ = 0;
  const std::vector<Row>* rows_ = nullptr;
  // By body:
  std::vector<std::vector<int>> neighbours_;
  std::vector<int> rank_;
  std::vector<int> queue_;
  std::vector<int> first_position_;
  // By position: a row's place in the order of elimination:
  std::vector<int> row_of_;
  std::vector<int> position_of_;  // by row
  std::vector<int> start_;        // first position coupled to it
  std::vector<std::size_t> begin_;
  std::vector<double> gains_;    // the envelope of the lower triangle
  std::vector<double> factors_;  // the same envelope
  std::vector<double> wanted_;
  std::vector<double> impulses_;
  std::vector<double> lower_;
  std::vector<double> upper_;
  std::vector<double> inverse_;
  std::vector<double> x_;
  std::vector<Place> places_;
  std::vector<Place> better_;
  bool is_factorised_ = false;
};

}  // namespace cohort::physics
