// SPDX-License-Identifier: MIT
#include "haptics/chain/alignment.h"

namespace catena::haptics {

namespace {

constexpr double kPastSquare = 0.17364817766693033;  // sin(10 degrees): beyond this angle past the perpendicular the tool aligns with the
                                                     // other end of an unsigned axis
constexpr double kQuarterTurn = 1.5707963267948966;  // radians; maximum angle to an unsigned axis

// Returns whether the link constrains the proxy: active, not on its free side, not released, and a feature exists.
bool holds(const LinkState& link) noexcept {
  return link.active() && (link.status == LinkStatus::ok || link.status == LinkStatus::budget || link.status == LinkStatus::critical ||
                           link.status == LinkStatus::boundary);
}

// Returns the axis of the link's primitive at its proxy; zero if there is none; `last` if the link is out of budget.
Vec3 axis_of(const Link& spec, LinkState& link, LinkScratch& scratch, const Vec3& last) noexcept {
  if (!holds(link)) return Vec3(0.0);
  if (link.evaluations >= kMaxEvaluations) return last;
  LinkState copy = link;
  Primitive primitive;
  const bool found = spec.constraint->primitive(link.proxy, copy, scratch, primitive);
  link.evaluations = copy.evaluations;
  return found && primitive.kind != Primitive::Kind::point ? primitive.axis : Vec3(0.0);
}

// Returns the direction, +n or -n, with which the tool is aligned: initially the nearer one, afterwards that of the last tick until the
// tool is kPastSquare past the perpendicular.
Vec3 end_of(const Align& align, const Vec3& tool_axis, const Vec3& n, const Vec3& last) noexcept {
  if (align.sign == Align::Sign::same) return n;
  if (!(max_abs(last) > 0)) return dot(tool_axis, n) < 0 ? -n : n;
  const Vec3 same = dot(n, last) < 0 ? -n : n;
  return dot(tool_axis, same) < -kPastSquare ? -same : same;
}

}  // namespace

Vec3 align_links(const HapticProgram& program, const LinkOrder& order, const Quat& tool, const AlignmentStep& step,
                 std::span<LinkState> links, std::span<LinkScratch> scratch, AlignmentState& state, HapticState& out) noexcept {
  bool aligns = false;
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    out.links[i].orientation = tool;
    out.links[i].torque_nm = Vec3(0.0);
    aligns = aligns || program.links[i].align.enabled;
  }
  const double damping = program.coupling.rotational_damping_nms_per_rad;
  if (!aligns && !(max_abs(state.ramp.offset) > 0 || max_abs(state.ramp.last_force) > 0) && !(damping > 0)) {
    state.last_orientation = tool;
    return Vec3(0.0);
  }

  // each rotational proxy is the input orientation of the next link
  Quat incoming = tool;
  Vec3 torque(0.0);
  double stiffness = 0;
  std::array<Vec3, kMaxLinks> shares{};
  for (int k = 0; k < order.count && aligns; ++k) {
    const int link = order.links[static_cast<std::size_t>(k)];
    const auto i = static_cast<std::size_t>(link);
    const Align& align = program.links[i].align;
    if (align.enabled) {
      const Vec3 n = axis_of(program.links[i], links[i], scratch[i], state.axes[i]);
      const double kappa = std::fmin(align.stiffness_nm_per_rad, program.limits.max_rotational_stiffness_nm_per_rad);
      stiffness += kappa;
      if (max_abs(n) > 0) {
        const Quat before = normalized(incoming);
        const Vec3 axis = direction(rotate(before, align.tool_axis));
        state.axes[i] = end_of(align, axis, n, state.axes[i]);
        const Quat turn = shortest_arc(axis, state.axes[i]);
        shares[i] = rotation_vector(turn) * (links[i].weight * kappa);
        torque += shares[i];
        incoming = normalized(turn * before);
      } else {
        state.axes[i] = Vec3(0.0);
      }
    }
    out.links[i].orientation = incoming;
    out.links[i].torque_nm = shares[i];
  }

  // a link that is switched off reports the orientation of the previous link (of the tool if a mode orders the chain)
  Quat before = tool;
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    if (!order.contains(i)) out.links[i].orientation = before;
    if (order.mode < 0) before = out.links[i].orientation;
  }

  // ramps a step of the torque
  const Quat q0 = normalized(tool);
  const Vec3 turned = step.first_tick ? Vec3(0.0) : rotation_vector(normalized(q0 * glm::conjugate(normalized(state.last_orientation))));
  if (step.first_tick) state.ramp.last_force = torque;
  state.total_stiffness =
      max_abs(state.ramp.offset) > 0 || max_abs(state.ramp.last_force) > 0 ? std::fmax(stiffness, state.total_stiffness) : stiffness;
  const double fall = step.ramp_step < 1 ? state.total_stiffness * kQuarterTurn * step.ramp_step : std::numeric_limits<double>::infinity();
  torque += step_ramp(state.ramp, torque, stiffness * norm(turned), fall);

  // adds the coupling's damping
  if (step.dt_s > 0 && damping > 0) torque -= turned * (damping / step.dt_s);
  state.last_orientation = q0;
  return torque;
}

}  // namespace catena::haptics
