// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/batch_tracer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <thread>

#include "engine/base/threads.h"
#include "engine/geometry/flow/batch_rk4_step.h"
#include "engine/geometry/flow/curve.h"
#include "engine/geometry/flow/trace_internal.h"

namespace catena::flow {
namespace {

/// Point of a line: local coordinates, the rate there, and the (signed, scaled) time to the next point.
struct RawStep {
  double q[3];
  float h;
  float k[3];
};

/// One direction of one line, advanced by the steps of its lane. It accepts or shortens the steps, detects a closed line, the maximum
/// length and the points where the exact tracer (trace_branch()) must continue, and converts the steps to knots.
class BatchBranch {
 public:
  /// `out` is reset and filled; `steps` is scratch memory that is reused.
  BatchBranch(const VelocityBricks& bricks, const Flow& flow, const TraceOptions& options, double lap_gap, const Vec3& seed,
              const Vec3& tangent, double sign, std::vector<RawStep>& steps, Branch& out);
  double sign() const { return sign_; }

  /// Initializes the lane at the seed; returns false if `out` is already complete.
  bool start(LaneGroup& group, int i);
  /// Processes the lane's step from step_lanes() and sets up the next one; returns false if `out` is complete.
  bool process_step(LaneGroup& group, int i);

 private:
  bool place_lane(LaneGroup& group, int i, const Vec3& world, double first_step);
  bool shorten(LaneGroup& group, int i, float factor);
  bool continue_exactly(LaneGroup& group, int i);
  bool close_if_lap(const LaneGroup& group, int i);
  double world_length(const Vec3& local) const;
  double speed(const Float4& k) const;
  void add_knots();

  const VelocityBricks& bricks_;
  const Flow& flow_;
  const TraceOptions& options_;
  double lap_gap_;
  Vec3 seed_, tangent_;
  double sign_;
  std::vector<RawStep>& steps_;
  Vec3 seed_local_{0.0};
  Vec3 seed_normal_{0.0};  ///< the tangent as a covector in local coordinates
  double height_ = 0;      ///< signed distance from the seed's plane, world units
  double traveled_ = 0;    ///< length of the line so far: the sum of its chords, world units
  Branch& out_;
};

constexpr float kShortest = 1e-4f;   ///< voxels: below this step length the exact tracer continues
constexpr double kFirstStep = 0.25;  ///< voxels
constexpr double kExactPiece = 0.5;  ///< voxels: length that the exact tracer covers per call

/// Plain square root: rates, positions and voxel sizes of a batch are far from overflow and underflow.
double length_of(const Vec3& v) { return std::sqrt(dot(v, v)); }
Vec3 vector_of(const Float4& k) { return {static_cast<double>(k[0]), static_cast<double>(k[1]), static_cast<double>(k[2])}; }
Vec3 vector_of(const float (&k)[3]) { return {static_cast<double>(k[0]), static_cast<double>(k[1]), static_cast<double>(k[2])}; }
Vec3 vector_of(const Double4& q) { return {q[0], q[1], q[2]}; }

RawStep raw_step(const Double4& q, float h, const Float4& k) { return {{q[0], q[1], q[2]}, h, {k[0], k[1], k[2]}}; }

BatchBranch::BatchBranch(const VelocityBricks& bricks, const Flow& flow, const TraceOptions& options, double lap_gap, const Vec3& seed,
                         const Vec3& tangent, double sign, std::vector<RawStep>& steps, Branch& out)
    : bricks_(bricks),
      flow_(flow),
      options_(options),
      lap_gap_(lap_gap),
      seed_(seed),
      tangent_(tangent),
      sign_(sign),
      steps_(steps),
      out_(out) {
  steps_.clear();
  out_.knots.assign(1, {0, seed, tangent});
  out_.end = {};
}

inline double BatchBranch::world_length(const Vec3& local) const { return length_of(bricks_.world_from_rate() * local); }
double BatchBranch::speed(const Float4& k) const { return world_length(vector_of(k)) * bricks_.speed_from_rate(); }

bool BatchBranch::start(LaneGroup& group, int i) {
  seed_local_ = bricks_.local_from_index(flow_.field->mapping().index_from_world(seed_));
  seed_normal_ = tangent_ * bricks_.world_from_rate();
  return place_lane(group, i, seed_, kFirstStep) || continue_exactly(group, i);
}

/// Sets the lane to a position; returns false if rounding puts it outside the box, or if it is too slow for floats.
bool BatchBranch::place_lane(LaneGroup& group, int i, const Vec3& world, double first_step) {
  const Vec3 local = bricks_.local_from_index(flow_.field->mapping().index_from_world(world));
  const Double4 q{local.x, local.y, local.z, 0};
  Float4 k;
  const double length = rate_at(bricks_, q, k) ? length_of(vector_of(k)) : 0;
  if (!(length > 1e-15) || !(speed(k) > flow_.min_speed)) return false;
  group.q[i] = q;
  group.k[i] = k;
  double step = first_step / length;
  if (options_.max_step > 0) step = std::min(step, options_.max_step / world_length(vector_of(k)));
  group.h[i] = static_cast<float>(sign_ * step);
  steps_.push_back(raw_step(q, 0, k));
  return true;
}

bool BatchBranch::shorten(LaneGroup& group, int i, float factor) {
  const Float4 moved = group.k[i] * group.h[i];
  if (!(moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2] > kShortest * kShortest)) return continue_exactly(group, i);
  group.h[i] *= factor;
  return true;
}

/// Continues with the exact tracer until the line ends (returns false), or in pieces of `kExactPiece` until the lane can take over (true).
bool BatchBranch::continue_exactly(LaneGroup& group, int i) {
  std::vector<Knot>& knots = out_.knots;
  const double domain = flow_.field->domain_length();
  add_knots();
  for (;;) {
    const Knot from = knots.back();
    TraceOptions piece = options_;
    const double remaining = options_.length - std::fabs(from.s);
    if (!(remaining > 1e-12 * domain) || knots.size() >= options_.max_knots) return false;
    // a line that the exact tracer starts at the seed is traced completely, including the test for a closed line
    const bool starts_at_seed = knots.size() == 1;
    piece.length = starts_at_seed ? remaining : std::min(remaining, kExactPiece * flow_.field->max_voxel_edge());
    const Branch continuation = trace_branch(flow_, from.p, sign_, piece);
    for (std::size_t n = 1; n < continuation.knots.size(); ++n) {
      const double s = from.s + continuation.knots[n].s, distance = std::fabs(s) - std::fabs(knots.back().s);
      if (distance < 1e-10 * domain && (n + 1 < continuation.knots.size() || !(distance > 0))) continue;
      knots.push_back({s, continuation.knots[n].p, continuation.knots[n].t});
    }
    const Termination termination = continuation.end.termination;
    out_.end = termination == Termination::lap && !starts_at_seed ? LineEnd{} : continuation.end;
    if (termination == Termination::boundary || termination == Termination::critical || termination == Termination::incoherent ||
        starts_at_seed || continuation.knots.size() < 2)
      return false;
    traveled_ = std::fabs(knots.back().s);
    height_ = dot(knots.back().p - seed_, tangent_);
    out_.end = {};
    if (place_lane(group, i, knots.back().p, kFirstStep)) return true;
  }
}

bool BatchBranch::process_step(LaneGroup& group, int i) {
  // rejected: a stage left the box or its valid cells (NaN), the line turned by more than 60 degrees, or the error is too large
  const float speed2 = group.speed2[i];
  const RawStep& last = steps_.back();
  const float last2 = last.k[0] * last.k[0] + last.k[1] * last.k[1] + last.k[2] * last.k[2];
  if (group.left_box[i] || !(speed2 > 1e-30f) || !(group.tangent_dot[i] > 0) ||
      !(group.tangent_dot[i] * group.tangent_dot[i] > 0.25f * last2 * speed2))
    return shorten(group, i, 0.5f);
  if (!(group.error2[i] <= group.max_error2[i])) {
    const float factor = group.next_h[i] / group.h[i];
    return shorten(group, i, factor < 0.8f ? factor : 0.8f);
  }
  if (flow_.min_speed > 0 && !(speed(group.k_end[i]) > flow_.min_speed)) return shorten(group, i, 0.5f);

  // accepted
  if (sign_ > 0 && close_if_lap(group, i)) return false;
  steps_.back().h = group.h[i];
  traveled_ += world_length(vector_of(group.end[i]) - vector_of(group.q[i]));
  group.q[i] = group.end[i];
  group.k[i] = group.k_end[i];
  group.h[i] = group.next_h[i];
  steps_.push_back(raw_step(group.q[i], 0, group.k[i]));
  if (traveled_ >= options_.length || out_.knots.size() + steps_.size() >= options_.max_knots) {
    add_knots();
    return false;
  }
  // step length near 0: close to a zero of the field
  return speed2 * group.h[i] * group.h[i] >= kShortest * kShortest || continue_exactly(group, i);
}

/// Returns true and completes the line if the step crosses the seed's plane in the seed's direction, within lap_gap_ of the seed.
bool BatchBranch::close_if_lap(const LaneGroup& group, int i) {
  const Vec3 end = vector_of(group.end[i]), offset = end - seed_local_;
  const double height_before = height_, height_after = dot(offset, seed_normal_);
  height_ = height_after;
  if (!(height_before < 0 && height_after >= 0)) return false;
  const Vec3 from = vector_of(group.q[i]);
  if (world_length(offset) > 2 * world_length(end - from) + lap_gap_) return false;
  const double h = static_cast<double>(group.h[i]);
  const Hermite piece(from, end - from, h, vector_of(group.k[i]), vector_of(group.k_end[i]));
  const double theta =
      illinois_root(0.0, height_before, 1.0, height_after, [&](double at) { return dot(piece.evaluate(at) - seed_local_, seed_normal_); });
  if (world_length(piece.evaluate(theta) - seed_local_) > lap_gap_ || theta * h <= 0) return false;
  steps_.back().h = static_cast<float>(theta * h);
  const RawStep first = steps_.front();
  steps_.push_back({{seed_local_.x, seed_local_.y, seed_local_.z}, 0, {first.k[0], first.k[1], first.k[2]}});
  add_knots();
  out_.end = {Termination::lap, SampleStatus::ok};
  out_.knots.back().p = seed_;
  out_.knots.back().t = tangent_;
  return true;
}

/// Appends the steps to the knots and clears them.
void BatchBranch::add_knots() {
  if (steps_.empty()) return;
  const field::Mapping& mapping = flow_.field->mapping();
  const Mat3& linear = bricks_.world_from_rate();
  const auto position_of = [&](const RawStep& step) {
    return mapping.world_from_index(bricks_.index_from_local({step.q[0], step.q[1], step.q[2]}));
  };
  std::vector<Knot>& knots = out_.knots;
  Vec3 p = knots.back().p, w = linear * vector_of(steps_.front().k);
  double length = length_of(w), s = std::fabs(knots.back().s);
  for (std::size_t i = 1; i < steps_.size(); ++i) {
    const Vec3 p_next = position_of(steps_[i]), w_next = linear * vector_of(steps_[i].k);
    const double h = static_cast<double>(steps_[i - 1].h), length_next = length_of(w_next);
    // Simpson's rule on the cubic of the step
    const Vec3 middle = (1.5 / h) * (p_next - p) - 0.25 * (w + w_next);
    const double piece = std::fabs(h) / 6 * (length + 4 * length_of(middle) + length_next);
    if (s + piece > options_.length) {
      // the maximum length is reached within the step
      const Hermite cubic(p, p_next - p, h, w, w_next);
      const double theta = (options_.length - s) / piece;
      if (theta > 1e-9) knots.push_back({sign_ * options_.length, cubic.evaluate(theta), direction(cubic.derivative(theta) / h)});
      break;
    }
    s += piece;
    knots.push_back({sign_ * s, p_next, (1 / length_next) * w_next});
    p = p_next;
    w = w_next;
    length = length_next;
  }
  steps_.clear();
}

constexpr double kLapGap = 0.01;           ///< voxels
constexpr float kMaxStep = 0.5f;           ///< voxels
constexpr double kByHandTolerance = 1e-8;  ///< tolerance of the exact tracer's pieces, as errors grow near saddles

using Slots = std::vector<std::optional<Result<CurvePtr>>>;

std::vector<Result<CurvePtr>> take_results(Slots& slots) {
  std::vector<Result<CurvePtr>> results;
  results.reserve(slots.size());
  for (auto& slot : slots) results.push_back(std::move(*slot));
  return results;
}

/// Runs one worker per core, `max_workers` at most; each worker takes seeds until none is left.
void on_all_cores(std::size_t max_workers, const std::function<void()>& worker) {
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  parallel_for(std::min(cores, max_workers), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) worker();
  });
}

/// Returns the seeds in Morton order: neighboring lines are traced together, through bricks that are in the cache.
std::vector<std::uint32_t> along_curve(const Flow& flow, std::span<const Vec3> seeds) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  keys.reserve(seeds.size());
  const field::Box& box = flow.field->index_box();
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Vec3 local = flow.field->mapping().index_from_world(seeds[i]) - box.lo;
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = local[axis] / 4;
      const auto n = static_cast<std::uint64_t>(x > 0 && x < 1048576 ? x : 0);
      for (int bit = 0; bit < 20; ++bit) key |= (n >> bit & 1) << (3 * bit + axis);
    }
    keys.emplace_back(key, static_cast<std::uint32_t>(i));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const auto& key : keys) order.push_back(key.second);
  return order;
}

/// The lanes of one core: each traces one direction of one line at a time.
class Worker {
 public:
  Worker(const VelocityBricks& bricks, const Flow& flow, const BatchOptions& options, std::span<const Vec3> seeds,
         std::span<const std::uint32_t> order, std::atomic<std::size_t>& next, Slots& slots)
      : bricks_(bricks), flow_(flow), seeds_(seeds), order_(order), next_(next), slots_(slots) {
    const double tolerance = options.tolerance * flow.field->domain_length() / flow.field->max_voxel_edge();
    control_.tolerance2 = static_cast<float>(tolerance * tolerance);
    control_.max_step = options.max_step > 0 ? static_cast<float>(options.max_step) : kMaxStep;
    trace_.length = options.length;
    trace_.max_knots = options.max_knots;
    trace_.max_step = options.max_step * flow.field->max_voxel_edge();
    trace_.tolerance = trace_.hermite_tolerance = std::min(options.tolerance, kByHandTolerance);
    trace_ = resolve_options(flow, trace_);
    lap_gap_ = std::max(kLapGap * flow.field->max_voxel_edge(), 10 * options.tolerance * flow.field->domain_length());
    for (int i = 0; i < kLanes; ++i) rest(i);
  }

  void run() {
    for (int i = 0; i < kLanes; ++i) begin_next(i);
    while (busy_ > 0) {
      step_lanes(bricks_, control_, group_);
      for (int i = 0; i < kLanes; ++i)
        if (lanes_[i].branch && !lanes_[i].branch->process_step(group_, i)) end_branch(i);
    }
  }

 private:
  struct Lane {
    std::optional<BatchBranch> branch;
    std::size_t seed = 0;
    Vec3 tangent{0.0};
    Branch forward, backward;  ///< these and `steps` are memory that is reused for every line
    std::vector<RawStep> steps;
  };

  /// Parks an idle lane at a valid position with a step of 0.
  void rest(int i) {
    group_.q[i] = Double4{1.5, 1.5, 1.5, 0};
    group_.k[i] = Float4{};
    group_.h[i] = 0;
  }

  void begin_next(int i) {
    for (;;) {
      const std::size_t order_index = next_.fetch_add(1, std::memory_order_relaxed);
      if (order_index >= order_.size()) return rest(i);
      const std::size_t at = order_[order_index];
      const auto tangent = seed_tangent(flow_, seeds_[at]);
      if (!tangent) {
        slots_[at] = tangent.error();
        continue;
      }
      Lane& lane = lanes_[i];
      lane.seed = at;
      lane.tangent = *tangent;
      ++busy_;
      begin_branch(i, 1);
      return;
    }
  }

  void begin_branch(int i, double sign) {
    Lane& lane = lanes_[i];
    lane.branch.emplace(bricks_, flow_, trace_, lap_gap_, seeds_[lane.seed], lane.tangent, sign, lane.steps,
                        sign > 0 ? lane.forward : lane.backward);
    if (!lane.branch->start(group_, i)) end_branch(i);
  }

  void end_branch(int i) {
    Lane& lane = lanes_[i];
    const bool is_forward = lane.branch->sign() > 0;
    lane.branch.reset();
    if (is_forward && lane.forward.end.termination != Termination::lap) return begin_branch(i, -1);
    slots_[lane.seed] = join_branches(flow_, seeds_[lane.seed], lane.forward, lane.backward);
    --busy_;
    begin_next(i);
  }

  const VelocityBricks& bricks_;
  Flow flow_;
  TraceOptions trace_;
  StepControl control_;
  double lap_gap_ = 0;
  std::span<const Vec3> seeds_;
  std::span<const std::uint32_t> order_;
  std::atomic<std::size_t>& next_;
  Slots& slots_;
  LaneGroup group_{};
  Lane lanes_[kLanes];
  int busy_ = 0;
};

}  // namespace

BatchTracer::BatchTracer(const Flow& flow, const BatchOptions& options) : flow_(flow), options_(options) {
  const field::VectorGrid* grid = flow.field->grid();
  if (grid == nullptr || flow.is_line_field || grid->interpolation() == field::Interpolation::cubic) return;
  const Vec3 size = grid->index_box().hi - grid->index_box().lo;
  if (size.x >= 1 && size.y >= 1 && size.z >= 1) bricks_ = std::make_unique<VelocityBricks>(*grid);
}

BatchTracer::~BatchTracer() = default;

std::vector<Result<CurvePtr>> BatchTracer::trace(std::span<const Vec3> seeds) const {
  if (!bricks_) {
    TraceOptions options;
    options.length = options_.length;
    options.max_knots = options_.max_knots;
    options.max_step = options_.max_step * flow_.field->max_voxel_edge();
    options.tolerance = options.hermite_tolerance = options_.tolerance;
    return trace_all(flow_, seeds, options);
  }
  const std::vector<std::uint32_t> order = along_curve(flow_, seeds);
  Slots slots(seeds.size());
  std::atomic<std::size_t> next{0};
  on_all_cores((seeds.size() + kLanes - 1) / kLanes, [&] { Worker(*bricks_, flow_, options_, seeds, order, next, slots).run(); });
  return take_results(slots);
}

std::vector<Result<CurvePtr>> trace_all(const Flow& flow, std::span<const Vec3> seeds, const TraceOptions& options) {
  Slots slots(seeds.size());
  std::atomic<std::size_t> next{0};
  on_all_cores(seeds.size(), [&] {
    for (std::size_t at; (at = next.fetch_add(1, std::memory_order_relaxed)) < seeds.size();)
      slots[at] = flow::trace(flow, seeds[at], options);
  });
  return take_results(slots);
}

}  // namespace catena::flow
