// SPDX-License-Identifier: MIT
#include "haptics/constraints/isosurface/isosurface.h"

#include "haptics/constraints/common/link_schema.h"
#include "haptics/constraints/common/one_sided_contact.h"
#include "haptics/constraints/common/pull_back.h"
#include "haptics/constraints/equations.h"
#include "haptics/constraints/isosurface/cell_walk.h"
#include "haptics/constraints/isosurface/closest_point.h"
#include "haptics/constraints/isosurface/crossing.h"
#include "haptics/constraints/isosurface/domain_wall.h"
#include "haptics/constraints/isosurface/surface_search.h"

namespace catena::haptics {
namespace {

constexpr double kSearchRadius = 2;  // in units of L
constexpr int kThrownWork = 1536;    // work units of a tick with a teleported probe, and of the ticks that finish its search
constexpr int kQuick = 200;          // field samples before a formula switches to the descent
constexpr int kQuickOfGrids = 60;    // field samples before a cubic grid switches; its samples cost more, and walls may be the cause
constexpr int kThrownQuick = 20;     // field samples before the switch of a cubic grid in a tick limited to kThrownWork
constexpr int kQuickRefusals = 8;    // consecutive rejected steps before the switch
constexpr int kSight = 16;           // field samples along the line of sight
constexpr int kForLevel = 12;        // field samples reserved for the return to the level
constexpr double kOnLevel = 1e-9;    // fraction of L; tolerance for a point on the level to continue from
constexpr int kStepsAlong = 16;      // steps along a surface that decide whether two of its points are connected
constexpr double kNewSurface = 4;    // voxels; distance in which the surface of other data is the held one
constexpr double kThere = 1e-4;      // fraction of L; distance that the last of these steps must reach

/// Memory of the link: the part of the side rules, the held point, the updated curvature.
struct IsosurfaceMemory {
  SideMemory side;
  LevelPoint at;        // formulas and cubic grids: the held point
  LevelPoint seen;      // the last probe whose side was evaluated
  Curvature curvature;  // curvature of a formula's level at the held point
  CellPoint cell;       // linear grids: the held point
  Vec3 normal;
  SurfaceScan scan;
  bool walled;  // cubic grids: held by a domain wall
  double owed;  // allowed travel that a walk out of budget has not used yet
};

bool is_long_step(const SideMemory& side, const Vec3& probe, double length) noexcept {
  return side.initialized && norm(probe - side.probe) > kLongStepFraction * length;
}

class LevelSurface final : public ContactSurface {
 public:
  LevelSurface(const LevelSetField& field, const PieceFrames& frames, double tolerance, const SideRules& rules, IsosurfaceMemory& memory)
      : field_(field), frames_(frames), tolerance_(tolerance), memory_(memory), one_sided_(rules.free != FreeSide::none) {}

  SideValue evaluate_side(const Vec3& at) noexcept override {
    here_ = field_.at(at);
    have_here_ = true;
    asked_ = at;
    before_ = memory_.seen;
    memory_.seen = here_;
    return {here_.sigma, here_.valid, !here_.finite};
  }

  SurfaceHold project_probe(const Vec3& probe) noexcept override {
    const LevelPoint start = look(probe);
    const LevelSetHit reached = project(start, kSearchRadius * field_.length());
    if (!reached.found) return {false, probe, 0, memory_.scan.in_progress ? LinkStatus::budget : LinkStatus::no_surface, SampleStatus::ok};
    const SurfaceHold hold = settle(reached.point, probe, Curvature{});
    // farther away than the field value suggests: a nearer sheet may be in line of sight
    const bool far = norm(probe - hold.proxy) > 1.05 * std::fabs(start.distance);
    return field_.trilinear_grid() || !far ? hold : settle_in_sight(start, hold);
  }

  SurfaceHold slide(const Vec3& probe) noexcept override {
    const double travel = max_proxy_travel(memory_.side, probe, norm(probe - memory_.side.proxy), field_.state());
    return field_.trilinear_grid() ? slide_grid(probe, travel) : slide_formula(probe, travel);
  }

  SurfaceHold find_crossing(const Vec3& from, const Vec3& probe) noexcept override {
    const bool known = before_.valid && bitwise_equal(before_.p, from);
    if (known && !field_.trilinear_grid() && have_here_ && bitwise_equal(asked_, probe) && stays_on_side(field_, before_, here_)) return {};
    const LevelPoint end = look(probe);
    const LevelSetHit reached = find_first_crossing(field_, from, end, known ? &before_ : nullptr);
    if (!reached.found) return {};
    return field_.trilinear_grid() ? settle(reached.point, probe, Curvature{}) : settle_formula(reached.point, probe, Curvature{}, false);
  }

  SurfaceHold project_probe_within(const Vec3& probe, double limit) noexcept override {
    const LevelSetHit reached = search_along_gradient(field_, look(probe), Vec3(0.0), 1.25 * limit);
    if (!reached.found) return {};
    const IsosurfaceMemory before = memory_;
    SurfaceHold hold = settle(reached.point, probe, Curvature{});
    if (hold.found && norm(hold.proxy - probe) <= limit) return hold;
    memory_ = before;
    return {};
  }

  Vec3 normal() const noexcept override { return memory_.normal; }
  bool may_tunnel() const noexcept override { return true; }
  double domain_length() const noexcept override { return field_.length(); }

 private:
  LevelPoint look(const Vec3& probe) noexcept { return have_here_ && bitwise_equal(asked_, probe) ? here_ : field_.at(probe); }

  /// Returns whether the closest point itself has moved beyond the travel limit, as it does deep inside a concave surface, so that it
  /// overrides the limit: the new point was no nearer to the last probe than the held point.
  bool has_moved(const Vec3& held, const Vec3& met) const noexcept {
    const Vec3& before = memory_.side.probe;
    return norm(before - met) >= norm(before - held) - kOnLevel * field_.length();
  }

  /// Returns whether the probe step is slow enough for a user's motion (no teleport), so that the proxy must not change to another surface
  /// component.
  bool is_of_a_hand(const Vec3& probe) const noexcept { return norm(probe - memory_.side.probe) <= field_.state().max_probe_step; }

  /// Returns whether steps along the surface lead from `at` to `to`.
  bool leads_to(LevelPoint at, const LevelPoint& to) noexcept {
    for (int i = 0; i < kStepsAlong && !field_.out_of_budget(kForLevel); ++i) {
      const Vec3 way = to.p - at.p;
      if (norm(way) <= kThere * field_.length()) return true;
      const Vec3 along = equation::tangential_component(way, at.n);
      const LevelPoint next = relevelled(field_.at(at.p + along * (i < kStepsAlong / 2 ? 2.0 / kStepsAlong : 1.0)));
      if (!usable(next) || dot(next.n, at.n) < 0.5) return false;
      at = next;
    }
    return false;
  }

  SurfaceHold slide_grid(const Vec3& probe, double travel) noexcept {
    CellPoint cell = memory_.cell;
    const Vec3 held = world_position(*field_.trilinear_grid(), cell);
    // a teleported probe: first go far along the surface as if it were smooth
    if (is_long_step(memory_.side, probe, field_.length())) {
      const LevelPoint start = field_.at(held);
      if (start.valid && !start.plateau && !is_of_a_hand(probe)) cell = leap(cell, start, probe);
    }
    TravelLimit limit{held, travel + memory_.owed, false, {}, Vec3(0.0)};
    WalkResult walk = walk_cells(field_, frames_, probe, cell, &limit);
    const Vec3 met = world_position(*field_.trilinear_grid(), cell);
    memory_.owed = 0;
    if (!limit.is_exceeded_by(met)) {
      if (walk.status == LinkStatus::budget && std::isfinite(limit.max_distance)) memory_.owed = limit.max_distance - norm(met - held);
    } else if (!walk.smooth || walk.status == LinkStatus::budget || !has_moved(held, met)) {
      cell = limit.last_within;
      walk = {LinkStatus::budget, SampleStatus::ok, 0, limit.normal, true};
    }
    return hold_cell(cell, walk);
  }

  SurfaceHold slide_formula(const Vec3& probe, double travel) noexcept {
    const LevelPoint from = memory_.at;
    const Curvature curvature = memory_.curvature;
    travel_ = travel;
    const SurfaceHold hold = settle_formula(from, probe, curvature, false);
    const bool far = is_long_step(memory_.side, probe, field_.length()) && is_of_a_hand(probe);
    const auto is_other_body = [&](const LevelPoint& at) { return far && !leads_to(from, at); };
    if ((!(norm(hold.proxy - from.p) > travel) || has_moved(from.p, hold.proxy)) && !is_other_body(memory_.at)) return hold;
    memory_.at = from;
    if (SurfaceHold wall; hold_along(from, probe, wall)) return wall;

    // moves down the surface as far as allowed
    const Vec3 e = probe - from.p, way = direction(equation::tangential_component(e, from.n));
    LevelPoint at = from;
    for (double step = travel; step > 0.1 * travel && !field_.out_of_budget(kForLevel); step *= 0.5) {
      const LevelPoint ahead = relevelled(field_.at(from.p + way * step));
      if (!usable(ahead) || norm(ahead.p - from.p) > travel || !(norm(probe - ahead.p) < norm(e)) || is_other_body(ahead)) continue;
      at = ahead;
      break;
    }
    memory_.at = at;
    memory_.curvature = curvature;
    memory_.normal = at.n;
    return {true, at.p, std::fabs(at.distance), LinkStatus::budget, SampleStatus::ok};
  }

  /// Moves from a point on the level to the closest point.
  SurfaceHold settle(const LevelPoint& start, const Vec3& probe, const Curvature& curvature) noexcept {
    if (!field_.trilinear_grid()) return settle_formula(start, probe, curvature, true);
    return settle_grid(to_cell_point(*field_.trilinear_grid(), start.p), start, probe);
  }

  /// Projects any point onto the level, without an earlier point. A scan out of budget stays in progress in the memory.
  LevelSetHit project(const LevelPoint& start, double radius) noexcept {
    SurfaceScan& scan = memory_.scan;
    if (scan.found_nothing && bitwise_equal(scan.probe, start.p)) return {};
    if (scan.found_level && bitwise_equal(scan.probe, start.p)) return {true, field_.at(scan.nearest)};
    const bool goes_on = scan.in_progress && norm(scan.probe - start.p) <= kLongStepFraction * field_.length();
    LevelPoint centre = start;
    if (!goes_on) {
      const LevelSetHit reached = search_along_gradient(field_, start, Vec3(0.0), radius);
      if (reached.found) return closed(reached);
      if (!field_.trilinear_grid()) {
        SurfaceScan near{};
        const LevelSetHit by_axes = search_by_scan(field_, start, true, near);
        if (by_axes.found) return by_axes;
      }
      // the end of the march may be much closer to the level
      const bool closer = start.valid && reached.point.valid && std::fabs(reached.point.sigma) < std::fabs(start.sigma);
      if (closer) centre = reached.point;
      scan = SurfaceScan{};
      scan.probe = start.p;
      scan.center = centre.p;
    } else if (!bitwise_equal(scan.center, start.p)) {
      centre = field_.at(scan.center);
    }
    LevelSetHit reached = search_by_scan(field_, centre, false, scan);
    if (!reached.found && !scan.in_progress && reached.point.valid)
      reached = search_along_gradient(field_, reached.point, Vec3(0.0), field_.length(), 0);
    scan.found_nothing = !reached.found && !scan.in_progress;
    if (reached.found && goes_on) return met_late(start.p, reached);
    return reached.found ? closed(reached) : reached;
  }
  /// Stores the result of a scan that took more than one tick, so that it is not repeated for a probe at rest.
  LevelSetHit met_late(const Vec3& probe, const LevelSetHit& reached) noexcept {
    memory_.scan = SurfaceScan{};
    memory_.scan.probe = probe;
    memory_.scan.nearest = reached.point.p;
    memory_.scan.found_level = true;
    return reached;
  }
  LevelSetHit closed(const LevelSetHit& reached) noexcept {
    memory_.scan = SurfaceScan{};
    return reached;
  }

  /// Runs the quick iteration; then descends along the surface from its better end; where that is stuck, and any sheet is allowed or none
  /// is held, starts from a new projection.
  SurfaceHold settle_formula(LevelPoint at, const Vec3& probe, Curvature curvature, bool any_sheet) noexcept {
    LevelPoint best = at;
    if (SurfaceHold wall; memory_.walled && hold_along(at, probe, wall)) return wall;
    memory_.walled = false;
    if (closest_point(field_, probe, goal(field_.grid() ? quick_of_grid() : kQuick), at, curvature) == ClosestPointResult::converged)
      return hold_formula(at, ClosestPointResult::converged, probe, curvature);
    at = relevelled(at);
    if (nearer(best, at, probe)) at = usable(best) ? best : relevelled(best);
    if (SurfaceHold wall; hold_along(at, probe, wall)) return wall;
    ClosestPointResult how = ClosestPointResult::stuck;
    if (usable(at)) how = descend_on_surface(field_, probe, goal(kMaxEvaluations), at, curvature);
    if ((!any_sheet && usable(at)) || how != ClosestPointResult::stuck || field_.out_of_budget(6 * kForLevel))
      return hold_formula(at, how, probe, curvature);

    const LevelSetHit fresh = project(field_.at(probe), kSearchRadius * field_.length());
    if (!fresh.found) return hold_formula(at, how, probe, curvature);
    best = fresh.point;
    Curvature other;
    const ClosestPointResult again = descend_on_surface(field_, probe, goal(kMaxEvaluations), best, other);
    best = relevelled(best);
    if (!nearer(best, at, probe)) return hold_formula(at, how, probe, curvature);
    return hold_formula(best, again, probe, other);
  }

  /// Holds the proxy along the domain walls of a cubic grid. Returns false if no wall holds it or the point found is no nearer.
  bool hold_along(const LevelPoint& at, const Vec3& probe, SurfaceHold& hold) noexcept {
    if (field_.grid() == nullptr || !usable(at) || field_.out_of_budget(kWallFetches)) return false;
    const WallResult found = closest_point_at_walls(field_, frames_, probe, goal(quick_of_grid()), at, {memory_.at.p, travel_});
    if (!found.found) return false;
    memory_.at = found.point;
    memory_.curvature = Curvature{};
    memory_.normal = found.point.n;
    memory_.walled = found.status == LinkStatus::boundary;
    hold = {true, found.point.p, std::fabs(found.point.distance), found.status, found.reason};
    return true;
  }

  /// Continues from a point between the probe and the held point, if the level is met there.
  SurfaceHold settle_in_sight(const LevelPoint& probe, const SurfaceHold& hold) noexcept {
    const LevelPoint before = memory_.at;
    if (field_.out_of_budget(kSight + 4 * kForLevel)) return hold;
    LevelPoint a = probe;
    for (int i = 1; i < kSight; ++i) {
      const LevelPoint b = field_.at(probe.p + (hold.proxy - probe.p) * (i * (1.0 / kSight)));
      if (a.valid && b.valid && (a.sigma < 0) != (b.sigma < 0)) {
        const LevelSetHit root = find_root_between(field_, a, b);
        if (!root.found) return hold;
        LevelPoint at = root.point;
        Curvature curvature;
        const ClosestPointResult how = descend_on_surface(field_, probe.p, goal(kMaxEvaluations), at, curvature);
        if (nearer(at, before, probe.p)) return hold_formula(at, how, probe.p, curvature);
        return hold;
      }
      a = b;
    }
    return hold;
  }

  SurfaceHold hold_formula(LevelPoint at, ClosestPointResult how, const Vec3& probe, const Curvature& curvature) noexcept {
    LinkStatus status = LinkStatus::ok;
    SampleStatus reason = SampleStatus::ok;
    if (how != ClosestPointResult::converged) {
      at = relevelled(at);
      // a lack of convergence is no reason to release: only a broken surface is
      const bool idle = how == ClosestPointResult::stuck || norm(at.p - memory_.at.p) <= 1e-12 * field_.length();
      const bool broken = degenerate(at);
      status = broken || (idle && usable(at) && kink(at, probe)) ? LinkStatus::critical : LinkStatus::budget;
      reason = !broken ? SampleStatus::incoherent : at.finite ? SampleStatus::zero : SampleStatus::not_finite;
    }
    memory_.at = at;
    memory_.curvature = curvature;
    memory_.normal = at.n;
    return {true, at.p, std::fabs(at.distance), status, reason};
  }

  int quick_of_grid() const noexcept { return field_.state().max_work <= kThrownWork ? kThrownQuick : kQuickOfGrids; }
  ClosestPointCriteria goal(int maximum) noexcept {
    return {tolerance_ * field_.length(), 1e-12 * field_.length(), std::min(maximum, kMaxEvaluations - field_.evaluations() - kForLevel),
            kQuickRefusals};
  }
  bool usable(const LevelPoint& a) const noexcept { return a.valid && !a.plateau && std::fabs(a.distance) <= kOnLevel * field_.length(); }
  /// Returns whether the level is unusable here: no gradient, not finite, or so flat that the level is lost in round-off.
  bool degenerate(const LevelPoint& a) const noexcept { return !a.valid || a.plateau || a.round_off > kOnLevel * field_.length(); }
  /// Returns whether the normal jumps within 2e-9 L, on the path to the probe or across the point (then it is no surface).
  bool kink(const LevelPoint& a, const Vec3& probe) noexcept {
    const Vec3 e = probe - a.p;
    return jumps(a.p, direction(equation::tangential_component(e, a.n))) || jumps(a.p, a.n);
  }
  bool jumps(const Vec3& p, const Vec3& way) noexcept {
    if (field_.out_of_budget(2)) return false;
    const Vec3 step = way * (1e-9 * field_.length());
    const LevelPoint ahead = field_.at(p + step), behind = field_.at(p - step);
    return !ahead.valid || !behind.valid || ahead.plateau || behind.plateau || dot(ahead.n, behind.n) < 0.9;
  }
  bool nearer(const LevelPoint& a, const LevelPoint& b, const Vec3& probe) const noexcept {
    if (usable(a) != usable(b)) return usable(a);
    return usable(a) ? norm(probe - a.p) < norm(probe - b.p) : std::fabs(a.distance) < std::fabs(b.distance);
  }
  LevelPoint relevelled(const LevelPoint& a) noexcept {
    if (std::fabs(a.distance) <= 1e-11 * field_.length() || !a.valid || a.plateau) return a;
    const LevelSetHit reached = search_along_gradient(field_, a, a.n, field_.length(), 0);
    return reached.found ? reached.point : a;
  }

  /// Moves toward the closest point as if the surface were smooth; returns `cell` if that leads to nothing nearer.
  CellPoint leap(const CellPoint& cell, const LevelPoint& start, const Vec3& probe) noexcept {
    const double voxel = field_.voxel_edge();
    const Vec3 e = probe - start.p;
    if (start.valid && !start.plateau && norm(equation::tangential_component(e, start.n)) > 2 * voxel) {
      LevelPoint at = start;
      Curvature curvature;
      closest_point(field_, probe, {1.5 * voxel, 0.1 * voxel, 48}, at, curvature);
      const LevelSetHit reached = search_along_gradient(field_, at, at.n, 2 * voxel);
      // the probe must lie on the same side of the new sheet as of the old one
      const bool same_sheet = !one_sided_ || dot(reached.point.n, probe - reached.point.p) * dot(start.n, e) > 0;
      if (reached.found && reached.point.valid && same_sheet && norm(probe - reached.point.p) < norm(e))
        return to_cell_point(*field_.trilinear_grid(), reached.point.p);
    }
    return cell;
  }

  /// Moves a long way along the surface first, then exactly, cell by cell.
  SurfaceHold settle_grid(CellPoint cell, const LevelPoint& start, const Vec3& probe) noexcept {
    cell = leap(cell, start, probe);
    const WalkResult walk = walk_cells(field_, frames_, probe, cell);
    return hold_cell(cell, walk);
  }

  SurfaceHold hold_cell(const CellPoint& cell, const WalkResult& walk) noexcept {
    memory_.cell = cell;
    memory_.normal = walk.normal;
    return {true, world_position(*field_.trilinear_grid(), cell), walk.residual, walk.status, walk.reason};
  }

  LevelSetField field_;
  const PieceFrames& frames_;
  const double tolerance_;
  IsosurfaceMemory& memory_;
  bool one_sided_;
  double travel_ = std::numeric_limits<double>::infinity();  ///< proxy travel limit of this tick, along a wall
  LevelPoint here_, before_;
  Vec3 asked_{0.0};
  bool have_here_ = false;
};

class Isosurface final : public Constraint {
 public:
  Isosurface(field::ScalarFieldPtr field, double level, const SideSpec& rules, double tolerance)
      : field_(std::move(field)), level_(level), rules_(rules), tolerance_(tolerance), frames_(field_->mapping()) {}

  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    memory_as<IsosurfaceMemory>(state).scan = SurfaceScan{};
    seek(probe, state, scratch);
  }
  /// Like start, but a search that ran out of budget is continued.
  void seek(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    IsosurfaceMemory& memory = memory_as<IsosurfaceMemory>(state);
    const SurfaceScan scan = memory.scan;
    memory = IsosurfaceMemory{};
    memory.scan = scan;
    const SideRules rules = rules_.rules_at(probe, state, scratch);
    LevelSurface surface(LevelSetField(*field_, level_, scratch.cursors[0], state), frames_, tolerance_, rules, memory);
    start_on_surface(surface, rules, probe, memory.side, state);
  }
  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    IsosurfaceMemory& memory = memory_as<IsosurfaceMemory>(state);
    const SideRules rules = rules_.rules_at_proxy(state, scratch);
    const SideMemory& side = memory.side;
    const bool finishes = side.initialized && side.status == LinkStatus::budget;
    if (field_->cells() != nullptr && (finishes || is_long_step(side, probe, field_->domain_length()))) state.max_work = kThrownWork;
    if (state.data_changed) move_to_new_data(memory, state, scratch);
    LevelSurface surface(LevelSetField(*field_, level_, scratch.cursors[0], state), frames_, tolerance_, rules, memory);
    advance_on_surface(surface, rules, probe, memory.side, state);
  }
  bool is_sane(const LinkState& state) const noexcept override {
    const IsosurfaceMemory& memory = memory_as<IsosurfaceMemory>(state);
    return haptics::is_sane(memory.side) && haptics::is_sane(memory.at) && haptics::is_sane(memory.seen) && haptics::is_sane(memory.cell) &&
           haptics::is_sane(memory.scan) && are_valid_bools(memory.walled);
  }
  PulledBackForce pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch& scratch) const noexcept override {
    const IsosurfaceMemory& memory = memory_as<IsosurfaceMemory>(state);
    if (!memory.side.holding) return {f};
    LevelSetField field(*field_, level_, scratch.cursors[0], state);
    if (field.trilinear_grid()) return pull_back_cells(field, frames_, probe, memory.cell, f);
    if (memory.walled) return {};  // the proxy is at the end of the domain
    const LevelPoint& at = memory.at;
    const double h = 1e-5 * field.length();
    const auto bent = [&](const Vec3& v) {
      const LevelPoint ahead = field.at(at.p + v * h), behind = field.at(at.p - v * h);
      return ahead.valid && behind.valid ? (ahead.n - behind.n) / (2 * h) : Vec3(0.0);
    };
    return pull_back_on_surface(at.n, dot(at.n, probe - at.p), bent, f);
  }
  bool has_primitive() const noexcept override { return true; }
  /// Returns the tangent plane of the level by the value and gradient at `at` (Eq. 6), from one field sample.
  bool primitive(const Vec3& at, LinkState& state, LinkScratch& scratch, Primitive& out) const noexcept override {
    const LevelPoint here = LevelSetField(*field_, level_, scratch.cursors[0], state).at(at);
    if (!here.valid || here.plateau) {
      if (here.finite && !here.valid)
        set_link_status(state, LinkStatus::boundary, SampleStatus::masked);
      else
        set_link_status(state, LinkStatus::critical, here.finite ? SampleStatus::zero : SampleStatus::not_finite);
      return false;
    }
    out = {Primitive::Kind::plane, equation::newton_step_to_level(here.p, here.n, here.distance), here.n};
    return true;
  }
  double domain_length() const noexcept override { return field_->domain_length(); }

 private:
  /// Replaces the samples in memory by those of other data: the held point moves along the gradient to the new surface, if that is near.
  void move_to_new_data(IsosurfaceMemory& memory, LinkState& state, LinkScratch& scratch) const noexcept {
    if (!memory.side.initialized) return;
    LevelSetField field(*field_, level_, scratch.cursors[0], state);
    memory.seen = field.at(memory.side.probe);
    memory.side.value = memory.seen.sigma;
    memory.side.has_value = memory.seen.valid;
    if (!memory.side.holding) return;
    const LevelSetHit surface = search_along_gradient(field, field.at(memory.side.proxy), memory.normal, kNewSurface * field.voxel_edge());
    memory.side.holding = surface.found;
    if (!surface.found) return;
    memory.at = surface.point;
    memory.normal = surface.point.n;
    memory.curvature = Curvature{};
    memory.walled = false;
    if (field.trilinear_grid()) memory.cell = to_cell_point(*field.trilinear_grid(), surface.point.p);
  }

  field::ScalarFieldPtr field_;
  double level_;
  SideSpec rules_;
  double tolerance_;
  PieceFrames frames_;
};

Result<std::shared_ptr<const Constraint>> build_isosurface(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const field::ScalarFieldPtr field, require_scalar_field(link, "field", "an isosurface", context));
  CATENA_TRY(const double level, require_level(link, "field", *field));
  CATENA_TRY(const SideSpec rules, read_side_rules(link, true, context));
  return std::shared_ptr<const Constraint>(std::make_shared<Isosurface>(field, level, rules, context.proxy_tolerance));
}

}  // namespace

ConstraintType isosurface_constraint() {
  return {"isosurface",
          "Holds the proxy on an isosurface of a scalar field.",
          "Eqs. 5-6",
          {scalar_field_key("field").required(), level_key("Value of the field on the isosurface.").required(),
           free_key("the side of larger values")},
          build_isosurface,
          true,
          true,
          "isosurfaces"};
}

}  // namespace catena::haptics
