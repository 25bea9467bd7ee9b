// SPDX-License-Identifier: MIT
#include "haptics/constraints/widget_link.h"

#include "haptics/constraints/shapes/surface_shapes.h"

namespace catena::haptics {
namespace {

using widget::LinkShape;

bool usable(const LinkShape& shape) noexcept {
  return shape.kind != LinkShape::Kind::none && is_finite(shape.origin) && is_finite(shape.normal) && std::isfinite(shape.radius);
}

SurfaceHold solve_closest(const LinkShape& shape, const Vec3& probe, LinkState& state) noexcept {
  const SideMemory none{};
  NoMemory nothing;
  switch (shape.kind) {
    case LinkShape::Kind::plane:
      return PlaneSurface({shape.origin, shape.normal}, nothing, none).project_probe(probe);
    case LinkShape::Kind::sphere:
      return SphereSurface({shape.origin, shape.radius, false}, memory_as<SphereSurface::Memory>(state), none).project_probe(probe);
    case LinkShape::Kind::point:
      return {true, shape.origin, 0, LinkStatus::ok};
    case LinkShape::Kind::none:
      break;
  }
  return {};
}

class WidgetLink final : public Constraint {
 public:
  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override { advance(probe, state, scratch); }
  void advance(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    const SurfaceHold hold = usable(state.shape) ? solve_closest(state.shape, probe, state) : SurfaceHold{};
    const bool holds = hold.found && is_finite(hold.proxy);
    state.proxy = holds ? hold.proxy : probe;
    state.residual = holds ? hold.residual : 0;
    state.status = holds ? LinkStatus::ok : LinkStatus::free;
  }
  PulledBackForce pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch&) const noexcept override {
    const LinkShape& shape = state.shape;
    if (state.status != LinkStatus::ok) return {f};
    if (shape.kind == LinkShape::Kind::plane) return haptics::pull_back({Primitive::Kind::plane, state.proxy, shape.normal}, f);
    if (shape.kind == LinkShape::Kind::point) return {};
    const SideMemory none{};
    return SphereSurface({shape.origin, shape.radius, false}, memory_as<SphereSurface::Memory>(state), none).pull_back(probe, f);
  }
  /// Any value of the memory, a normal, is valid.
  bool is_sane(const LinkState&) const noexcept override { return true; }
};

}  // namespace

std::shared_ptr<const Constraint> widget_constraint() { return std::make_shared<WidgetLink>(); }

void add_widget_links(HapticProgram& program) {
  program.first_widget_link = static_cast<int>(program.links.size());
  const std::shared_ptr<const Constraint> constraint = widget_constraint();
  for (const char* name : widget::kSharedLinkNames) {
    Link link;
    link.name = name;
    link.constraint = constraint;
    link.stiffness_n_per_m = program.coupling.stiffness_n_per_m;
    link.spec_hash = 1;
    program.links.push_back(std::move(link));
  }
}

}  // namespace catena::haptics
