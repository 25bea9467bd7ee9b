/// What the tick tells the frame: of the force, the links and the widgets. Plain, trivially copyable.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "engine/base/sample_status.h"
#include "engine/base/vec.h"

namespace catena {

inline constexpr int kMaxWidgets = 8;  ///< Widgets of a scene.

/// One word a widget and tick.
///   cutting plane: away, explore (the probe is held on the plane), translate, rotate (on the sphere), turn (on the sphere, turning it)
///   the others:    away, hover (the probe is drawn to a handle), drag
enum class WidgetMode : std::uint8_t { idle, explore, translate, rotate, turn, hover, drag };
/// "away", "explore" and so on.
const char* to_string(WidgetMode mode);

/// Where a widget is. World units.
struct WidgetPose {
  std::array<Vec3, 2> points{Vec3(0.0), Vec3(0.0)};  ///< what they are depends on the kind: engine/widget/widget.h
  Quat orientation{kIdentityRotation};               ///< world from widget, unit
  bool operator==(const WidgetPose&) const = default;
};

/// What a tick says of a widget.
struct WidgetReport {
  WidgetPose pose;                     ///< where it is
  double value = 0;                    ///< isolevel: of the field at the handle
  std::uint32_t revision = 0;          ///< of the pose that the hand began with; Spec::revision
  WidgetMode mode = WidgetMode::idle;  ///< what it does
  std::int8_t handle = -1;         ///< rake, ruler: 0, 1 its ends, 2 the whole; box: 0..5 faces -x +x -y +y -z +z, 6 the whole; -1: none
  std::uint8_t active_planes = 0;  ///< bit i: the plane across the widget's axis i is active
};

/// How the links make one force: the proxy chain, or one of the baselines that the paper compares it with (haptics/chain/baseline.h).
enum class CouplingMethod { chain, pipe, balance, closest, linear };
/// How the links' pulls make one force: the paper's sum, or by virtual work.
enum class CouplingForce { paper, conservative };

inline constexpr int kMaxSceneLinks = 8;              ///< Links of a scene.
inline constexpr int kMaxLinks = kMaxSceneLinks + 4;  ///< And those that the widgets share.

/// One word a link and tick; the words of `NAME_status` in the tick CSV.
enum class LinkStatus : std::uint8_t { ok, free, released, budget, critical, boundary, no_surface, bad_probe };
const char* to_string(LinkStatus status);  ///< OK FREE RELEASED BUDGET CRITICAL BOUNDARY NO_SURFACE BAD_PROBE

/// How a tick came about: what the servo tells it of the device and the clock.
enum class TickCondition : std::uint8_t { normal, late, no_device, watchdog };
const char* to_string(TickCondition condition);  ///< NORMAL LATE NO_DEVICE WATCHDOG

/// What became of the force on its way to the hand.
enum class ForceState : std::uint8_t { on, off, ramping_in, held, ramping_out, stopped };
const char* to_string(ForceState state);  ///< ON OFF RAMPING_IN HELD RAMPING_OUT STOPPED

inline constexpr std::int32_t kUnknownCurve = -2;  ///< LinkReport::curve, where it was not kept

/// What a tick says of a link.
struct LinkReport {
  Vec3 proxy{0.0};                      ///< world units
  Vec3 force_n{0.0};                    ///< this link's own share, before the limit
  double residual = 0;                  ///< distance from the constraint, world units
  double weight = 0;                    ///< w_i of the force law, 0..1
  double stiffness_n_per_m = 0;         ///< k_i of this tick
  double gap = 0;                       ///< |p_i - p_(i-1)|, world units
  Quat orientation{kIdentityRotation};  ///< the link's rotational proxy
  Vec3 torque_nm{0.0};                  ///< its share of the torque
  double accounted_j = 0;               ///< given to the hand and stored for it beyond what it put in; a switch or snap shows as a jump
  double release_ratio = 0;             ///< gap by the distance at which the hand leaves the feature; 1 where it has let go
  std::int32_t evaluations = 0;         ///< field fetches of this tick
  std::int32_t curve = -1;              ///< the line that it holds to; -1: none; kUnknownCurve as it comes from a recording
  LinkStatus status = LinkStatus::ok;   ///< how the link is
  bool active = false;                  ///< enabled and not released
  bool released = false;                ///< the hand has left the feature: leaving >= 1, or let go
  SampleStatus sample_status = SampleStatus::ok;  ///< why: of CRITICAL, BOUNDARY and BAD_PROBE

  /// Stored in the link's spring, joules; the largest double for what is larger.
  double energy_j(double metres_per_unit) const {
    const double stretch_m = metres_per_unit * gap, share = 0.5 * weight * stiffness_n_per_m;
    return share > 0 ? std::min(share * stretch_m * stretch_m, std::numeric_limits<double>::max()) : 0;
  }
};

/// All that one tick says, grouped by who writes it. ImageWriteResult by the haptic thread, crosses to the frame by a TripleBuffer.
struct HapticState {
  // written by the tick
  std::uint64_t tick = 0;                           ///< counts from 1
  double t_s = 0;                                   ///< the probe's time, seconds
  Vec3 probe{0.0};                                  ///< world units
  Vec3 force_n{0.0};                                ///< on the hand, after all limits, world axes
  std::uint32_t buttons = 0;                        ///< bit n - 1: button n is held
  std::int32_t link_count = 0;                      ///< links of the program, the widgets' with them
  std::int32_t mode = -1;                           ///< the mode of operation; -1: none, all links as listed
  std::array<LinkReport, kMaxLinks> links{};        ///< the first link_count of them
  std::int32_t widget_count = 0;                    ///< widgets of the program
  std::array<WidgetReport, kMaxWidgets> widgets{};  ///< the first widget_count of them
  Quat orientation{kIdentityRotation};              ///< of the probe
  Vec3 torque_nm{0.0};                              ///< on the hand, world axes
  Vec3 coupling_force_n{0.0};  ///< what the chain asks for, before what the device allows: equal to force_n without a device
  double energy_j = 0;         ///< of the passivity observer: what the hand may still get back
  double dissipated_j = 0;     ///< what the passivity controller has taken
  double omitted_work_j = 0;   ///< of a conservative force: work that the bound of the derivatives leaves out, since the start
  TickCondition condition = TickCondition::normal;  ///< how the tick came about
  ForceState force_state = ForceState::on;          ///< what became of the force
  // written by the servo
  std::uint64_t program_epoch = 0;     ///< the newest program that the tick has run
  std::uint64_t missed_deadlines = 0;  ///< since the servo began
  double period_us = 0;                ///< since the last tick began
  double compute_us = 0;               ///< the tick alone
  double device_us = 0;                ///< reading and writing the device
};

}  // namespace catena
