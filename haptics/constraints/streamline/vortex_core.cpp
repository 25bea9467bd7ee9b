#include "haptics/constraints/streamline/streamline.h"

#include <fmt/format.h>

#include "engine/flow/derivatives.h"
#include "haptics/constraints/isosurface/level.h"
#include "haptics/constraints/rules/link_keys.h"

namespace catena::haptics {
namespace {

constexpr int kIterations = 32, kCoreHalvings = 40;
constexpr int kTrials = 100;         // fetches a search
constexpr double kOnCore = 1e-12;    // of L, across the axis
constexpr double kAlong = 1e-9;      // of L, along it
constexpr double kSwirl = 1e-6;      // least (4 det A - tr^2) / |A|^2
constexpr double kVorticity = 1e-4;  // least |curl v| / |grad v|
constexpr double kMotion = 1e-6;     // least L |grad v| / |v|

struct CoreMemory {
  Vec3 core{0.0}, axis{0.0};
  Vec3 probe{0.0}, proxy{0.0};
  double residual = 0;
  bool holding;  ///< core and axis mean something
  bool settled;  ///< nothing to gain from another tick at the same probe
  Status status;
};

/// The way from a place to the core, and across it the plane.
struct Way {
  Vec3 axis{0.0};
  Vec3 across{0.0};   ///< within the plane
  double along = 0;   ///< up the axis, to the probe's plane
  double height = 0;  ///< the same before it is cut to the search
  bool swirls = false, known = false;
};

constexpr double kKink = 1e-6;   // of L: where A jumps, so near counts as on the core
constexpr double kLearn = 1e-6;  // of L: shortest step to learn from

double frobenius(const Mat3& m) { return std::sqrt(dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2])); }

struct VortexCoreSpec {
  field::VectorFieldPtr field;
  double radius = 0, search = 0;
};

/// One search of one tick.
class Search {
 public:
  Search(const VortexCoreSpec& spec, const Vec3& probe, LinkState& state, field::Cursor& cursor)
      : spec_(spec), probe_(probe), state_(state), cursor_(cursor), length_(spec.field->length()) {}

  bool found = false;
  Vec3 core{0.0}, axis{0.0};
  double residual = 0;
  Status status = Status::ok;

  void from(const Vec3& place) noexcept {
    found = false;
    core = place;
    trials_ = 0;
    Way way = look(place);
    if (!way.swirls) return;
    for (int i = 0; i < kIterations; ++i) {
      const double left = size(way);
      if (norm(way.across) <= kOnCore * length_ && std::fabs(way.along) <= kAlong * length_)
        return finish(way, left, with_axis_ ? Status::ok : Status::boundary);
      Vec3 step = way.across + way.axis * (way.along / fall_);
      if (norm(step) > spec_.search) step *= spec_.search / norm(step);
      const Vec3 full = step;
      bool moved = false, outside = false, beyond = false;
      for (int k = 0; k < 4 && !moved && may_try(); ++k, step *= 0.5) {
        const Way next = look(core + step);
        outside = outside || !next.known;
        beyond = beyond || (k == 0 && next.swirls && next.height * way.height < 0);
        if (!next.swirls || !(size(next) < left)) continue;
        learn(way, next, step);
        core += step;
        way = next;
        moved = true;
      }
      if (moved) continue;
      if (!may_try()) break;
      if (outside && with_axis_ && way.along != 0) {
        // the axis leads out of the domain: the nearest place of the core in this plane
        with_axis_ = false;
        way.along = way.height = 0;
        continue;
      }
      if (beyond) return halve(way, core + full);
      if (norm(way.across) <= kKink * length_) finish(way, size(way), Status::ok);
      return;
    }
    finish(way, size(way), Status::budget);
  }

 private:
  /// How fast the height falls along the axis: 1 on a straight core, by the secant on a curved one.
  void learn(const Way& before, const Way& after, const Vec3& step) noexcept {
    const double moved = dot(before.axis, step);
    if (std::fabs(moved) > kLearn * length_) fall_ = std::fmax(0.3, std::fmin((before.height - after.height) / moved, 3.0));
  }
  /// The axis turns by a step between two cells, and the probe's plane meets the core there: halve down to the face.
  void halve(Way way, Vec3 beyond) noexcept {
    const bool up = way.height > 0;
    for (int i = 0; i < kCoreHalvings && norm(beyond - core) > kAlong * length_; ++i) {
      if (!may_try()) return finish(way, size(way), Status::budget);
      const Vec3 middle = 0.5 * (core + beyond);
      const Way here = look(middle);
      if (here.swirls && (here.height > 0) == up) {
        core = middle + here.across;
        way = here;
      } else {
        beyond = middle + here.across;
      }
    }
    way.along = 0;
    finish(way, size(way), Status::ok);
  }
  bool may_try() const noexcept { return trials_ < kTrials / flow::velocity_gradient_fetches(*spec_.field) && affordable(); }
  double size(const Way& way) const noexcept { return norm(Vec3(norm(way.across), way.along, 0)); }
  bool affordable() const noexcept { return state_.evaluations + flow::velocity_gradient_fetches(*spec_.field) <= kEvaluationCap; }
  void finish(const Way& way, double left, Status how) noexcept {
    found = true;
    axis = way.axis;
    residual = left;
    status = how;
    if (how == Status::boundary) state_.reason = where_the_axis_leads();
  }

  Reason where_the_axis_leads() noexcept {
    const Vec3 way = axis * (1e-6 * length_);
    const Reason ahead = spec_.field->why_outside(core + way, cursor_);
    return ahead != Reason::none ? ahead : spec_.field->why_outside(core - way, cursor_);
  }

  Way look(const Vec3& place) noexcept {
    Way way;
    if (!affordable()) return way;
    ++trials_;
    const flow::VelocityGradient here = flow::velocity_gradient(*spec_.field, place, cursor_, state_.evaluations);
    way.known = here.known;
    if (!here.known) return way;
    const double steepness = frobenius(here.gradient);
    const Vec3 curl = flow::curl(here.gradient);
    if (!(steepness * length_ > kMotion) || !(norm(curl) > kVorticity * steepness)) return way;
    way.axis = direction(curl);
    const double along = dot(way.axis, probe_ - place);
    if (!std::isfinite(along)) return way;
    way.height = with_axis_ ? along : 0;
    way.along = std::fmax(-spec_.search, std::fmin(spec_.search, way.height));

    // the plane across the axis
    Vec3 a, b;
    tangents(way.axis, a, b);
    const Vec3 ga = here.gradient * a, gb = here.gradient * b, v = here.v + here.gradient * way.axis * way.along;
    const double aa = dot(a, ga), ab = dot(a, gb), ba = dot(b, ga), bb = dot(b, gb);
    const double det = aa * bb - ab * ba, trace = aa + bb;
    const double swirl = 4 * det - trace * trace;
    if (!(swirl > kSwirl * (aa * aa + ab * ab + ba * ba + bb * bb))) return way;
    const double fa = dot(a, v), fb = dot(b, v);
    way.across = a * ((ab * fb - bb * fa) / det) + b * ((ba * fa - aa * fb) / det);
    way.swirls = is_finite(way.across);
    return way;
  }

  const VortexCoreSpec& spec_;
  Vec3 probe_;
  LinkState& state_;
  field::Cursor& cursor_;
  double length_;
  double fall_ = 1;
  int trials_ = 0;
  bool with_axis_ = true;
};

class VortexCore final : public Constraint {
 public:
  explicit VortexCore(const VortexCoreSpec& spec) : spec_(spec) {}

  /// The first tick finds the core.
  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    memory_of<CoreMemory>(state) = CoreMemory{};
    state.proxy = probe;
    state.residual = 0;
    state.status = Status::no_surface;
  }
  void seek(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    start(probe, state, scratch);
    advance(probe, state, scratch);
  }

  void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override {
    CoreMemory& memory = memory_of<CoreMemory>(state);
    state.limit = spec_.search - spec_.radius;
    if (!(memory.settled && same_bits(memory.probe, probe))) {
      find(probe, memory, state, scratch);
      memory.probe = probe;
    }
    state.proxy = memory.proxy;
    state.residual = memory.residual;
    state.status = memory.status;
  }

  bool primitive(const Vec3&, LinkState& state, LinkScratch&, Primitive& out) const noexcept override {
    const CoreMemory& memory = memory_of<CoreMemory>(state);
    if (!memory.holding || spec_.radius > 0) return false;
    out = {Primitive::Kind::line, memory.core, memory.axis};
    return true;
  }
  bool is_sane(const LinkState& state) const noexcept override {
    const CoreMemory& memory = memory_of<CoreMemory>(state);
    return are_bools(memory.holding, memory.settled) && is_one_of(memory.status, Status::bad_probe);
  }
  bool has_primitive() const noexcept override { return spec_.radius == 0; }
  double domain_length() const noexcept override { return spec_.field->length(); }

 private:
  void find(const Vec3& probe, CoreMemory& memory, LinkState& state, LinkScratch& scratch) const noexcept {
    Search from_last(spec_, probe, state, scratch.cursors[0]), from_probe(spec_, probe, state, scratch.cursors[0]);
    Search* search = &from_last;
    if (memory.holding) from_last.from(memory.core);
    if (!reaches(from_last, probe)) {
      search = &from_probe;
      from_probe.from(probe);
    }
    memory.proxy = probe;
    memory.residual = 0;
    memory.holding = reaches(*search, probe);
    memory.settled = !memory.holding || search->status != Status::budget;
    memory.status = Status::no_surface;
    if (!memory.holding) return;
    memory.core = search->core;
    memory.axis = search->axis;
    const Vec3 e = across(*search, probe);
    const double distance = norm(e);
    memory.status = Status::free;
    if (spec_.radius > 0 && distance <= spec_.radius) return;
    memory.status = search->status;
    memory.residual = search->residual;
    memory.proxy = spec_.radius > 0 ? search->core + e * (spec_.radius / distance) : search->core;
  }

  static Vec3 across(const Search& search, const Vec3& probe) noexcept {
    const Vec3 e = probe - search.core;
    return e - search.axis * dot(search.axis, e);
  }
  bool reaches(const Search& search, const Vec3& probe) const noexcept {
    return search.found && norm(across(search, probe)) <= spec_.search && norm(probe - search.core) <= 2 * spec_.search;
  }

  VortexCoreSpec spec_;
};

Result<std::shared_ptr<const Constraint>> build_vortex_core(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const field::VectorFieldPtr field, require_vector_field(link, "field", "a vortex core", context));
  VortexCoreSpec spec;
  spec.field = field;
  CATENA_TRY(spec.radius, json::get_number(link, "radius", 0, json::Range::not_negative));
  CATENA_TRY(spec.search, json::get_number(link, "search", std::fmax(0.1 * field->length(), 2 * spec.radius), json::Range::positive));
  if (!(spec.search > spec.radius))
    return json::error_at(*link.find("search"),
                          fmt::format("\"search\" is {}; a number > \"radius\", which is {}, was expected", spec.search, spec.radius));
  return std::shared_ptr<const Constraint>(std::make_shared<VortexCore>(spec));
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
               .by_default("0.1 L or 2 `radius`, the larger")},
          build_vortex_core};
}

}  // namespace catena::haptics
