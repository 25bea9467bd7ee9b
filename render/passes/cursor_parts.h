// SPDX-License-Identifier: MIT
/// Parts of the haptic cursor as it is drawn: what is seen of the hand, and what casts its shadow. World units. Any thread.
#pragma once
#include <vector>

#include "render/frame/frame_packet.h"

namespace catena::render {

/// Part of a drawn cursor.
struct CursorPart {
  /// Shape: a sphere at `from`; a cylinder between `from` and `to`; a cone from the center of its base to its tip; three perpendicular
  /// rings around `from`.
  enum class Kind { sphere, cylinder, cone, rings };
  Kind kind = Kind::sphere;
  Vec3 from{0.0}, to{0.0};
  double radius = 0;  ///< of the sphere, cylinder, base, rings
  Color color;
  double thickness = 0;  ///< radius of the tubes of rings
  bool casts = true;     ///< casts a shadow; false: marks that are no part of the hand
};

/// Returns the color of link i's proxy: a color-blind-safe sequence (Okabe and Ito); dimmed while the link is not active.
Color link_color(std::size_t i, bool active);

/// Returns the color of the link between a proxy and the probe for a release ratio of 0 (gray: on the feature) over amber to 1 (red: about
/// to release); distinguishable for the color-blind (Okabe and Ito).
Color release_color(double leaving);

/// Returns the parts of a cursor: the probe sphere, one sphere per proxy (larger than a tube of the fitted radius, so that it covers the
/// line it is on), cylinders probe -> p1 -> p2 .., and an arrow for the force: cursor_arrow_length() long, along F, from the probe, or from
/// the last active proxy if CursorItem::force_ratio is set. The cylinder of a link close to release gets release_color() and is thicker; a
/// released link is shown by three rings of release_color(1) around its proxy. With a foot point: a gray line of 0.15 size from the probe
/// to it, and a cross of 1.5 size to each side, perpendicular to the line. A crosshair is three bars and nothing else, apart from the line
/// to the foot point. Empty without a size or a finite probe.
std::vector<CursorPart> cursor_parts(const CursorItem& cursor);
/// Returns the length of the force arrow: 2.5 cursor radii (`size`) per newton, between 2 (so that any perceptible force is visible) and 16
/// radii; 0 without a force.
double cursor_arrow_length(double force_n, double size);

}  // namespace catena::render
