#include "haptics/chain/widgets.h"

namespace catena::haptics {

namespace {

std::size_t count_of(const Program& program) noexcept {
  return std::min(program.widgets.size(), static_cast<std::size_t>(widget::kMaxWidgets));
}

// The links of the scene that a ruler's end keeps to, as far as they are switched on.
void add_along(const widget::Spec& spec, const Program& program, const SwitchState& switches, Order& order) noexcept {
  for (const int link : spec.along) {
    const auto i = static_cast<std::size_t>(link);
    if (link >= 0 && i < program.scene_links() && switches.link_on[i] && !order.contains(i)) order.add(i);
  }
}

}  // namespace

Order engage_widgets(const Program& program, const WidgetsInput& input, const Order& scene, const SwitchState& switches,
                     std::array<LinkState, kMaxLinks>& links, WidgetsState& state) noexcept {
  const std::size_t count = count_of(program);
  if (!state.started) state.probe = input.probe;
  state.engaged = static_cast<std::int8_t>(widget::step_modes({program.widgets.data(), count}, {state.widgets.data(), count},
                                                              {input.probe, state.probe, input.buttons, state.buttons, state.gone}));
  state.probe = input.probe;
  state.buttons = input.buttons;
  state.started = true;
  state.gone = false;
  if (state.engaged < 0) return scene;

  const auto w = static_cast<std::size_t>(state.engaged);
  const widget::Plan plan = widget::plan(program.widgets[w], state.widgets[w], input.probe);
  Order order = scene;
  if (plan.alone) order.count = 0, order.links = {}, order.takes = {};
  if (plan.along) add_along(program.widgets[w], program, switches, order);
  for (int k = 0; k < plan.count; ++k) {
    const auto slot = static_cast<std::size_t>(plan.slots[static_cast<std::size_t>(k)]);
    const std::size_t i = program.scene_links() + slot;
    if (!(links[i].shape == plan.shapes[slot])) {
      links[i].shape = plan.shapes[slot];
      links[i].started = false;
      ++state.takes[slot];
    }
    order.add(i, state.takes[slot]);
  }
  return order;
}

void move_widgets(const Program& program, const Vec3& last_proxy, WidgetsState& state) noexcept {
  if (state.engaged < 0) return;
  const auto w = static_cast<std::size_t>(state.engaged);
  widget::finish(program.widgets[w], state.widgets[w], last_proxy);
}

void lose_probe(WidgetsState& state) noexcept { state.gone = state.started; }

void report_widgets(const Program& program, const WidgetsState& state, exchange::HapticState& out) noexcept {
  const std::size_t count = count_of(program);
  out.widget_count = static_cast<std::int32_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    widget::State begun;
    if (!state.widgets[i].known) widget::begin(program.widgets[i], begun);
    out.widgets[i] = widget::report_of(state.widgets[i].known ? state.widgets[i] : begun);
  }
}

void rebind_widgets(const Program& from, const Program& to, WidgetsState& state) noexcept {
  const WidgetsState old = state;
  state.widgets = {};
  state.engaged = -1;
  for (std::size_t i = 0; i < count_of(to); ++i)
    for (std::size_t k = 0; k < count_of(from); ++k)
      if (from.widget_names[k] == to.widget_names[i] && from.widgets[k].kind == to.widgets[i].kind &&
          to.widgets[i].revision <= old.widgets[k].revision)
        state.widgets[i] = old.widgets[k];
}

}  // namespace catena::haptics
