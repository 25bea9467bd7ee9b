// SPDX-License-Identifier: MIT
#include "haptics/constraints/shapes/shapes.h"

#include <fmt/format.h>

#include "haptics/constraints/shapes/polyline_bvh.h"
#include "haptics/constraints/shapes/polyline_tracking.h"

namespace catena::haptics {
namespace {

constexpr double kMinExtent = 1e-300, kMaxExtent = 1e300;

struct PolylineShape {
  static constexpr int kFirstVisits = 1024, kVisits = 128, kVisitWork = 3, kMaxPieces = 4096;
  /// Returns the work units for the n-th segment visited by a walk: two segments cost one.
  static constexpr int walk_work(int n) { return n % 2; }

  std::vector<LineSegment> pieces;
  bool closed = false;
  PolylineBvh tree;

  bool has(std::uint32_t k) const { return k < pieces.size(); }
  const LineSegment& piece(std::uint32_t k) const { return pieces[k]; }
  std::uint32_t neighbour(std::uint32_t k, int step_sign) const {
    const auto last = static_cast<std::uint32_t>(pieces.size() - 1);
    if (step_sign > 0) return k < last ? k + 1 : closed ? 0 : k;
    return k > 0 ? k - 1 : closed ? last : k;
  }
  void search(const Vec3& probe, int max_visits, SearchState& state) const noexcept { tree.search(pieces, probe, max_visits, state); }
  bool is_sane(const SearchState& state) const noexcept { return tree.is_sane(state); }
  double extent() const noexcept { return tree.extent(); }
};

/// Merges consecutive equal points.
std::vector<Vec3> merged(const std::vector<std::vector<double>>& rows, bool closed) {
  std::vector<Vec3> points;
  for (const auto& row : rows) {
    const Vec3 p(row[0], row[1], row[2]);
    if (points.empty() || p != points.back()) points.push_back(p);
  }
  while (closed && points.size() > 1 && points.back() == points.front()) points.pop_back();
  return points;
}

Result<std::shared_ptr<const Constraint>> build_polyline(const json::Node& link, const BuildContext& context) {
  const json::Node* node = link.find("points");
  if (node == nullptr) return json::error_at(link, "key \"points\" is missing; an array of at least two points [x, y, z] was expected");
  CATENA_TRY(const auto rows, json::as_rows(*node, "points", 3));
  CATENA_TRY(const bool closed, json::get_boolean(link, "closed", false));
  const std::vector<Vec3> points = merged(rows, closed);
  const std::size_t minimum = closed ? 3 : 2;
  if (points.size() < minimum)
    return json::error_at(*node, fmt::format("\"points\" holds {} different point{} in a row; at least {} were expected{}", points.size(),
                                             points.size() == 1 ? "" : "s", minimum, closed ? " of a closed polyline" : ""));
  CATENA_TRY(const SideSpec rules, read_side_rules(link, false, context));

  PolylineShape shape;
  shape.closed = closed;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) shape.pieces.emplace_back(points[i], points[i + 1]);
  if (closed) shape.pieces.emplace_back(points.back(), points.front());
  shape.tree = PolylineBvh(shape.pieces);
  const double extent = shape.tree.extent();
  if (!(extent >= kMinExtent && extent <= kMaxExtent))
    return json::error_at(*node, fmt::format("\"points\" spans {}; an extent from {} to {} was expected", extent, kMinExtent, kMaxExtent));
  return make_closed_form<PolylineTracker<PolylineShape>>(std::move(shape), rules);
}

}  // namespace

ConstraintType polyline_constraint() {
  return {"polyline",
          "Holds the proxy on a polyline.",
          "section 3",
          {schema::points("points", "world", "Vertices of the polyline, in order.").with_size(2, 0).required(),
           schema::boolean("closed", "Connects the last vertex to the first; at least three vertices are required.").with_default("false")},
          build_polyline,
          true};
}

}  // namespace catena::haptics
