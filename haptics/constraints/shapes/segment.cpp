// SPDX-License-Identifier: MIT
#include "haptics/constraints/shapes/shapes.h"

#include "haptics/constraints/shapes/closed_form.h"

namespace catena::haptics {
namespace {

struct SegmentShape {
  LineSegment piece;

  SurfaceHold closest(const Vec3& probe) const noexcept {
    const double s = piece.along(probe);
    const Vec3 proxy = piece.at(s);
    return {true, proxy, piece.end_of(s) != 0 ? 0 : piece.distance_from_line(proxy), LinkStatus::ok};
  }
  Primitive primitive(const Vec3& at) const noexcept {
    const double s = piece.along(at);
    if (piece.end_of(s) != 0) return {Primitive::Kind::point, piece.at(s), Vec3(0.0)};
    return {Primitive::Kind::line, piece.at(s), piece.d};
  }
  double length() const noexcept { return std::max(kDefaultDomainLength, piece.length); }
};

Result<std::shared_ptr<const Constraint>> build_segment(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(const Vec3 from, json::require_vec3(link, "from"));
  CATENA_TRY(const Vec3 to, json::require_vec3(link, "to"));
  const LineSegment piece(from, to);
  if (from == to) return json::error_at(*link.find("to"), "\"to\" is the same point as \"from\"; another point was expected");
  if (!piece.usable()) return json::error_at(*link.find("to"), "\"to\" is too far from \"from\"; a distance below 1e308 was expected");
  CATENA_TRY(const SideSpec rules, read_side_rules(link, false, context));
  return make_closed_form<FeatureSurface<SegmentShape>>({piece}, rules);
}

}  // namespace

ConstraintType segment_constraint() {
  return {"segment",
          "Holds the proxy on a line segment.",
          "section 3",
          {schema::vec3("from", "world", "First end of the segment.").required(),
           schema::vec3("to", "world", "Second end of the segment, different from `from`.").with_initial_value("hand + 0.1 L").required()},
          build_segment,
          true};
}

}  // namespace catena::haptics
