// SPDX-License-Identifier: MIT
/// Haptic program: immutable list of the links and the coupling that the haptic thread runs. Built by haptics/build off the tick, passed by
/// pointer to the haptic thread, and freed by the frame thread when a published epoch shows that no later tick can use it.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/haptic_state.h"
#include "haptics/chain/constraint.h"
#include "haptics/chain/parameter.h"

namespace catena::haptics {

/// Switch of a link or a mode ("active_when" in the scene): {"button": n} (n = 1 is bit 0), with "toggle" each press inverts it; or
/// {"force_above": newtons}, which stays on until the force is at most "force_below" (default: the same). Neither: always on. The force is
/// the magnitude of the last tick's chain force.
struct ActivationSwitch {
  bool disabled = false;     ///< off, whatever the other fields say ("enabled": false)
  int button = 0;            ///< button number, from 1; 0: none
  bool toggle = false;       ///< each press of the button inverts the switch
  double force_above_n = 0;  ///< force above which the switch goes on, newtons; 0: not used
  double force_below_n = 0;  ///< force at or below which it goes off, newtons
};

/// Release cue ("release_cue" in the scene): how the user perceives that the probe leaves the link's feature, besides the report of every
/// link (paper, section 2).
///   m = |p_i - p_(i-1)| / distance, 1 if the link is released: release ratio
///   The probe has left the feature from m >= 1 (minus round-off) until m < 0.95.
///   detent: a pulse of `amplitude_n` toward the feature when the probe leaves it and when it returns, which falls linearly to zero
///   over `duration_s`
///   vibration: a triangle wave of `amplitude_n` and `frequency_hz` along the gap while m >= `onset` and the link is not released
/// Both are multiplied by w_i.
struct ReleaseCue {
  /// Kind of cue; none: the report only.
  enum class Type { none, detent, vibration };
  Type type = Type::none;     ///< kind of cue
  double distance = 0;        ///< gap at which m is 1, world units; 0: LinkState::limit, where the link slips or releases
  double onset = 0.8;         ///< vibration: m at which it starts
  double amplitude_n = 0.5;   ///< amplitude, newtons
  double frequency_hz = 150;  ///< vibration: frequency
  double duration_s = 0.02;   ///< detent: duration
};

/// Alignment ("align" in the scene): turns the tool's axis onto the link's axis, the normal of a surface or the tangent of a curve
/// (alignment.h).
struct Align {
  /// Significance of the direction of the link's axis; either: the axis and its opposite are equivalent.
  enum class Sign { either, same };
  bool enabled = false;               ///< the link aligns the tool
  Vec3 tool_axis{0.0, 0.0, 1.0};      ///< axis a_i of the tool, unit, tool frame
  double stiffness_nm_per_rad = 0.5;  ///< rotational stiffness kappa_i
  Sign sign = Sign::either;           ///< whether the direction of the link's axis matters
};

/// Link of the chain. Immutable.
struct Link {
  std::string name;                              ///< unique in the program
  std::shared_ptr<const Constraint> constraint;  ///< constraint that moves the link's proxy
  Parameter stiffness_n_per_m = 500;             ///< k_i; may follow a field
  ActivationSwitch active_when;                  ///< switch of the link
  ReleaseCue release_cue;                        ///< cue when the probe leaves the feature
  Align align;                                   ///< alignment of the tool
  double release = 0;                            ///< baselines only: releases where |probe - proxy| >= release, world units; 0: never
  bool one_sided = false;                        ///< the constraint has a free side; used by the baselines and in messages for the user
  std::string feature_name;                      ///< display name of the feature, such as "Precentral_L"; empty: use `name`
  /// Hash of the specification that the link was built from: links with equal name and hash keep their state when the program changes. 0:
  /// links with the same constraint object do.
  std::uint64_t spec_hash = 0;
};

/// Mode of operation (paper, section 6.2): while its switch is on, these links run in this order and all others are off.
struct Mode {
  std::string name;              ///< unique in the program
  std::vector<int> links;        ///< indices into HapticProgram::links
  ActivationSwitch active_when;  ///< switch of the mode
};

/// Coupling between the probe and the links, which determines the force; the force law is in tick.h.
struct Coupling {
  /// Stiffness K of a baseline, and the stiffness that build_link() gives to a link without its own; the chain uses each link's.
  double stiffness_n_per_m = 500;
  double damping_ns_per_m = 0;                    ///< damping b of the probe, meters of probe travel
  double max_force_n = 8;                         ///< maximum of the whole chain force
  double ramp_s = 0;                              ///< time over which a step of max_force_n is ramped (ramp.h); 0: no ramp
  double rotational_stiffness_nm_per_rad = 0.5;   ///< kappa_i of aligning links without their own
  double rotational_damping_nms_per_rad = 0;      ///< rotational damping b_r
  CouplingMethod method = CouplingMethod::chain;  ///< chain or baseline
  CouplingForce force = CouplingForce::paper;     ///< force law of the chain
};

/// Everything that a tick needs besides its input and state. Built off the tick by build_program(), immutable, read by the haptic thread.
struct HapticProgram {
  std::uint64_t epoch = 0;  ///< unique and increasing among the programs of a servo
  std::vector<Link> links;  ///< at most kMaxLinks
  /// Index of the first of the widgets' links x, y, z, sphere, which are the last four of `links`; -1: no widgets.
  int first_widget_link = -1;
  std::vector<widget::Spec> widgets;      ///< at most kMaxWidgets
  std::vector<std::string> widget_names;  ///< in the order of `widgets`
  std::vector<Mode> modes;       ///< at most kMaxModes; the first whose switch is on sets the link order; none on: all links as listed
  Coupling coupling;             ///< coupling of probe and links
  DeviceLimits limits;           ///< limits of the device; without a device all are off
  double meters_per_unit = 1;    ///< scale S: meters of probe travel per world unit
  Vec3 workspace_origin{0.0};    ///< position of the device's origin, world units
  Mat3 workspace_rotation{1.0};  ///< rotation from device axes to world axes
  /// Grids that the links sample and of which only some bricks are in memory (bricks.h); each once.
  std::vector<std::shared_ptr<const field::PagedGrid>> paged_grids;

  /// Returns the number of links of the scene, without those of the widgets.
  std::size_t scene_link_count() const { return first_widget_link < 0 ? links.size() : static_cast<std::size_t>(first_widget_link); }
};

inline constexpr int kMaxModes = 8;  ///< maximum number of modes of a scene

}  // namespace catena::haptics
