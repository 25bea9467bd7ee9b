/// What the haptic thread runs: an immutable list of links with the coupling. Built by haptics/build off the tick, handed
/// over by pointer, freed by the frame side after a returned epoch shows that no tick can name it any more.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/haptic_state.h"
#include "haptics/chain/constraint.h"
#include "haptics/chain/parameter.h"

namespace catena::haptics {

/// "on": {"button": n} (n = 1 is bit 0), with "toggle": each press turns it over; or {"force_above": newtons}, until the force
/// is at most "force_below" (default: the same). Neither: always on. The force is the last tick's.
struct ActivationSwitch {
  bool disabled = false;     ///< off whatever else it says ("enabled": false)
  int button = 0;            ///< 0: none
  bool toggle = false;       ///< each press turns it over
  double force_above_n = 0;  ///< 0: none
  double force_below_n = 0;  ///< it goes off at or below this
};

/// "indicate": how the hand is told that it leaves the link's feature, beside the report of every link (paper, section 2).
///   m = |p_i - p_(i-1)| / at, 1 where the link has let go;  left: from m >= 1 (but for round-off) until m < 0.95
///   detent: a pulse of `amplitude` towards the feature when the link is left and when it is back, linear to zero over `duration`
///   vibration: a triangle wave of `amplitude` and `frequency` along the gap while m >= from
/// Both times w_i.
struct ReleaseCue {
  /// How it is told.
  enum class Type { none, detent, vibration };
  Type type = Type::none;     ///< none: by the report alone
  double distance = 0;        ///< world units; 0: where the link slips or lets go
  double onset = 0.8;         ///< vibration: from this m on
  double amplitude_n = 0.5;   ///< newtons
  double frequency_hz = 150;  ///< of the vibration
  double duration_s = 0.02;   ///< of a detent
};

/// "align": turns the tool's axis onto the link's: a surface's normal, a curve's tangent (alignment.h).
struct Align {
  /// Whether the axis has a direction.
  enum class Sign { either, same };
  bool enabled = false;               ///< the link has "align"
  Vec3 tool_axis{0.0, 0.0, 1.0};      ///< unit, tool frame
  double stiffness_nm_per_rad = 0.5;  ///< kappa_i
  Sign sign = Sign::either;           ///< either: an axis has no sense of direction
};

/// One link of the chain. Immutable.
struct Link {
  std::string name;                              ///< unique in the program
  std::shared_ptr<const Constraint> constraint;  ///< what keeps its proxy
  Parameter stiffness_n_per_m = 500;             ///< k_i; may follow a field
  ActivationSwitch active_when;                  ///< its switch
  ReleaseCue release_cue;                        ///< its cue
  Align align;                                   ///< whether it turns the tool
  double release = 0;                            ///< baselines only: lets go where |probe - proxy| >= release, world units; 0: never
  bool one_sided = false;                        ///< it has a free side; it is told here for the baselines and for what a person reads
  std::string feature_name;     ///< the name of what it lies on, for a person: "Precentral_L"; empty: the link's own says it
  std::uint64_t spec_hash = 0;  ///< what it was built from: links of the same name and recipe keep their state; 0: of the same object
};

/// A mode of operation (section 6.2): while its switch is on, these links run, in this order; the others are off.
struct Mode {
  std::string name;              ///< unique in the program
  std::vector<int> links;        ///< indices into HapticProgram::links
  ActivationSwitch active_when;  ///< its switch
};

/// How the links make one force; the law stands in tick.h.
struct Coupling {
  double stiffness_n_per_m = 500;                 ///< what build_link() gives a link that does not say; the tick reads the link's own
  double damping_ns_per_m = 0;                    ///< b, of the hand
  double max_force_n = 8;                         ///< of the whole force
  double ramp_s = 0;                              ///< seconds in which a step of max_force is ramped (ramp.h); 0: at once
  double rotational_stiffness_nm_per_rad = 0.5;   ///< of links that align and do not say
  double rotational_damping_nms_per_rad = 0;      ///< b_r
  CouplingMethod method = CouplingMethod::chain;  ///< the chain, or a baseline
  CouplingForce force = CouplingForce::paper;     ///< of the chain
};

/// All that a tick needs to know. Made off the tick (build_program()), immutable, read by the haptic thread.
struct HapticProgram {
  std::uint64_t epoch = 0;                ///< unique and rising among the programs of a servo
  std::vector<Link> links;                ///< at most kMaxLinks
  int first_widget_link = -1;             ///< the widgets' links x, y, z, sphere: the last four of `links`; -1: no widgets
  std::vector<widget::Spec> widgets;      ///< at most kMaxWidgets
  std::vector<std::string> widget_names;  ///< in the order of `widgets`
  std::vector<Mode> modes;                ///< at most kMaxModes; the first whose switch is on orders the chain; none: all links as listed
  Coupling coupling;                      ///< how the links make a force
  DeviceLimits limits;                    ///< what the device allows; all off without one
  double meters_per_unit = 1;             ///< S: metres of hand a world unit
  Vec3 workspace_origin{0.0};             ///< world position of the device's origin
  Mat3 workspace_rotation{1.0};           ///< world from device axes

  /// Links of the scene, without the widgets'.
  std::size_t scene_link_count() const { return first_widget_link < 0 ? links.size() : static_cast<std::size_t>(first_widget_link); }
};

inline constexpr int kMaxModes = 8;  ///< Modes of a scene.

}  // namespace catena::haptics
