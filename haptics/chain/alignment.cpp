#include "haptics/chain/alignment.h"

namespace catena::haptics {

namespace {

// It constrains: not on the free side, not released, and something is there.
bool holds(const LinkState& link) noexcept {
  return link.active() &&
         (link.status == Status::ok || link.status == Status::budget || link.status == Status::critical || link.status == Status::boundary);
}

// The axis of the link's primitive at its proxy; zero: none here.
Vec3 axis_of(const Link& spec, LinkState& link, LinkScratch& scratch, const Vec3& last) noexcept {
  if (!holds(link)) return Vec3(0.0);
  if (link.evaluations >= kEvaluationCap) return last;
  LinkState copy = link;
  Primitive primitive;
  const bool found = spec.constraint->primitive(link.proxy, copy, scratch, primitive);
  link.evaluations = copy.evaluations;
  return found && primitive.kind != Primitive::Kind::point ? primitive.axis : Vec3(0.0);
}

// The smallest rotation of the tool that brings its axis onto n.
Quat turn_onto(const Align& align, const Quat& tool, const Vec3& n) noexcept {
  const Vec3 axis = direction(rotate(tool, align.tool_axis));
  const bool turned = align.sign == Align::Sign::either && dot(axis, n) < 0;
  return shortest_arc(axis, turned ? -n : n);
}

}  // namespace

Vec3 align_links(const Program& program, const Order& order, const Quat& tool, const AlignmentStep& step, std::span<LinkState> links,
                 std::span<LinkScratch> scratch, AlignmentState& state, exchange::HapticState& out) noexcept {
  bool aligns = false;
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    out.links[i].orientation = tool;
    out.links[i].torque_nm = Vec3(0.0);
    aligns = aligns || program.links[i].align.on;
  }
  const double damping = program.coupling.rotational_damping_nms_per_rad;
  const bool fades = state.fade.left > 0 || (state.engaged && state.fade.replaced);
  if (!aligns && !fades && !(damping > 0)) {
    state.engaged = false;
    state.last = tool;
    return Vec3(0.0);
  }

  // each rotational proxy is the next link's orientation
  Quat incoming = tool;
  Vec3 torque(0.0);
  std::array<Vec3, kMaxLinks> shares{};
  for (int k = 0; k < order.count && aligns; ++k) {
    const int link = order.links[static_cast<std::size_t>(k)];
    const auto i = static_cast<std::size_t>(link);
    const Align& align = program.links[i].align;
    if (align.on) {
      state.axes[i] = axis_of(program.links[i], links[i], scratch[i], state.axes[i]);
      if (max_abs(state.axes[i]) > 0) {
        const Quat before = normalised(incoming), turn = turn_onto(align, before, state.axes[i]);
        const double kappa = std::fmin(align.stiffness_nm_per_rad, program.limits.max_rotational_stiffness_nm_per_rad);
        shares[i] = rotation_vector(turn) * (links[i].weight * kappa);
        torque += shares[i];
        incoming = normalised(turn * before);
      }
    }
    out.links[i].orientation = incoming;
    out.links[i].torque_nm = shares[i];
  }

  // a link that is off passes on what comes before it
  Quat before = tool;
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    if (!order.contains(i)) out.links[i].orientation = before;
    if (order.mode < 0) before = out.links[i].orientation;
  }

  // what a switch took away fades
  if (step.first_tick || !state.engaged) {
    state.fade.order = order;
    if (step.first_tick) {
      state.fade.shares = shares;
      state.fade.replaced = false;
    } else {
      state.fade.shares = {};
    }
  }
  if (!step.first_tick) torque += step_fade(state.fade, order, shares, step.ramp_step);
  state.engaged = aligns;

  // the coupling's damping
  const Quat q0 = normalised(tool);
  if (!step.first_tick && step.dt_s > 0 && damping > 0)
    torque -= rotation_vector(normalised(q0 * glm::conjugate(normalised(state.last)))) * (damping / step.dt_s);
  state.last = q0;
  return torque;
}

}  // namespace catena::haptics
