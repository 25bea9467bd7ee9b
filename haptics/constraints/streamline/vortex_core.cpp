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

struct CoreMemory {
  SelectedMemory along;    ///< on the line held
  std::uint32_t line = 0;  ///< of the cores
  bool holding = false;    ///< the line and the place on it mean something
  bool fresh = false;      ///< `probe` and `core` mean something
  Vec3 probe{0.0};         ///< the last one
  Vec3 core{0.0};          ///< the place on the core, or on the way to it
};

class VortexCore final : public Constraint {
 public:
  VortexCore(flow::VortexCoresPtr cores, double radius, double search, double length)
      : cores_(std::move(cores)), radius_(radius), search_(search), length_(length) {
    if (!cores_->lines.empty()) nearest_.emplace(cores_->lines);
  }

  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    memory_of<CoreMemory>(state) = CoreMemory{};
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
    if (!nearest_ || !(max_abs(probe) < kFarthestProbe)) {
      memory.holding = false;
      return pass(probe, state);
    }
    if (memory.holding) {
      move_along(line_of(memory), probe, memory.along, state);
      change_line(probe, memory, state);
    }
    if (!memory.holding || norm(probe - state.proxy) > search_) {
      if (!take_hold(probe, memory, state)) return pass(probe, state);
      // from afar it pulls by the ramp
      if (norm(probe - state.proxy) > state.travel(moved, 0)) state.weight = 0;
    } else {
      go(moved, norm(probe - state.proxy), memory, state);
    }
    memory.core = state.proxy;
    leave_tube(probe, state);
  }

  bool primitive(const Vec3&, LinkState& state, LinkScratch&, Primitive& out) const noexcept override {
    const CoreMemory& memory = memory_of<CoreMemory>(state);
    if (!memory.holding || radius_ > 0) return false;
    Vec3 place, derivative;
    line_of(memory).evaluate_in(memory.along.interval, memory.along.s, place, derivative);
    out = {Primitive::Kind::line, place, direction(derivative)};
    return true;
  }
  bool is_sane(const LinkState& state) const noexcept override {
    const CoreMemory& memory = memory_of<CoreMemory>(state);
    if (!are_bools(memory.holding, memory.fresh)) return false;
    return !memory.holding || (memory.line < cores_->lines.size() && memory.along.interval + 1 < line_of(memory).knots().size());
  }
  bool has_primitive() const noexcept override { return radius_ == 0; }
  double domain_length() const noexcept override { return length_; }

 private:
  const flow::Curve& line_of(const CoreMemory& memory) const noexcept { return *cores_->lines[memory.line]; }

  /// There is no core here, or every place is one.
  void pass(const Vec3& probe, LinkState& state) const noexcept {
    state.proxy = probe;
    state.residual = 0;
    stop_link(state, cores_->everywhere ? Status::critical : Status::no_surface, cores_->everywhere ? Reason::parallel : Reason::none);
  }

  bool take_hold(const Vec3& probe, CoreMemory& memory, LinkState& state) const noexcept {
    const flow::NearestPlace found = nearest_->at(probe, search_);
    state.steps += found.work;
    memory.holding = std::isfinite(found.distance2);
    if (!memory.holding) return false;
    memory.line = static_cast<std::uint32_t>(found.line);
    memory.along = {found.s, found.interval, 0};
    // sets proxy and status there
    move_along(line_of(memory), probe, memory.along, state);
    return true;
  }

  /// At an open end another line may be nearer: it goes on there.
  void change_line(const Vec3& probe, CoreMemory& memory, LinkState& state) const noexcept {
    const flow::Curve& line = line_of(memory);
    const double s = memory.along.s;
    if (line.closed() || (s != line.knots().front().s && s != line.knots().back().s)) return;
    const Vec3 away = probe - state.proxy;
    const flow::NearestPlace found = nearest_->at(probe, search_);
    state.steps += found.work;
    if (found.line == memory.line || !(found.distance2 < dot(away, away))) return;
    memory.line = static_cast<std::uint32_t>(found.line);
    memory.along = {found.s, found.interval, 0};
    move_along(line_of(memory), probe, memory.along, state);
  }

  /// The place on the core moves in a tick no farther than the probe and the slip.
  void go(double moved, double gap, CoreMemory& memory, LinkState& state) const noexcept {
    const Vec3 way = state.proxy - memory.core;
    const double far = norm(way), travel = state.travel(moved, gap);
    if (!(far > travel)) return;
    state.proxy = memory.core + way * (travel / far);
    state.status = Status::budget;
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
