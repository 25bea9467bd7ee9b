/// What the haptic thread runs: an immutable list of links with the coupling. Built by haptics/extract off the tick, handed
/// over by pointer, freed by the frame side after a returned epoch shows that no tick can name it any more.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptics/chain/constraint.h"

namespace catena::haptics {

/// "on": {"button": n} (n = 1 is bit 0) or {"force_above": newtons}; neither: always on.
struct Switch {
  int button = 0;            ///< 0: none
  double force_above_n = 0;  ///< 0: none
};

struct Link {
  std::string name;
  std::shared_ptr<const Constraint> constraint;
  double stiffness_n_per_m = 500;
  Switch on;
};

struct Coupling {
  double stiffness_n_per_m = 500;
  double damping_ns_per_m = 0;
  double max_force_n = 8;
  double ramp_s = 0;
};

struct Program {
  std::uint64_t epoch = 0;
  std::vector<Link> links;  ///< at most kMaxLinks
  Coupling coupling;
  double metres_per_unit = 1;    ///< S: metres of hand a world unit
  Vec3 workspace_origin{0.0};    ///< world position of the device's origin
  Mat3 workspace_rotation{1.0};  ///< world from device axes
};

}  // namespace catena::haptics
