#include "server/physics/stepper.hpp"

#include <stdexcept>
#include <string>

#include "server/physics/active_set_solver.hpp"
#include "server/physics/direct_solver.hpp"
#include "server/physics/iterative_solver.hpp"

namespace cohort::physics {
namespace {

constexpr std::size_t bodies_a_chunk = 16;
constexpr std::size_t islands_a_chunk = 8;

// A pass of the solver that changes no velocity by more ends it [m/s or rad/s].
constexpr double tolerance = 1e-9;

}  // namespace

Stepper::Stepper(const description::World& description, WorkerPool& workers)
    : description_(description),
      workers_(workers),
      step_(std::chrono::duration<double>(description.step).count()),
      surfaces_(description),
      mechanisms_(description.models.size()),
      shapes_(description.models.size()),
      multibodies_(description.instances.size()),
      member_of_body_(description.instances.size(), Anchors::nobody),
      memory_(workers.threads()) {
  for (std::uint32_t body = 0; body < description.instances.size(); ++body) {
    const description::Model& model = description.models[description.instances[body].model];
    if (model.is_static) {
      add_static_solids(body);
      continue;
    }
    try {
      add_body(body);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("model '" + model.name + "': " + error.what());
    }
  }
  scene_.build();
  collision_ = std::make_unique<Collision>(
      scene_, shape_of_solid_, [this](std::uint32_t solid, std::uint32_t other) { return may_touch(solid, other); });
  anchors_.index_of_member.resize(members_.size());
  finite_.assign(members_.size(), 1);
}

void Stepper::add_static_solids(std::uint32_t body) {
  const description::Instance& instance = description_.instances[body];
  const description::Model& model = description_.models[instance.model];
  for (const description::Link& link : model.links) {
    for (const description::Collision& collision : link.collisions) {
      scene_.add({collision.shape, collision.surface, body, false, instance.X_WM * link.X_ML * collision.X_LC});
      shape_of_solid_.push_back(make_bullet_shape(collision.shape));
      anchors_.part_of_solid.push_back({Anchors::nobody, 0});
    }
  }
}

void Stepper::add_body(std::uint32_t body) {
  const description::Instance& instance = description_.instances[body];
  const description::Model& model = description_.models[instance.model];
  std::unique_ptr<Mechanism>& mechanism = mechanisms_[instance.model];
  std::vector<std::shared_ptr<const BulletShape>>& shapes = shapes_[instance.model];
  if (!mechanism) {
    mechanism = std::make_unique<Mechanism>(model, description_.physics.fidelity);
    for (const description::Link& link : model.links)
      for (const description::Collision& collision : link.collisions)
        shapes.push_back(make_bullet_shape(collision.shape));
  }
  multibodies_[body] = std::make_unique<Multibody>(*mechanism, instance.X_WM, body);

  const auto member = static_cast<std::uint32_t>(members_.size());
  members_.push_back({body, {}});
  member_of_body_[body] = member;
  std::size_t index = 0;
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    const Mechanism::LinkPlace& place = mechanism->link(link);
    for (const description::Collision& collision : model.links[link].collisions) {
      const std::shared_ptr<const BulletShape>& shape = shapes[index++];
      if (!place.collides) continue;
      const Pose X_SC = place.X_SL * collision.X_LC;
      const Pose X_WC = multibodies_[body]->segment_pose(place.segment) * X_SC;
      const std::uint32_t solid = scene_.add({collision.shape, collision.surface, body, true, X_WC});
      members_.back().parts.push_back({solid, place.segment, X_SC});
      shape_of_solid_.push_back(shape);
      anchors_.part_of_solid.push_back({member, place.segment});
    }
  }
}

Pose Stepper::resting_link_pose(std::uint32_t body, std::size_t link) const {
  const description::Instance& instance = description_.instances[body];
  return instance.X_WM * description_.models[instance.model].links[link].X_ML;
}

// Solids of one body: only if the model says so, and not beside a joint, where they overlap by design.
bool Stepper::may_touch(std::uint32_t solid, std::uint32_t other) const {
  const Multibody* multibody = multibodies_[scene_.solid(solid).body].get();
  if (multibody == nullptr || !multibody->mechanism().model().self_collide) return false;
  const auto above = [&](int segment) {
    // Over the massless middle of a universal joint.
    const auto& segments = multibody->mechanism().segments();
    int parent = segments[static_cast<std::size_t>(segment)].parent;
    while (parent >= 0 && segments[static_cast<std::size_t>(parent)].mass == 0.0)
      parent = segments[static_cast<std::size_t>(parent)].parent;
    return parent;
  };
  const int one = anchors_.part_of_solid[solid].segment;
  const int two = anchors_.part_of_solid[other].segment;
  return one != two && above(one) != two && above(two) != one;
}

void Stepper::step() {
  collision_->detect(workers_);
  find_ground();
  find_islands();
  workers_.for_each_chunk(islands_.count(), islands_a_chunk, [&](std::size_t begin, std::size_t end, unsigned worker) {
    for (std::size_t i = begin; i < end; ++i)
      solve_island(islands_.members(static_cast<std::uint32_t>(i)), memory_[worker]);
  });
  for (std::size_t member = 0; member < members_.size(); ++member)
    if (!finite_[member])
      throw std::runtime_error("the state of '" + description_.instances[members_[member].body].name +
                               "' is no longer finite");
  report_contacts();
  scene_.update();
}

void Stepper::find_ground() {
  workers_.for_each_chunk(members_.size(), bodies_a_chunk, [&](std::size_t begin, std::size_t end, unsigned worker) {
    for (std::size_t i = begin; i < end; ++i) {
      Multibody& multibody = of(members_[i]);
      for (TreelDrive& treel : multibody.treels())
        treel.find_ground(scene_, multibody.body(), multibody.segment_pose(0), memory_[worker].near);
    }
  });
}

void Stepper::find_islands() {
  const auto count = static_cast<std::uint32_t>(members_.size());
  islands_.reset(count);
  for (std::uint32_t member = 0; member < count; ++member) {
    for (const Part& part : members_[member].parts)
      for (const SolidPair& pair : collision_->pairs_of(part.solid))
        if (pair.contact.count > 0 && anchors_.moves(pair.b)) islands_.link(member, anchors_.member(pair.b));
    for (const TreelDrive& treel : of(members_[member]).treels())
      treel.for_each_ground([&](std::uint32_t solid) {
        if (anchors_.moves(solid)) islands_.link(member, anchors_.member(solid));
      });
  }
  islands_.finish();
}

void Stepper::solve_island(std::span<const std::uint32_t> members, Memory& memory) {
  Problem& problem = memory.problem;
  problem.clear();
  for (const std::uint32_t member : members)
    anchors_.index_of_member[member] = problem.add_body(of(members_[member]), description_.gravity, step_);
  for (const std::uint32_t member : members)
    of(members_[member]).add_rows(problem, anchors_.index_of_member[member], anchors_, step_);
  for (const std::uint32_t member : members) add_contact_rows_of(members_[member], problem);

  solve(problem);

  for (const Row& row : problem.rows())
    if (row.kept != nullptr) *row.kept = row.impulse;
  for (const std::uint32_t member : members) {
    Multibody& multibody = of(members_[member]);
    for (TreelDrive& treel : multibody.treels()) treel.read_rows(problem, step_);
    finite_[member] =
        multibody.integrate(problem.equations(anchors_.index_of_member[member]).velocity(), step_) ? 1 : 0;
    place_solids_of(members_[member]);
  }
}

void Stepper::place_solids_of(const Member& member) {
  const Multibody& multibody = of(member);
  for (const Part& part : member.parts) scene_.set_pose(part.solid, multibody.segment_pose(part.segment) * part.X_SC);
}

void Stepper::place_solids(std::uint32_t body) {
  place_solids_of(members_[member_of_body_[body]]);
  scene_.update();
}

void Stepper::solve(Problem& problem) const {
  const description::PhysicsSettings& settings = description_.physics;
  const bool directly = settings.solver == description::Solver::direct ||
                        (settings.solver == description::Solver::hybrid &&
                         problem.body_count() <= static_cast<int>(settings.direct_bodies));
  if (directly ? solve_directly(problem) : solve_by_active_set(problem)) return;
  solve_iteratively(problem, settings.iterations, tolerance);
}

void Stepper::add_contact_rows_of(const Member& member, Problem& problem) {
  for (const Part& part : member.parts) {
    for (SolidPair& pair : collision_->pairs_of(part.solid)) {
      if (pair.contact.count == 0) continue;
      const SurfacePair surfaces = surfaces_.of(scene_.solid(pair.a).surface, scene_.solid(pair.b).surface);
      add_contact_rows(problem, anchors_.of(pair.a), anchors_.of(pair.b), pair.contact, surfaces, step_);
    }
  }
}

void Stepper::report_contacts() {
  contacts_.clear();
  for (const Member& member : members_) {
    for (const Part& part : member.parts) {
      for (const SolidPair& pair : collision_->pairs_of(part.solid)) {
        for (const ContactPoint& point : pair.contact) {
          if (point.gap > 0.0 && point.impulse[0] == 0.0) continue;  // near, but it did not touch
          contacts_.push_back({scene_.solid(pair.a).body, scene_.solid(pair.b).body, point.position_W, point.normal_W,
                               point.gap, point.impulse[0]});
        }
      }
    }
  }
}

void Stepper::hash_contacts(StateHash& hash) const {
  for (const Member& member : members_) {
    for (const Part& part : member.parts) {
      for (const SolidPair& pair : collision_->pairs_of(part.solid)) {
        if (pair.contact.count == 0) continue;
        hash.add(static_cast<std::uint64_t>(pair.a) << 32 | pair.b);
        for (const ContactPoint& point : pair.contact) {
          for (int axis = 0; axis < 3; ++axis) {
            hash.add(point.position_W[axis]);
            hash.add(point.normal_W[axis]);
          }
          for (const double impulse : point.impulse) hash.add(impulse);
          for (const double impulse : point.rolling_impulse) hash.add(impulse);
        }
      }
    }
  }
}

}  // namespace cohort::physics
