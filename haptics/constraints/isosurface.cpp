#include "haptics/constraints/isosurface.h"

#include <fmt/format.h>

#include "haptics/constraints/isosurface_analytic.h"
#include "haptics/constraints/isosurface_cell_walk.h"
#include "haptics/constraints/isosurface_reach.h"
#include "haptics/constraints/surface_side.h"

namespace catena::haptics {
namespace {

constexpr double kSearchRadius = 2;  // of L
constexpr int kFirstWalk = 32;       // fetches before a walk asks for the coarse method

/// What the link remembers: the rules' part, the point held, the curvature learned.
struct Memory {
  SideMemory side;
  LevelPoint at;        // formulas: the point held
  Curvature curvature;  // formulas
  CellPoint cell;       // grids: the point held
  Vec3 normal;
};

class LevelSurface final : public Surface {
 public:
  LevelSurface(const LevelField& field, Memory& memory) : field_(field), memory_(memory) {}

  SideValue side(const Vec3& at) noexcept override {
    here_ = field_.at(at);
    have_here_ = true;
    asked_ = at;
    return {here_.sigma, here_.valid, !here_.finite};
  }

  Hold place(const Vec3& probe) noexcept override {
    const LevelPoint start = look(probe);
    Reached reached = reach_along_gradient(field_, start, Vec3(0.0), kSearchRadius * field_.length());
    if (!reached.found) {
      // where the march ended it may be much closer to the level
      const bool closer = start.valid && reached.at.valid && std::fabs(reached.at.sigma) < std::fabs(start.sigma);
      reached = reach_by_scan(field_, closer ? reached.at : start);
      if (!reached.found && reached.at.valid) reached = reach_along_gradient(field_, reached.at, Vec3(0.0), field_.length(), 0);
    }
    return reached.found ? settle(reached.at, probe, Curvature{}) : Hold{};
  }

  Hold slide(const Vec3& probe) noexcept override {
    if (!field_.grid()) return settle_formula(memory_.at, probe, memory_.curvature);
    const Vec3 p = world_of(*field_.grid(), memory_.cell);
    if (memory_.side.fresh && norm(probe - memory_.side.probe) > 2 * field_.voxel()) {
      const LevelPoint start = field_.at(p);
      if (start.valid && !start.plateau) return settle_grid(memory_.cell, start, probe);
    }
    CellPoint cell = memory_.cell;
    WalkResult walk = walk_cells(field_, probe, kFirstWalk, cell);
    if (walk.status == Status::budget && !field_.spent()) {
      const LevelPoint start = field_.at(world_of(*field_.grid(), cell));
      return settle_grid(cell, start, probe);
    }
    return hold_cell(cell, walk);
  }

  Hold cross(const Vec3& from, const Vec3& probe) noexcept override {
    const LevelPoint end = look(probe);
    const Reached reached = reach_on_segment(field_, field_.at(from), end);
    return reached.found ? settle(reached.at, probe, Curvature{}) : Hold{};
  }

  Hold near_by(const Vec3& probe, double limit) noexcept override {
    const Reached reached = reach_along_gradient(field_, look(probe), Vec3(0.0), 1.25 * limit);
    if (!reached.found) return {};
    const Memory before = memory_;
    Hold hold = settle(reached.at, probe, Curvature{});
    if (hold.found && norm(hold.proxy - probe) <= limit) return hold;
    memory_ = before;
    return {};
  }

  Vec3 normal() const noexcept override { return memory_.normal; }
  double march_step() const noexcept override { return field_.march_step(); }
  double domain_length() const noexcept override { return field_.length(); }

 private:
  LevelPoint look(const Vec3& probe) noexcept {
    return have_here_ && std::memcmp(&asked_, &probe, sizeof probe) == 0 ? here_ : field_.at(probe);
  }

  /// From a point on the level to the closest point.
  Hold settle(const LevelPoint& start, const Vec3& probe, const Curvature& curvature) noexcept {
    if (!field_.grid()) return settle_formula(start, probe, curvature);
    return settle_grid(cell_point(*field_.grid(), start.p), start, probe);
  }

  Hold settle_formula(LevelPoint at, const Vec3& probe, Curvature curvature) noexcept {
    const LevelPoint before = at;
    constexpr int kForLevel = 24;  // fetches kept for the way back to the level
    const ClosestGoal goal{1e-8 * field_.length(), 1e-12 * field_.length(), kEvaluationCap - field_.evaluations() - kForLevel};
    Closest how = closest_point(field_, probe, goal, at, curvature);
    if (how != Closest::converged && std::fabs(at.distance) > 1e-11 * field_.length()) {
      const Reached reached = reach_along_gradient(field_, at, at.n, field_.length(), 0);
      if (reached.found) at = reached.at;
    }
    // lost: the last point on the level is kept
    if (std::fabs(at.distance) > 1e-9 * field_.length() && std::fabs(before.distance) < std::fabs(at.distance)) at = before;
    memory_.at = at;
    memory_.curvature = curvature;
    memory_.normal = at.n;
    const Status status = how == Closest::converged ? Status::ok : how == Closest::spent ? Status::budget : Status::critical;
    return {true, at.p, std::fabs(at.distance), status};
  }

  /// Far along the surface first as if it were smooth, then exactly, cell by cell.
  Hold settle_grid(CellPoint cell, const LevelPoint& start, const Vec3& probe) noexcept {
    const double voxel = field_.voxel();
    const Vec3 e = probe - start.p;
    if (start.valid && !start.plateau && norm(e - start.n * dot(start.n, e)) > 2 * voxel) {
      LevelPoint at = start;
      Curvature curvature;
      closest_point(field_, probe, {1.5 * voxel, 0.1 * voxel, 48}, at, curvature);
      const Reached reached = reach_along_gradient(field_, at, at.n, 2 * voxel);
      if (reached.found && reached.at.valid && norm(probe - reached.at.p) < norm(e)) cell = cell_point(*field_.grid(), reached.at.p);
    }
    const WalkResult walk = walk_cells(field_, probe, kEvaluationCap, cell);
    return hold_cell(cell, walk);
  }

  Hold hold_cell(const CellPoint& cell, const WalkResult& walk) noexcept {
    memory_.cell = cell;
    memory_.normal = walk.normal;
    return {true, world_of(*field_.grid(), cell), walk.residual, walk.status};
  }

  LevelField field_;
  Memory& memory_;
  LevelPoint here_;
  Vec3 asked_{0.0};
  bool have_here_ = false;
};

class Isosurface final : public Constraint {
 public:
  Isosurface(field::ScalarFieldPtr field, double level, const SideRules& rules) : field_(std::move(field)), level_(level), rules_(rules) {}

  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    Memory& memory = memory_of<Memory>(state);
    memory = Memory{};
    LevelSurface surface(LevelField(*field_, level_, scratch.cursors[0], state.evaluations), memory);
    start_on(surface, rules_, probe, memory.side, state);
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    Memory& memory = memory_of<Memory>(state);
    LevelSurface surface(LevelField(*field_, level_, scratch.cursors[0], state.evaluations), memory);
    advance_on(surface, rules_, probe, memory.side, state);
  }
  double domain_length() const noexcept override { return field_->length(); }

 private:
  field::ScalarFieldPtr field_;
  double level_;
  SideRules rules_;
};

Result<std::shared_ptr<const Constraint>> build(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const std::string name, json::require_string(link, "field"));
  CATENA_TRY(const field::AnyField any, context.field(*link.find("field"), name));
  if (!any.scalar)
    return json::error_at(*link.find("field"), fmt::format("field \"{}\" is a vector field; an isosurface needs a scalar field", name));
  CATENA_TRY(const double level, json::require_number(link, "level"));
  const double least = any.scalar->min_value(), most = any.scalar->max_value();
  if (!(level >= least && level <= most))
    return json::error_at(*link.find("level"), fmt::format("level {} is not attained by field \"{}\"; expected a value within {} .. {}",
                                                           level, name, least, most));
  CATENA_TRY(const SideRules rules, read_side_rules(link, true));
  return std::shared_ptr<const Constraint>(std::make_shared<Isosurface>(any.scalar, level, rules));
}

}  // namespace

ConstraintType isosurface_constraint() {
  return {"isosurface",
          "Eqs. 5-6",
          {{"field", "string", true, "a scalar field of the scene"},
           {"level", "number", true, "the field's value on the surface"},
           {"free", "string", false, "the side, by field value, where the hand moves freely", kFreeSchema},
           {"release", "number", false, "lets go at this depth, world units", kPositiveSchema}},
          build};
}

}  // namespace catena::haptics
