// SPDX-License-Identifier: Apache-2.0
#include "server/physics/islands/large_island_solver.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "server/physics/islands/island_solver.hpp"
#include "server/physics/solvers/impacts.hpp"
#include "server/physics/solvers/iterative_solver.hpp"

namespace cohort::physics {
namespace {

// A heap that is nearly at rest: passes over everything, and before each of them passes over the loads.
constexpr int most_passes_of_calm = 20;
constexpr int passes_over_loads = 10;
constexpr std::uint32_t bodies_a_part = 32;

// Damping of a heap that is nearly at rest [1/s]: what still rocks there has stopped after a few tenths of a second.
constexpr double damping_of_calm = 10.0;

// Seams for which no colour is free get this last one; its seams are solved one after the other.
constexpr unsigned last_colour = 63;

}  // namespace

void LargeIslandSolver::solve(Assembly& assembly, std::span<const std::uint32_t> members) {
  sound_.clear();
  for (const std::uint32_t member : members)
    if (assembly.members[member].is_awake()) sound_.push_back(member);
  while (!sound_.empty() && !try_to_solve(assembly)) leave_out_broken(sound_, assembly);
}

// Returns false, without moving any body, if one of them has invalid velocities.
bool LargeIslandSolver::try_to_solve(Assembly& assembly) {
  number_bodies(sound_, assembly, bodies_);
  workers_.for_each_chunk(sound_.size(), WorkerPool::fine, [&](std::size_t begin, std::size_t end, unsigned) {
    for (std::size_t i = begin; i < end; ++i) assembly.set_up(sound_[i], bodies_);
  });
  if (!all_are_finite(assembly)) return false;

  const bool is_calm = are_calm(sound_, assembly);
  friction_start_ = is_calm ? FrictionStart::last : FrictionStart::shared;
  cut(assembly);
  workers_.for_each_chunk(parts_.count(), 1, [&](std::size_t part, std::size_t, unsigned) {
    add_rows_of_part(assembly, static_cast<std::uint32_t>(part));
  });
  find_seams();
  colour_seams();
  workers_.for_each_chunk(seams_.size(), 1, [&](std::size_t seam, std::size_t, unsigned) {
    add_rows_of_seam(assembly, seams_[seam], shares_[parts_.count() + seam].problem);
  });
  for (std::size_t phase = 0; phase + 1 < phases_.size(); ++phase)
    for_each_share(phase,
                   [&](Share& share) { rebound_at_once(share.problem, assembly.step * assembly.gravity.norm()); });
  const Passes passes = passes_of(sound_, assembly);
  for (std::size_t phase = 0; phase + 1 < phases_.size(); ++phase)
    for_each_share(phase, [&](Share& share) { SequentialImpulses(share.problem).start(passes.share_of_last); });
  if (is_calm) {
    settle(passes.settled);
    damp(assembly);
  } else {
    make_passes(passes, [&](bool forwards) { return run_pass(forwards, true); });
  }
  if (!all_are_finite(assembly)) return false;

  for (std::size_t phase = 0; phase + 1 < phases_.size(); ++phase)
    for_each_share(phase, [](Share& share) { keep_impulses(share.problem); });
  workers_.for_each_chunk(sound_.size(), WorkerPool::fine, [&](std::size_t begin, std::size_t end, unsigned) {
    for (std::size_t i = begin; i < end; ++i) assembly.integrate(sound_[i], *problem_of_[i]);
  });
  return true;
}

bool LargeIslandSolver::all_are_finite(Assembly& assembly) {
  bool all = true;
  for (const std::uint32_t member : sound_) all = assembly.check(member, bodies_) && all;
  return all;
}

void LargeIslandSolver::damp(const Assembly& assembly) {
  const auto is_left_alone = [&](std::uint32_t index) {
    const Member& member = assembly.members[index];
    return member.multibody->is_inert() && !member.fluid;
  };
  if (!std::ranges::all_of(sound_, is_left_alone)) return;
  const double fall = assembly.step * assembly.gravity.norm();
  const double kept = 1.0 / (1.0 + damping_of_calm * assembly.step);
  for (std::size_t body = 0; body < sound_.size(); ++body) {
    const std::span velocity(bodies_[static_cast<int>(body)].velocity(), 6);  // angular, linear
    const bool is_slow = std::ranges::all_of(velocity.last(3), [&](double v) { return std::abs(v) < fall; });
    if (!is_slow) continue;
    for (double& v : velocity) v *= kept;
  }
}

void LargeIslandSolver::cut(Assembly& assembly) {
  const std::vector<int>& index_of = assembly.anchors.index_of_member;
  parts_.reset(static_cast<std::uint32_t>(sound_.size()));
  for (std::uint32_t body = 0; body < sound_.size(); ++body) {
    assembly.for_each_coupled(sound_[body], [&](std::uint32_t other) {
      if (index_of[other] >= 0) parts_.link(body, static_cast<std::uint32_t>(index_of[other]));
    });
  }
  parts_.cut(bodies_a_part);
  while (shares_.size() < parts_.count()) shares_.emplace_back(bodies_);
  if (crossings_of_part_.size() < parts_.count()) crossings_of_part_.resize(parts_.count());
  problem_of_.resize(sound_.size());
}

// Returns nothing if the other body is in the same part or in none (it was left out, or is the world).
std::optional<LargeIslandSolver::Parts> LargeIslandSolver::parts_across(const Assembly& assembly, std::uint32_t part,
                                                                        std::uint32_t other) const {
  if (other == Anchors::nobody || assembly.anchors.index_of_member[other] < 0) return std::nullopt;
  const std::uint32_t other_part = parts_.part_of(static_cast<std::uint32_t>(assembly.anchors.index_of_member[other]));
  if (other_part == part) return std::nullopt;
  return Parts(std::min(part, other_part), std::max(part, other_part));
}

void LargeIslandSolver::add_rows_of_part(Assembly& assembly, std::uint32_t part) {
  Problem& problem = shares_[part].problem;
  std::vector<Crossing>& crossings = crossings_of_part_[part];
  problem.clear();
  crossings.clear();
  const auto across = [&](std::uint32_t other) { return parts_across(assembly, part, other); };

  for (const std::uint32_t body : parts_.bodies(part)) {
    const std::uint32_t member = sound_[body];
    std::optional<Parts> parts;
    assembly.for_each_ground(member, [&](std::uint32_t under) {
      if (const std::optional<Parts> two = across(under)) parts = parts.value_or(*two) == *two ? *two : several;
    });
    if (parts) {
      crossings.push_back({.parts = *parts, .member = member});
    } else {
      assembly.add_own_rows(member, problem);
      problem_of_[body] = &problem;
    }
  }
  for (const std::uint32_t body : parts_.bodies(part)) {
    assembly.connections.for_each_of(sound_[body], [&](Connection& connection) {
      if (const std::optional<Parts> two = across(connection.b().member))
        crossings.push_back({.parts = *two, .connection = &connection});
      else
        assembly.add_connection_rows(connection, problem);
    });
  }
  for (const std::uint32_t body : parts_.bodies(part)) {
    assembly.for_each_pair(sound_[body], [&](SolidPair& pair) {
      if (const std::optional<Parts> two = across(assembly.anchors.member(pair.b)))
        crossings.push_back({.parts = *two, .pair = &pair});
      else
        assembly.add_contact_rows(pair, problem, friction_start_);
    });
  }
}

// Crossings of the same parts follow each other: own rows, then connections, then contacts, as within a part.
void LargeIslandSolver::find_seams() {
  crossings_.clear();
  for (std::uint32_t part = 0; part < parts_.count(); ++part)
    crossings_.insert(crossings_.end(), crossings_of_part_[part].begin(), crossings_of_part_[part].end());
  const auto rank = [](const Crossing& crossing) {
    return crossing.connection != nullptr ? 1 : crossing.pair != nullptr ? 2 : 0;
  };
  std::stable_sort(crossings_.begin(), crossings_.end(), [&](const Crossing& a, const Crossing& b) {
    return a.parts != b.parts ? a.parts < b.parts : rank(a) < rank(b);
  });
  seams_.clear();
  for (std::size_t i = 0; i < crossings_.size(); ++i) {
    if (i == 0 || crossings_[i].parts != crossings_[i - 1].parts) seams_.push_back({i, i});
    seams_.back().end = i + 1;
  }
}

void LargeIslandSolver::colour_seams() {
  std::vector<std::uint64_t> taken(parts_.count(), 0);  // colours of the seams at a part
  for (Seam& seam : seams_) {
    const Parts& parts = crossings_[seam.begin].parts;
    seam.colour = last_colour;
    if (parts == several) continue;
    std::uint64_t& at_first = taken[parts.first];
    std::uint64_t& at_second = taken[parts.second];
    seam.colour = std::min(static_cast<unsigned>(std::countr_one(at_first | at_second)), last_colour);
    at_first |= std::uint64_t{1} << seam.colour;
    at_second |= std::uint64_t{1} << seam.colour;
  }
  std::stable_sort(seams_.begin(), seams_.end(), [](const Seam& a, const Seam& b) { return a.colour < b.colour; });
  while (shares_.size() < parts_.count() + seams_.size()) shares_.emplace_back(bodies_);
  phases_.assign(1, 0);
  for (std::size_t seam = 0; seam < seams_.size(); ++seam)
    if (seam == 0 || seams_[seam].colour != seams_[seam - 1].colour) phases_.push_back(parts_.count() + seam);
  phases_.push_back(parts_.count() + seams_.size());
}

void LargeIslandSolver::add_rows_of_seam(Assembly& assembly, const Seam& seam, Problem& problem) {
  problem.clear();
  for (std::size_t i = seam.begin; i < seam.end; ++i) {
    const Crossing& crossing = crossings_[i];
    if (crossing.connection != nullptr) {
      assembly.add_connection_rows(*crossing.connection, problem);
    } else if (crossing.pair != nullptr) {
      assembly.add_contact_rows(*crossing.pair, problem, friction_start_);
    } else {
      assembly.add_own_rows(crossing.member, problem);
      problem_of_[static_cast<std::size_t>(assembly.anchors.index_of_member[crossing.member])] = &problem;
    }
  }
}

template <class Work>
void LargeIslandSolver::for_each_share(std::size_t phase, Work&& work) {
  const std::size_t first = phases_[phase];
  const std::size_t count = phases_[phase + 1] - first;
  const bool one_after_the_other = phase > 0 && seams_[first - parts_.count()].colour == last_colour;
  workers_.for_each_chunk(count, one_after_the_other ? count : 1, [&](std::size_t begin, std::size_t end, unsigned) {
    for (std::size_t i = begin; i < end; ++i) work(shares_[first + i]);
  });
}

double LargeIslandSolver::run_pass(bool forwards, bool with_friction) {
  const std::size_t phases = phases_.size() - 1;
  for (std::size_t phase = 0; phase < phases; ++phase)
    for_each_share(forwards ? phase : phases - 1 - phase, [&](Share& share) {
      SequentialImpulses impulses(share.problem);
      share.change = with_friction ? impulses.pass(forwards) : impulses.pass_without_friction(forwards);
    });
  double greatest = 0.0;
  for (std::size_t share = 0; share < phases_.back(); ++share) greatest = std::max(greatest, shares_[share].change);
  return greatest;
}

// Passes over the loads before each pass over everything carry the weight of a heap down to the ground. Friction, whose
// limits are the loads, would otherwise rock it.
void LargeIslandSolver::settle(double settled) {
  for (int i = 0; i < most_passes_of_calm; ++i) {
    for (int k = 0; k < passes_over_loads; ++k)
      if (run_pass(k % 2 == 0, false) <= settled) break;
    if (run_pass(i % 2 == 0, true) <= settled) break;
  }
}

}  // namespace cohort::physics
