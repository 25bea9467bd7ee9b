#include <fmt/format.h>

#include "engine/base/machine_failure.h"
#include "engine/flow/vortex_cores.h"
#include "engine/schema/values.h"
#include "haptics/constraints/rules/link_keys.h"
#include "haptics/constraints/streamline/selected.h"
#include "haptics/constraints/streamline/streamline.h"

namespace catena::haptics {
namespace {

constexpr double kFarthestProbe = 1e100;  // squares of what lies beyond lose their meaning
constexpr double kNearer = 0.7;           // of the distance of the core held: one nearer than that takes its place

struct CoreMemory {
  Vec3 probe{0.0};       ///< the last one
  Vec3 core{0.0};        ///< the place on the core, or on the way to it
  Vec3 axis{0.0};        ///< of the core there, unit
  std::uint32_t line;    ///< of the cores
  bool holding = false;  ///< core and axis mean something
  bool fresh = false;    ///< `probe` means something
};

class VortexCore final : public Constraint {
 public:
  VortexCore(flow::VortexCoresPtr cores, double radius, double search, double length)
      : cores_(std::move(cores)), radius_(radius), search_(search), length_(length) {
    if (!cores_->lines.empty()) nearest_.emplace(cores_->lines);
    if (cores_->lines.size() > 1)
      for (const flow::CurvePtr& line : cores_->lines) by_line_.emplace_back(line);
  }

  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    memory_of<CoreMemory>(state) = CoreMemory{};
    state.released = false;
    pass(probe, state);
  }
  void seek(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    start(probe, state, scratch);
    advance(probe, state, scratch);
  }

  void advance(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    CoreMemory& memory = memory_of<CoreMemory>(state);
    state.limit = search_ - radius_;
    const double moved = memory.fresh ? norm(probe - memory.probe) : std::numeric_limits<double>::infinity();
    memory.probe = probe;
    memory.fresh = true;
    const bool held = memory.holding;
    state.released = false;
    memory.holding = nearest_ && max_abs(probe) < kFarthestProbe && find(probe, memory, state);
    if (!memory.holding) return pass(probe, state);
    state.curve = static_cast<std::int32_t>(memory.line);
    const Vec3 way = state.proxy - memory.core;
    const double gap = norm(probe - state.proxy), far = norm(way), travel = state.travel(moved, gap);
    if (held && far > travel) {
      state.proxy = memory.core + way * (travel / far);
      state.status = Status::budget;
    }
    memory.core = state.proxy;
    leave_tube(probe, state);
  }

  bool primitive(const Vec3&, LinkState& state, LinkScratch&, Primitive& out) const noexcept override {
    const CoreMemory& memory = memory_of<CoreMemory>(state);
    if (!memory.holding || radius_ > 0) return false;
    out = {Primitive::Kind::line, memory.core, memory.axis};
    return true;
  }
  /// Of the core, J; on the wall of a tube of radius r, e from the core to the probe: J + (r / |e|) (I - e e^T / |e|^2) (I - J).
  PulledBack pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch&) const noexcept override {
    const CoreMemory& memory = memory_of<CoreMemory>(state);
    if (!memory.holding || state.status == Status::free || state.status == Status::budget) return {f};
    const flow::NearestPlace found = on_line(memory.line, probe);
    if (!std::isfinite(found.distance2)) return {f};
    state.steps += found.work;
    const flow::Curve& line = *cores_->lines[memory.line];
    const Vec3 e = probe - memory.core, way = direction(e);
    const Vec3 across = radius_ > 0 ? (f - way * dot(way, f)) * (radius_ / norm(e)) : Vec3(0.0);
    PulledBack back = pull_back_on_curve(line, found.interval, found.s, probe, f - across);
    back.force += across;
    return back;
  }
  bool is_sane(const LinkState& state) const noexcept override {
    const CoreMemory& memory = memory_of<CoreMemory>(state);
    return are_bools(memory.holding, memory.fresh) && (!memory.holding || memory.line < cores_->lines.size());
  }
  bool has_primitive() const noexcept override { return radius_ == 0; }
  double domain_length() const noexcept override { return length_; }

 private:
  /// There is no core here, every place is one, or the core held has been let go for another one.
  void pass(const Vec3& probe, LinkState& state) const noexcept {
    state.proxy = probe;
    state.residual = 0;
    if (state.released)
      state.status = Status::released;
    else
      stop_link(state, cores_->everywhere ? Status::critical : Status::no_surface, cores_->everywhere ? Reason::parallel : Reason::none);
  }

  /// The nearest place of one core.
  flow::NearestPlace on_line(std::uint32_t line, const Vec3& probe) const noexcept {
    return (by_line_.empty() ? *nearest_ : by_line_[line]).at(probe, search_);
  }

  /// The nearest place of the core held, or of all where none is held or another one is much nearer: sets line, proxy and status. False:
  /// nothing is within `search`, or the core held has been let go for another one.
  bool find(const Vec3& probe, CoreMemory& memory, LinkState& state) const noexcept {
    flow::NearestPlace found = nearest_->at(probe, search_);
    state.steps += found.work;
    if (!std::isfinite(found.distance2)) return false;
    if (memory.holding && found.line != memory.line) {
      const flow::NearestPlace held = on_line(memory.line, probe);
      state.steps += held.work;
      state.released = found.distance2 < kNearer * kNearer * held.distance2;
      if (state.released) return false;
      found = held;
    } else {
      memory.line = static_cast<std::uint32_t>(found.line);
    }
    const flow::Curve& line = *cores_->lines[memory.line];
    Vec3 derivative;
    line.evaluate_in(found.interval, found.s, state.proxy, derivative);
    memory.axis = direction(derivative);
    state.residual = 0;
    state.status = Status::ok;
    const bool first = found.s == line.knots().front().s;
    if (line.closed() || (!first && found.s != line.knots().back().s)) return true;
    const flow::LineEnd& end = first ? line.first_end() : line.last_end();
    if (end == flow::End::boundary) stop_link(state, Status::boundary, end.reason);
    return true;
  }

  /// Within the tube the hand moves freely; beyond, it is held on its wall.
  void leave_tube(const Vec3& probe, LinkState& state) const noexcept {
    if (!(radius_ > 0)) return;
    const Vec3 e = probe - state.proxy;
    const double distance = norm(e);
    if (distance <= radius_) {
      state.proxy = probe;
      state.status = Status::free;
      return;
    }
    state.proxy += e * (radius_ / distance);
  }

  flow::VortexCoresPtr cores_;
  std::optional<flow::NearestOnCurve> nearest_;
  std::vector<flow::NearestOnCurve> by_line_;  ///< of more than one core
  double radius_, search_, length_;
};

Result<std::shared_ptr<const Constraint>> build_vortex_core(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const field::VectorFieldPtr field, require_vector_field(link, "field", "a vortex core", context));
  CATENA_TRY(const double radius, json::get_number(link, "radius", 0, json::Range::not_negative));
  CATENA_TRY(const double search, json::get_number(link, "search", std::fmax(0.1 * field->length(), 2 * radius), json::Range::positive));
  if (!(search > radius))
    return json::error_at(*link.find("search"),
                          fmt::format("\"search\" is {}; a number > \"radius\", which is {}, was expected", search, radius));
  flow::CoreOptions options;
  CATENA_CHECK(schema::read_value(schema::core_criterion_key(), link, options.criterion));
  CATENA_CHECK(schema::read_value(schema::core_length_key(), link, options.least_length));
  CATENA_CHECK(schema::read_value(schema::core_swirl_key(), link, options.least_swirl));
  auto cores = flow::vortex_cores(field, options);
  if (!cores) return caused_by(json::error_at(*link.find("field"), cores.error().message), cores.error());
  return std::shared_ptr<const Constraint>(std::make_shared<VortexCore>(*cores, radius, search, field->length()));
}

}  // namespace

ConstraintType vortex_core_constraint() {
  return {"vortex_core",
          "Holds the proxy in a tube about the core line of a vortex.",
          "not in the paper",
          {vector_field_key("field").required(),
           schema::number("radius", "world", "Radius of the tube in which the hand moves freely; 0: on the core.")
               .not_negative()
               .begins("0.1 L")
               .by_default("0"),
           schema::number("search", "world", "Longest distance of the core from the probe.")
               .positive()
               .begins("0.2 L")
               .by_default("0.1 L or 2 `radius`, the larger"),
           schema::core_criterion_key(), schema::core_length_key(), schema::core_swirl_key()},
          build_vortex_core};
}

}  // namespace catena::haptics
