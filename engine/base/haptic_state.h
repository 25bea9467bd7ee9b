// SPDX-License-Identifier: MIT
/// State that the haptic tick reports to the frame thread: force, links and widgets. Plain, trivially copyable data.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "engine/base/export.h"
#include "engine/base/sample_status.h"
#include "engine/base/vec.h"

namespace catena {

inline constexpr int kMaxWidgets = 8;  ///< maximum number of widgets of a scene; more are an error

/// Mode of a widget in a tick. A cutting plane uses idle to turn; the other widgets use idle, hover and drag.
enum class WidgetMode : std::uint8_t {
  idle,       ///< the probe is away from the widget
  explore,    ///< the probe is constrained to the cutting plane
  translate,  ///< the probe moves the plane
  rotate,     ///< the probe is on the sphere of the cutting plane
  turn,       ///< the probe is on the sphere and turns it
  hover,      ///< the probe is attracted to a handle
  drag        ///< the probe moves the widget by a handle
};
/// Returns the name of a mode: "away" (idle), "explore", "translate" and so on.
CATENA_EXPORT const char* to_string(WidgetMode mode);

/// Pose of a widget, world units.
struct WidgetPose {
  /// control points; their meaning depends on the kind of widget: engine/widget/widget.h
  std::array<Vec3, 2> points{Vec3(0.0), Vec3(0.0)};
  Quat orientation{kIdentityRotation};  ///< rotation from widget axes to world axes, unit
  bool operator==(const WidgetPose&) const = default;
};

/// State of one widget after a tick.
struct WidgetReport {
  WidgetPose pose;                     ///< current pose
  double value = 0;                    ///< isolevel widget: value of the field at the handle
  std::uint32_t revision = 0;          ///< revision (Spec::revision) of the pose from which the interaction with the probe started
  WidgetMode mode = WidgetMode::idle;  ///< current mode
  /// Active handle. Rake and ruler: 0, 1 an end, 2 the whole widget; box: 0..5 the faces -x +x -y +y -z +z, 6 the whole box;
  /// cutting plane: 0 the arrow; -1: none.
  std::int8_t handle = -1;
  std::uint8_t active_planes = 0;  ///< bit i: the plane across axis i of the widget is active
};

/// Method that combines the links into one force: the proxy chain, or one of the baselines of the paper (haptics/chain/baseline.h).
enum class CouplingMethod {
  chain,    ///< proxy chain, one proxy per link
  pipe,     ///< one proxy: the constraints are applied in turn until all are satisfied
  balance,  ///< one proxy that balances the springs to the probe and to the links' linear primitives
  closest,  ///< one proxy: the nearest of the constraints' own projections of the probe
  linear    ///< one proxy that moves with the probe as far as the linear primitives leave it free
};
/// Rule that combines the contributions of the links into one force.
enum class CouplingForce {
  paper,        ///< sum as in the paper
  conservative  ///< negative gradient of the chain's energy, by virtual work (haptics/chain/virtual_work.h)
};

inline constexpr int kMaxSceneLinks = 8;  ///< maximum number of links of a scene
/// maximum number of links of a program: those of the scene and four that the widgets share
inline constexpr int kMaxLinks = kMaxSceneLinks + 4;

/// State of a link in a tick, written to the column `NAME_status` of the tick CSV.
enum class LinkStatus : std::uint8_t {
  ok,          ///< the constraint holds
  free,        ///< not in contact: the probe is on the free side or out of reach
  released,    ///< the probe has left the feature
  budget,      ///< the evaluations of this tick are used up; the search continues in the next tick
  critical,    ///< at a critical point, or the constraint is undefined there (LinkReport::sample_status)
  boundary,    ///< at the boundary of the domain
  no_surface,  ///< no surface was found
  bad_probe,   ///< the position of the probe is not finite
  coarse       ///< as ok, but of a coarser level of the data: the bricks at the proxy are not in memory yet. Only in a LinkReport
};
/// Returns OK FREE RELEASED BUDGET CRITICAL BOUNDARY NO_SURFACE BAD_PROBE COARSE.
CATENA_EXPORT const char* to_string(LinkStatus status);

/// Condition under which a tick ran, set by the servo from the clock and the device.
enum class TickCondition : std::uint8_t {
  normal,     ///< on time, with the device
  late,       ///< after its deadline
  no_device,  ///< the device does not deliver positions
  watchdog    ///< the watchdog has stopped the device
};
/// Returns NORMAL LATE NO_DEVICE WATCHDOG.
CATENA_EXPORT const char* to_string(TickCondition condition);

/// State of the force limiter (haptics/chain/force_limiter.h).
enum class ForceState : std::uint8_t {
  on,           ///< commanded force, within the limits
  off,          ///< switched off: no force
  ramping_in,   ///< rising to the commanded force
  held,         ///< late tick: the preceding force is repeated
  ramping_out,  ///< falling to zero
  stopped       ///< zero because of a fault
};
/// Returns ON OFF RAMPING_IN HELD RAMPING_OUT STOPPED.
CATENA_EXPORT const char* to_string(ForceState state);

inline constexpr std::int32_t kUnknownCurve = -2;  ///< value of LinkReport::curve when it was not recorded

/// State of one link after a tick.
struct LinkReport {
  Vec3 proxy{0.0};                      ///< position of the link's proxy, world units
  Vec3 force_n{0.0};                    ///< contribution of this link before the force limits, newtons
  double residual = 0;                  ///< distance of the proxy from the constraint, world units
  double weight = 0;                    ///< weight w_i of the force law, 0..1
  double stiffness_n_per_m = 0;         ///< stiffness k_i in this tick
  double gap = 0;                       ///< distance |p_i - p_(i-1)| to the preceding proxy, world units
  Quat orientation{kIdentityRotation};  ///< rotational proxy of the link
  Vec3 torque_nm{0.0};                  ///< contribution of this link to the torque
  /// Accounted energy: joules that the link has given to the user and has stored, minus what the user put in. It jumps at a switch or a
  /// snap.
  double accounted_j = 0;
  double release_ratio = 0;      ///< gap divided by the distance at which the probe leaves the feature; 1 when the link is released
  std::int32_t evaluations = 0;  ///< field evaluations in this tick
  std::int32_t curve = -1;  ///< index of the curve to which the link is constrained; -1: none; kUnknownCurve when read from a recording
  LinkStatus status = LinkStatus::ok;             ///< state of the link
  bool active = false;                            ///< enabled and not released
  bool released = false;                          ///< the probe has left the feature: release_ratio >= 1, or the link is released
  SampleStatus sample_status = SampleStatus::ok;  ///< cause of CRITICAL, BOUNDARY or BAD_PROBE

  /// Returns the energy stored in the link's spring, joules; values that overflow become the largest double.
  double energy_j(double metres_per_unit) const {
    const double stretch_m = metres_per_unit * gap, share = 0.5 * weight * stiffness_n_per_m;
    return share > 0 ? std::min(share * stretch_m * stretch_m, std::numeric_limits<double>::max()) : 0;
  }
};

/// Complete result of one tick, grouped by the component that writes it. Written by the haptic thread; passed to the frame thread in a
/// TripleBuffer.
struct HapticState {
  // written by the tick
  std::uint64_t tick = 0;                           ///< tick number, counted from 1
  double t_s = 0;                                   ///< time of the probe sample, seconds
  Vec3 probe{0.0};                                  ///< position of the probe, world units
  Vec3 force_n{0.0};                                ///< force on the user after all limits, world axes
  std::uint32_t buttons = 0;                        ///< bit n - 1: button n is pressed
  std::int32_t link_count = 0;                      ///< number of links of the program, those of the widgets included
  std::int32_t mode = -1;                           ///< index of the mode of operation; -1: none, all links in their order
  std::array<LinkReport, kMaxLinks> links{};        ///< the first link_count entries are used
  std::int32_t widget_count = 0;                    ///< number of widgets of the program
  std::array<WidgetReport, kMaxWidgets> widgets{};  ///< the first widget_count entries are used
  Quat orientation{kIdentityRotation};              ///< orientation of the probe
  Vec3 torque_nm{0.0};                              ///< torque on the user after all limits, N m, world axes
  /// Force commanded by the chain before the limits of the device; equal to force_n without a device.
  Vec3 coupling_force_n{0.0};
  double energy_j = 0;      ///< energy of the passivity observer that the user may still get back, joules
  double dissipated_j = 0;  ///< energy dissipated by the passivity controller since the start, joules
  /// Conservative force: energy since the start that the force does not account for, because derivatives are bounded or a proxy jumps,
  /// joules.
  double omitted_work_j = 0;
  TickCondition condition = TickCondition::normal;  ///< condition under which the tick ran
  ForceState force_state = ForceState::on;          ///< state of the force limiter
  // written by the servo
  std::uint64_t program_epoch = 0;     ///< epoch of the newest program that the tick has run
  std::uint64_t brick_snapshot = 0;    ///< number of the snapshot of bricks of the tick; 0: none (haptics/servo/brick_pager.h)
  std::uint64_t missed_deadlines = 0;  ///< number of deadlines missed since the servo started
  double period_us = 0;                ///< time since the start of the preceding tick
  double compute_us = 0;               ///< duration of the tick alone
  double device_us = 0;                ///< duration of reading and writing the device
};

}  // namespace catena
