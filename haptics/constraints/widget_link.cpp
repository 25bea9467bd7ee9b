#include "haptics/constraints/widget_link.h"

#include "haptics/constraints/shapes/surface_shapes.h"

namespace catena::haptics {
namespace {

using widget::Shape;

bool usable(const Shape& shape) noexcept {
  return shape.kind != Shape::Kind::none && is_finite(shape.origin) && is_finite(shape.normal) && std::isfinite(shape.radius);
}

Hold closest(const Shape& shape, const Vec3& probe, LinkState& state) noexcept {
  const SideMemory none{};
  NoMemory nothing;
  switch (shape.kind) {
    case Shape::Kind::plane:
      return PlaneSurface({shape.origin, shape.normal}, nothing, none).place(probe);
    case Shape::Kind::sphere:
      return SphereSurface({shape.origin, shape.radius, false}, memory_of<SphereSurface::Memory>(state), none).place(probe);
    case Shape::Kind::point:
      return {true, shape.origin, 0, Status::ok};
    case Shape::Kind::none:
      break;
  }
  return {};
}

class WidgetLink final : public Constraint {
 public:
  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override { advance(probe, state, scratch); }
  void advance(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    const Hold hold = usable(state.shape) ? closest(state.shape, probe, state) : Hold{};
    const bool holds = hold.found && is_finite(hold.proxy);
    state.proxy = holds ? hold.proxy : probe;
    state.residual = holds ? hold.residual : 0;
    state.status = holds ? Status::ok : Status::free;
  }
  PulledBack pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch&) const noexcept override {
    const Shape& shape = state.shape;
    if (state.status != Status::ok) return {f};
    if (shape.kind == Shape::Kind::plane) return haptics::pull_back({Primitive::Kind::plane, state.proxy, shape.normal}, f);
    if (shape.kind == Shape::Kind::point) return {};
    const SideMemory none{};
    return SphereSurface({shape.origin, shape.radius, false}, memory_of<SphereSurface::Memory>(state), none).pull_back(probe, f);
  }
  /// It remembers a normal.
  bool is_sane(const LinkState&) const noexcept override { return true; }
};

}  // namespace

std::shared_ptr<const Constraint> widget_constraint() { return std::make_shared<WidgetLink>(); }

void add_widget_links(Program& program) {
  program.first_widget_link = static_cast<int>(program.links.size());
  const std::shared_ptr<const Constraint> constraint = widget_constraint();
  for (const char* name : widget::kLinkNames) {
    Link link;
    link.name = name;
    link.constraint = constraint;
    link.stiffness_n_per_m = program.coupling.stiffness_n_per_m;
    link.recipe = 1;
    program.links.push_back(std::move(link));
  }
}

}  // namespace catena::haptics
