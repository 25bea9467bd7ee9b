// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "engine/base/system_failure.h"
#include "engine/geometry/flow/vortex_cores.h"
#include "engine/schema/values.h"
#include "haptics/constraints/common/link_schema.h"
#include "haptics/constraints/streamline/selected_streamline.h"
#include "haptics/constraints/streamline/streamline.h"

namespace catena::haptics {
namespace {

constexpr double kFarthestProbe = 1e100;  // beyond this distance squares lose precision
constexpr double kNearer = 0.7;           // fraction of the distance to the held core below which a nearer core replaces it

struct CoreMemory {
  Vec3 probe{0.0};       ///< the last probe
  Vec3 core{0.0};        ///< the proxy's point on the core, or on the path to it
  Vec3 axis{0.0};        ///< unit axis of the core at that point
  std::uint32_t line;    ///< index of the core
  bool holding = false;  ///< core and axis are valid
  bool fresh = false;    ///< `probe` is valid
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
    memory_as<CoreMemory>(state) = CoreMemory{};
    state.released = false;
    pass(probe, state);
  }
  void seek(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    start(probe, state, scratch);
    advance(probe, state, scratch);
  }

  void advance(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    CoreMemory& memory = memory_as<CoreMemory>(state);
    state.limit = search_ - radius_;
    const double moved = memory.fresh ? norm(probe - memory.probe) : std::numeric_limits<double>::infinity();
    memory.probe = probe;
    memory.fresh = true;
    const bool held = memory.holding;
    state.released = false;
    memory.holding = nearest_ && max_abs(probe) < kFarthestProbe && find(probe, memory, state);
    if (!memory.holding) return pass(probe, state);
    state.curve_index = static_cast<std::int32_t>(memory.line);
    const Vec3 way = state.proxy - memory.core;
    const double gap = norm(probe - state.proxy), far = norm(way), travel = state.max_travel(moved, gap);
    if (held && far > travel) {
      state.proxy = memory.core + way * (travel / far);
      state.status = LinkStatus::budget;
    }
    memory.core = state.proxy;
    leave_tube(probe, state);
  }

  bool primitive(const Vec3&, LinkState& state, LinkScratch&, Primitive& out) const noexcept override {
    const CoreMemory& memory = memory_as<CoreMemory>(state);
    if (!memory.holding || radius_ > 0) return false;
    out = {Primitive::Kind::line, memory.core, memory.axis};
    return true;
  }
  /// J of the core; on the wall of a tube of radius r, with e from the core to the probe: J + (r / |e|) (I - e e^T / |e|^2) (I - J).
  PulledBackForce pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch&) const noexcept override {
    const CoreMemory& memory = memory_as<CoreMemory>(state);
    if (!memory.holding || state.status == LinkStatus::free || state.status == LinkStatus::budget) return {f};
    const flow::NearestPoint found = on_line(memory.line, probe);
    if (!std::isfinite(found.distance2)) return {f};
    state.other_work += found.work;
    const flow::Curve& line = *cores_->lines[memory.line];
    const Vec3 e = probe - memory.core, way = direction(e);
    const Vec3 across = radius_ > 0 ? (f - way * dot(way, f)) * (radius_ / norm(e)) : Vec3(0.0);
    PulledBackForce back = pull_back_on_curve(line, found.interval, found.s, probe, f - across);
    back.force += across;
    return back;
  }
  bool is_sane(const LinkState& state) const noexcept override {
    const CoreMemory& memory = memory_as<CoreMemory>(state);
    return are_valid_bools(memory.holding, memory.fresh) && (!memory.holding || memory.line < cores_->lines.size());
  }
  bool has_primitive() const noexcept override { return radius_ == 0; }
  double domain_length() const noexcept override { return length_; }

 private:
  /// Passes the probe through: there is no core here, the core condition holds everywhere, or the held core was released for another one.
  void pass(const Vec3& probe, LinkState& state) const noexcept {
    state.proxy = probe;
    state.residual = 0;
    if (state.released)
      state.status = LinkStatus::released;
    else
      set_link_status(state, cores_->holds_everywhere ? LinkStatus::critical : LinkStatus::no_surface,
                      cores_->holds_everywhere ? SampleStatus::parallel : SampleStatus::ok);
  }

  /// Returns the nearest point of one core.
  flow::NearestPoint on_line(std::uint32_t line, const Vec3& probe) const noexcept {
    return (by_line_.empty() ? *nearest_ : by_line_[line]).find(probe, search_);
  }

  /// Finds the nearest point of the held core, or of all cores if none is held or another one is much nearer; sets line, proxy and status.
  /// Returns false if nothing is within `search`, or the held core was released for another one.
  bool find(const Vec3& probe, CoreMemory& memory, LinkState& state) const noexcept {
    flow::NearestPoint found = nearest_->find(probe, search_);
    state.other_work += found.work;
    if (!std::isfinite(found.distance2)) return false;
    if (memory.holding && found.line != memory.line) {
      const flow::NearestPoint held = on_line(memory.line, probe);
      state.other_work += held.work;
      state.released = found.distance2 < kNearer * kNearer * held.distance2;
      if (state.released) return false;
      found = held;
    } else {
      memory.line = static_cast<std::uint32_t>(found.line);
    }
    const flow::Curve& line = *cores_->lines[memory.line];
    Vec3 derivative;
    line.evaluate_interval(found.interval, found.s, state.proxy, derivative);
    memory.axis = direction(derivative);
    state.residual = 0;
    state.status = LinkStatus::ok;
    const bool first = found.s == line.knots().front().s;
    if (line.is_closed() || (!first && found.s != line.knots().back().s)) return true;
    const flow::LineEnd& end = first ? line.first_end() : line.last_end();
    if (end == flow::Termination::boundary) set_link_status(state, LinkStatus::boundary, end.status);
    return true;
  }

  /// Sets the proxy: inside the tube the probe moves freely; outside, the proxy is held on the tube's wall.
  void leave_tube(const Vec3& probe, LinkState& state) const noexcept {
    if (!(radius_ > 0)) return;
    const Vec3 e = probe - state.proxy;
    const double distance = norm(e);
    if (distance <= radius_) {
      state.proxy = probe;
      state.status = LinkStatus::free;
      return;
    }
    state.proxy += e * (radius_ / distance);
  }

  flow::VortexCoresPtr cores_;
  std::optional<flow::NearestOnCurve> nearest_;
  std::vector<flow::NearestOnCurve> by_line_;  ///< one per core; empty for a single core
  double radius_, search_, length_;
};

Result<std::shared_ptr<const Constraint>> build_vortex_core(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const field::VectorFieldPtr field, require_vector_field(link, "field", "a vortex core", context));
  CATENA_TRY(const double radius, json::get_number(link, "radius", 0, json::NumberRange::non_negative));
  CATENA_TRY(const double search,
             json::get_number(link, "search_radius", std::fmax(0.1 * field->domain_length(), 2 * radius), json::NumberRange::positive));
  if (!(search > radius))
    return json::error_at(*link.find("search_radius"),
                          fmt::format("\"search_radius\" is {}; a number > \"radius\", which is {}, was expected", search, radius));
  flow::CoreOptions options;
  CATENA_CHECK(schema::read_value(schema::core_criterion_key(), link, options.criterion));
  CATENA_CHECK(schema::read_value(schema::core_length_key(), link, options.min_length));
  CATENA_CHECK(schema::read_value(schema::core_swirl_key(), link, options.min_swirl));
  auto cores = flow::find_vortex_cores(field, options);
  if (!cores) return with_cause(json::error_at(*link.find("field"), cores.error().message), cores.error());
  return std::shared_ptr<const Constraint>(std::make_shared<VortexCore>(*cores, radius, search, field->domain_length()));
}

}  // namespace

ConstraintType vortex_core_constraint() {
  return {"vortex_core",
          "Holds the proxy in a tube about the core line of a vortex.",
          "not in the paper",
          {vector_field_key("field").required(),
           schema::number("radius", "world", "Radius of the tube in which the probe moves freely; 0: the proxy lies on the core line.")
               .non_negative()
               .with_initial_value("0.1 L")
               .with_default("0"),
           schema::number("search_radius", "world", "Maximum distance between probe and core line.")
               .positive()
               .with_initial_value("0.2 L")
               .with_default("0.1 L or 2 `radius`, whichever is larger"),
           schema::core_criterion_key(), schema::core_length_key(), schema::core_swirl_key()},
          build_vortex_core};
}

}  // namespace catena::haptics
