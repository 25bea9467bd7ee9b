// SPDX-License-Identifier: MIT
#include "engine/scene/streamlines.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/field/clipped_field.h"
#include "engine/geometry/flow/seeds.h"
#include "engine/scene/classify_vector.h"
#include "engine/scene/unsteady_lines.h"

namespace catena::scene {
namespace {

constexpr double kExact = 1e-9;  ///< up to this tolerance the exact tracer is used
constexpr double kPatternTolerance = 1e-7;
constexpr int kFineLattice = 24;  ///< seeds along each axis, tried if a coarser grid finds no flow in an analytic field
constexpr std::uint64_t kMaxKnots = 40'000'000;

using Curves = std::vector<flow::CurvePtr>;

/// Cached lines of a StreamlineSet.
struct MadeLines {
  std::uint64_t field_version = 0;
  std::vector<Vec3> points;  ///< the seeds, which a widget may move
  Curves curves;
  std::uint64_t version = 0;
  bool released = false;
  Bounds bounds;  ///< of all knots
};

/// Reports the seed of a line, the k-th one that is traced.
void report_line_seed(const LineRequest& request, std::size_t k) {
  if (request.line_seeds != nullptr) request.line_seeds->push_back(request.seed_index(k));
}

/// Returns the curves through the points; curves that are not yet in scene.traced_curves are traced on all cores.
Result<Curves> exact_lines(Scene& scene, const Seeds& seeds, const std::vector<Vec3>& points, const LineRequest& request,
                           const json::Node& where) {
  const auto node_of = [&](std::size_t k) -> const json::Node& {
    const std::size_t i = request.seed_index(k);
    return i < where.items.size() ? where.items[i] : where;
  };
  const auto key = [&](const Vec3& p) {
    return Scene::CurveKey{
        request.flow.field->version(), request.flow.is_line_field, request.flow.min_speed, request.length, {p.x, p.y, p.z}};
  };
  std::vector<Vec3> missing;
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!scene.traced_curves.contains(key(points[i]))) {
      missing.push_back(points[i]);
      at.push_back(i);
    }
  flow::TraceOptions options;
  options.length = request.length;
  const auto traced = flow::trace_all(request.flow, missing, options);
  for (std::size_t n = 0; n < missing.size(); ++n) {
    if (traced[n])
      scene.traced_curves.emplace(key(missing[n]), *traced[n]);
    else if (!seeds.widget)
      return with_cause(json::error_at(node_of(at[n]), traced[n].error().message), traced[n].error());
  }
  Curves curves;
  curves.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    if (const auto it = scene.traced_curves.find(key(points[k])); it != scene.traced_curves.end()) {
      curves.push_back(it->second);
      report_line_seed(request, k);
    }
  return curves;
}

/// Retraces, up to the edge of the box, the curves that leave the box or end only at the maximum length. The others stay the same objects,
/// which haptic links use. A curve whose seed lies outside of the box is unchanged.
void end_at_box(Curves& curves, const flow::Flow& bounded) {
  std::vector<Vec3> seeds;
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::vector<flow::Knot>& knots = curves[i]->knots();
    const auto outside = [&](const flow::Knot& knot) { return !bounded.field->index_box().contains(knot.p); };
    const bool cut = curves[i]->first_end() == flow::Termination::length || curves[i]->last_end() == flow::Termination::length;
    if (!cut && std::none_of(knots.begin(), knots.end(), outside)) continue;
    const flow::Knot& seed = *std::find_if(knots.begin(), knots.end(), [](const flow::Knot& knot) { return knot.s == 0; });
    if (outside(seed)) continue;
    at.push_back(i);
    seeds.push_back(seed.p);
  }
  const auto traced = flow::trace_all(bounded, seeds, {});
  for (std::size_t n = 0; n < at.size(); ++n)
    if (traced[n]) curves[at[n]] = *traced[n];
}

Result<std::vector<Vec3>> places_of(Scene& scene, const SeedPattern& pattern) {
  switch (pattern.kind) {
    case SeedPattern::Kind::line:
      return flow::seeds_on_line(pattern.origin, pattern.u, pattern.count);
    case SeedPattern::Kind::plane:
      return flow::seeds_on_plane(pattern.origin, pattern.u, pattern.v, pattern.count, pattern.count_v);
    case SeedPattern::Kind::sphere:
      return flow::seeds_on_sphere(pattern.origin, pattern.radius, pattern.count, pattern.inside);
    case SeedPattern::Kind::isosurface:
      break;
    case SeedPattern::Kind::evenly_spaced:
      return pattern.start_points;
  }
  CATENA_TRY(const field::AnyField any, resolve_field(scene, pattern.field, pattern.where));
  if (!any.scalar)
    return json::error_at(
        json::member_or_parent(pattern.where, "field"),
        in_quotes(scene.entities.get<Name>(pattern.field).value) + " is a vector field; a scalar field was expected for an isosurface");
  CATENA_CHECK(check_surface(scene, pattern.field, json::member_or_parent(pattern.where, "field")));
  CATENA_CHECK(check_level(*any.scalar, pattern.level, json::member_or_parent(pattern.where, "level")));
  std::vector<Vec3> positions = flow::seeds_on_isosurface(*any.scalar, pattern.level, pattern.count);
  if (positions.empty())
    return json::error_at(json::member_or_parent(pattern.where, "level"),
                          "no point with this level was found; a level that occurs in the field's domain was expected");
  return positions;
}

/// Returns the default start points of an evenly spaced set: the center of the domain and a sampling grid about it; if none of these is in
/// the flow, as in a hollow domain, the fastest points.
std::vector<Vec3> default_start(const flow::Flow& flow) {
  const field::Mapping& mapping = flow.field->mapping();
  const field::Box& box = flow.field->index_box();
  std::vector<Vec3> start;
  const auto lattice = [&](int n) {
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          start.push_back(mapping.world_from_index(box.lo + (Vec3(i, j, k) + 0.5) / double(n) * (box.hi - box.lo)));
  };
  lattice(1);
  lattice(3);
  field::Cursor cursor;
  const auto flows = [&](const Vec3& p) {
    Vec3 u;
    return flow::seed_direction(flow, p, cursor, u) == flow::StopReason::none;
  };
  if (std::any_of(start.begin(), start.end(), flows)) return start;
  start.clear();
  if (flow.field->grid() != nullptr) return compute_vector_stats(*flow.field->grid()).fastest_points;
  lattice(kFineLattice);
  std::erase_if(start, [&](const Vec3& p) { return !flows(p); });
  return start;
}

constexpr std::array<double, 2> kFormulaBox{-2, 2};

field::Box formula_box(const LineRequest& request) {
  const std::array<double, 2> box = request.box.value_or(kFormulaBox);
  return {Vec3(box[0]), Vec3(box[1])};
}

constexpr std::size_t kFirstBlock = 64, kLargestBlock = 8192;
constexpr std::size_t kBlockKnots = 400'000;         ///< of lines that are not cached
constexpr std::size_t kMaxVisited = 10'000'000'000;  ///< knots of lines that are only visited, not cached: hours of work

/// Returns the number of seeds whose lines fit into the remaining knots if they are as long as the lines so far.
std::size_t next_block(std::size_t seeds, std::size_t knots, std::size_t max_knots) {
  const std::size_t remaining = max_knots - std::min(max_knots, knots), knots_per_seed = std::max<std::size_t>(1, knots / seeds);
  return std::clamp(remaining / knots_per_seed, kFirstBlock, kLargestBlock);
}

}  // namespace

std::size_t knot_limit() { return static_cast<std::size_t>(std::min(kMaxKnots, available_memory() / sizeof(flow::Knot))); }

std::string too_many_knots_message(std::size_t seeds, std::size_t done, std::size_t max_knots) {
  return "the lines of the first " + std::to_string(done) + " of the " + std::to_string(seeds) + " seeds have more than " +
         std::to_string(max_knots) + " knots in total (" + to_text(std::round(1e-6 * static_cast<double>(max_knots * sizeof(flow::Knot)))) +
         " MB of memory); fewer seeds, a shorter length or a greater tolerance was expected";
}

namespace {

/// Returns whether lines in an analytic field end at its render box, because such a field has no boundary: evenly spaced lines always do,
/// other lines if at least one seed is within the box and no length is given. Seeds of a pattern outside of the box then start no lines.
bool ends_at_box(const Seeds& seeds, std::span<const Vec3> positions, const LineRequest& request) {
  if (request.flow.field->is_grid()) return false;
  if (seeds.pattern && seeds.pattern->kind == SeedPattern::Kind::evenly_spaced) return true;
  const auto within = [&](const Vec3& p) { return formula_box(request).contains(p); };
  return request.box && !(request.length > 0) && std::any_of(positions.begin(), positions.end(), within);
}

/// Passes all curves to `visit` at once, if the request visits its lines in blocks.
Result<Curves> all_at_once(Curves curves, const LineRequest& request) {
  if (request.visit && !curves.empty()) CATENA_CHECK(request.visit({curves, curves.size(), curves.size()}));
  return curves;
}

/// Traces the lines of many seeds in blocks; the remaining knots determine the size of a block.
Result<Curves> lines_in_blocks(const Seeds& seeds, std::span<const Vec3> positions, const LineRequest& request,
                               const flow::BatchOptions& batch, const json::Node& where) {
  const json::Node& node = seeds.pattern ? seeds.pattern->where : where;
  flow::TraceOptions exact;
  exact.length = request.length;
  const flow::BatchTracer tracer(request.flow, batch);
  Curves curves;
  std::string first_error;
  const std::size_t max_knots = request.visit ? kMaxVisited : request.max_knots;
  std::size_t knots = 0, lines = 0, block = kFirstBlock;
  bool cache_lines = true;
  for (std::size_t begin = 0; begin < positions.size(); begin += block) {
    if (begin > 0) block = next_block(begin, knots, request.visit ? knots + kBlockKnots : max_knots);
    const std::span<const Vec3> some = positions.subspan(begin, std::min(block, positions.size() - begin));
    auto traced = batch.tolerance <= kExact ? flow::trace_all(request.flow, some, exact) : tracer.trace(some);
    const std::size_t first = curves.size();
    for (std::size_t i = 0; i < traced.size(); ++i) {
      if (traced[i]) {
        curves.push_back(*std::move(traced[i]));
        report_line_seed(request, begin + i);
        knots += curves.back()->knots().size();
        ++lines;
        continue;
      }
      if (!seeds.pattern && !seeds.widget) {
        const std::size_t item = request.seed_index(begin + i);
        return with_cause(json::error_at(item < where.items.size() ? where.items[item] : where, traced[i].error().message),
                          traced[i].error());
      }
      if (first_error.empty()) first_error = traced[i].error().message;
    }
    if (knots > max_knots) return json::error_at(node, too_many_knots_message(positions.size(), begin + some.size(), max_knots));
    if (request.visit) {
      CATENA_CHECK(request.visit({std::span(curves).subspan(first), begin + some.size(), positions.size()}));
      // cached only as long as the expected total fits
      const double expected = static_cast<double>(knots) * static_cast<double>(positions.size()) / static_cast<double>(begin + some.size());
      cache_lines = cache_lines && expected <= static_cast<double>(request.max_cached_knots);
      if (!cache_lines) curves.clear();
    }
    if (request.progress) request.progress(begin + some.size(), positions.size());
  }
  if (lines == 0 && !seeds.widget && request.seed_stride == 1)
    return json::error_at(node,
                          "none of the " + std::to_string(positions.size()) + " seeds starts a line; the first error: " + first_error);
  return curves;
}

}  // namespace

/// Traces path lines or streak lines. `where`: the set, or its seeds.
static Result<Curves> unsteady_lines(Scene& scene, const Seeds& seeds, std::vector<Vec3> positions, const LineRequest& request,
                                     const json::Node& where) {
  if (seeds.pattern && seeds.pattern->kind == SeedPattern::Kind::evenly_spaced)
    return json::error_at(seeds.pattern->where, "evenly spaced path lines and streak lines cannot be traced; another pattern was expected");
  std::vector<Vec3> some;
  for (std::size_t i = request.first_seed; i < positions.size(); i += request.seed_stride) some.push_back(positions[i]);
  UnsteadyLineRequest unsteady{request.lines, request.times, request.is_cubic_in_time};
  if (request.progress)
    unsteady.progress = [&](double share) {
      request.progress(static_cast<std::size_t>(share * static_cast<double>(some.size())), some.size());
    };
  unsteady.tolerance = request.tolerance;
  std::vector<std::size_t> of;
  unsteady.line_positions = &of;
  unsteady.skips_unusable_positions = seeds.pattern || seeds.widget;
  const json::Node& items = json::member_or_parent(where, "seeds");
  unsteady.node_of = [&](std::size_t i) {
    const std::size_t item = request.seed_index(i);
    if (!request.seed_table.empty()) {
      json::Node row;
      row.file = std::make_shared<const std::string>(request.seed_table);
      row.line = static_cast<int>(item) + 2;  // 1-based, after the header
      return row;
    }
    return seeds.points.empty() || item >= items.items.size() ? items : items.items[item];
  };
  CATENA_TRY(Curves curves, trace_unsteady_lines(scene, request.field, some, unsteady, where));
  if (curves.empty() && request.lines == LineKind::path && !some.empty() && !seeds.widget && request.seed_stride == 1)
    return json::error_at(items, "none of the " + std::to_string(some.size()) + " seeds starts a path line");
  for (const std::size_t i : of) report_line_seed(request, i);
  std::size_t knots = 0;
  for (const flow::CurvePtr& curve : curves) knots += curve->knots().size();
  if (knots > request.max_knots) return json::error_at(items, too_many_knots_message(some.size(), some.size(), request.max_knots));
  return all_at_once(std::move(curves), request);
}

Result<Curves> trace_lines(Scene& scene, const Seeds& seeds, const LineRequest& original, const json::Node& where) {
  std::vector<Vec3> positions = seeds.points;
  if (seeds.pattern) {
    CATENA_TRY(positions, places_of(scene, *seeds.pattern));
  }
  if (original.lines != LineKind::stream) return unsteady_lines(scene, seeds, positions, original, where);
  LineRequest request = original;
  std::optional<field::ClippedVectorField> bounded;
  if (ends_at_box(seeds, positions, request)) {
    bounded.emplace(*original.flow.field, formula_box(request));
    request.flow.field = &*bounded;
  }
  if (request.first_seed > 0 || request.seed_stride > 1) {
    std::vector<Vec3> some;
    for (std::size_t i = request.first_seed; i < positions.size(); i += request.seed_stride) some.push_back(positions[i]);
    positions = std::move(some);
  }
  const bool is_batch = seeds.pattern || (seeds.widget && scene.entities.get<Widget>(seeds.widget).spec.kind == widget::Kind::rake);
  const double tolerance = request.tolerance > 0 ? request.tolerance : is_batch ? kPatternTolerance : 0;
  if (!is_batch && tolerance <= kExact) {
    CATENA_TRY(Curves curves, exact_lines(scene, seeds, positions, original, where));
    if (bounded) end_at_box(curves, request.flow);
    return all_at_once(std::move(curves), original);
  }
  flow::BatchOptions batch;
  batch.length = request.length;
  batch.tolerance = std::max(tolerance, kExact);
  batch.max_step = request.max_step;
  const json::Node& node = seeds.pattern ? seeds.pattern->where : where;
  if (seeds.pattern && seeds.pattern->kind == SeedPattern::Kind::evenly_spaced) {
    flow::EvenSpacingOptions spacing{seeds.pattern->distance, seeds.pattern->termination_ratio, seeds.pattern->start_points,
                                     static_cast<std::size_t>(seeds.pattern->count)};
    if (spacing.distance < 1e-3 * request.flow.field->domain_length())
      return json::error_at(json::member_or_parent(node, "distance"),
                            "\"distance\" is " + to_text(spacing.distance) + "; at least 1/1000 of the domain's length, " +
                                to_text(1e-3 * request.flow.field->domain_length()) + ", was expected");
    if (spacing.start_points.empty()) spacing.start_points = default_start(request.flow);
    Curves curves = flow::trace_evenly_spaced(request.flow, spacing, batch);
    if (curves.empty())
      return json::error_at(node, "none of the lines from the " + std::to_string(spacing.start_points.size()) +
                                      " start points is as long as \"distance\"; a \"start\" inside the flow was expected");
    return all_at_once(std::move(curves), original);
  }
  return lines_in_blocks(seeds, positions, request, batch, where);
}

namespace {
TraceProgress while_tracing;
}
void set_trace_progress(TraceProgress callback) { while_tracing = std::move(callback); }

namespace {

/// Returns the cached lines of a set, traced if a widget or another step has changed them. With `visit` new lines are passed to it in
/// blocks, and are cached only if they have at most `max_cached_knots` knots.
Result<MadeLines*> made_lines(Scene& scene, Entity entity, const std::function<Outcome(const LineBlock&)>& visit,
                              std::size_t max_cached_knots) {
  const StreamlineSet& set = scene.entities.get<StreamlineSet>(entity);
  CATENA_TRY(const field::AnyField any, resolve_field(scene, set.field, set.where));
  if (!any.vector)
    return json::error_at(
        json::member_or_parent(set.where, "field"),
        in_quotes(scene.entities.get<Name>(set.field).value) + " is a scalar field; a vector field was expected for streamlines");
  if (!scene.cache.has<MadeLines>(entity)) scene.cache.emplace<MadeLines>(entity);
  MadeLines& made = scene.cache.get<MadeLines>(entity);
  if (!made.released && made.field_version == any.vector->version() && made.points == set.seeds.points) {
    if (visit) CATENA_CHECK(visit({made.curves, made.curves.size(), made.curves.size()}));
    return &made;
  }
  LineRequest request{{any.vector.get(), set.is_line_field, set.min_speed}, set.length, set.tolerance};
  request.box = scene.entities.get<FieldSource>(set.field).box;
  request.lines = set.lines;
  request.field = set.field;
  request.times = set.times;
  request.is_cubic_in_time = set.is_cubic_in_time;
  const std::string& name = scene.entities.get<Name>(set.field).value;
  if (while_tracing) request.progress = [&](std::size_t seeds, std::size_t of) { while_tracing(name, seeds, of); };
  MadeLines new_lines{any.vector->version(), set.seeds.points, {}, 0, false, {}};
  std::size_t knots = 0;
  const auto count = [&](std::span<const flow::CurvePtr> curves) {
    for (const flow::CurvePtr& curve : curves) {
      knots += curve->knots().size();
      Vec3 lo = curve->knots().front().p, hi = lo;
      for (const flow::Knot& knot : curve->knots()) {
        lo = glm::min(lo, knot.p);
        hi = glm::max(hi, knot.p);
      }
      new_lines.bounds.extend(lo);
      new_lines.bounds.extend(hi);
    }
  };
  if (visit) {
    request.visit = [&](const LineBlock& block) {
      count(block.curves);
      return visit(block);
    };
    request.max_cached_knots = max_cached_knots;
  }
  const json::Node where = set.lines == LineKind::stream ? json::member_or_parent(set.where, "seeds") : set.where;
  auto lines = trace_lines(scene, set.seeds, request, where);
  if (while_tracing) while_tracing(name, 0, 0);
  CATENA_TRY(new_lines.curves, std::move(lines));
  if (!visit) count(new_lines.curves);
  new_lines.released = knots > 0 && new_lines.curves.empty();
  static std::atomic<std::uint64_t> versions{0};
  new_lines.version = ++versions;
  made = std::move(new_lines);
  if (set.seeds.widget) drop_unused_curves(scene);
  return &made;
}

}  // namespace

Result<Curves> resolve_lines(Scene& scene, Entity set) {
  CATENA_TRY(const MadeLines* made, made_lines(scene, set, {}, 0));
  return made->curves;
}

Outcome visit_lines(Scene& scene, Entity set, const std::function<Outcome(const LineBlock&)>& visit, std::size_t max_cached_knots) {
  CATENA_CHECK(made_lines(scene, set, visit, max_cached_knots));
  return Done{};
}

std::uint64_t lines_version(Scene& scene, Entity entity) {
  if (!scene.cache.has<MadeLines>(entity)) return 0;
  const StreamlineSet& set = scene.entities.get<StreamlineSet>(entity);
  const MadeLines& made = scene.cache.get<MadeLines>(entity);
  const auto any = resolve_field(scene, set.field, set.where);
  return any && any->vector && made.field_version == any->vector->version() && made.points == set.seeds.points ? made.version : 0;
}

Bounds lines_bounds(const Scene& scene, Entity entity) {
  return scene.cache.has<MadeLines>(entity) ? scene.cache.get<MadeLines>(entity).bounds : Bounds();
}

void drop_unused_curves(Scene& scene) {
  std::erase_if(scene.traced_curves, [](const auto& entry) { return entry.second.use_count() == 1; });
}

namespace {

std::uint64_t loaded_version(const Scene& scene, Entity field) {
  const field::Field* loaded = field ? scene.entities.get<FieldSource>(field).loaded.get() : nullptr;
  return loaded == nullptr ? 0 : loaded->version();
}

bool same_seeds(const Scene& a_scene, const Seeds& a, const Scene& b_scene, const Seeds& b) {
  if (a.points != b.points || a.pattern.has_value() != b.pattern.has_value()) return false;
  if (!a.pattern) return true;
  const bool same = a.pattern->kind == b.pattern->kind && json::is_equal_value(a.pattern->where, b.pattern->where);
  return same && (!a.pattern->field || (loaded_version(a_scene, a.pattern->field) != 0 &&
                                        loaded_version(a_scene, a.pattern->field) == loaded_version(b_scene, b.pattern->field)));
}

bool same_lines(const Scene& a_scene, const StreamlineSet& a, const Scene& b_scene, const StreamlineSet& b) {
  return a.is_line_field == b.is_line_field && a.min_speed == b.min_speed && a.length == b.length && a.tolerance == b.tolerance &&
         a.lines == b.lines && a.times == b.times && a.is_cubic_in_time == b.is_cubic_in_time &&
         loaded_version(a_scene, a.field) == loaded_version(b_scene, b.field) &&
         a_scene.entities.get<FieldSource>(a.field).box == b_scene.entities.get<FieldSource>(b.field).box &&
         same_seeds(a_scene, a.seeds, b_scene, b.seeds);
}

}  // namespace

void transfer_lines(Scene& old, Scene& reloaded) {
  std::vector<Entity> sets;
  reloaded.entities.each<StreamlineSet>([&](Entity e, const StreamlineSet&) {
    if (!reloaded.cache.has<MadeLines>(e)) sets.push_back(e);
  });
  for (const Entity e : sets) {
    Entity found;
    old.cache.each<MadeLines>([&](Entity before, const MadeLines& made) {
      const StreamlineSet& set = old.entities.get<StreamlineSet>(before);
      if (made.field_version == loaded_version(reloaded, reloaded.entities.get<StreamlineSet>(e).field) &&
          same_lines(old, set, reloaded, reloaded.entities.get<StreamlineSet>(e)))
        found = before;
    });
    if (found) reloaded.cache.emplace<MadeLines>(e, old.cache.get<MadeLines>(found));
  }
}

}  // namespace catena::scene
