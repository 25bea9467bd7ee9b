// SPDX-License-Identifier: MIT
#include "render/extract/axis_edges.h"

#include <cmath>

#include "render/frame/camera.h"

namespace catena::render {
namespace {

constexpr double kEdgeOnTolerance = 1e-9;  // a face closer to edge-on than this counts as turned away; by the diagonal in perspective
constexpr double kTieBreakWeight = 0.01;   // weight of the second coordinate in the score; breaks ties

/// Coordinates in the image, right and up; finite for points behind the camera, too.
struct ScreenPoint {
  double x, y;
};

ScreenPoint seen_at(const Camera& camera, const Vec3& p) {
  const Vec3 away = camera.orthographic ? p : direction(p - camera.position);
  return {dot(away, camera.right), dot(away, camera.up)};
}

/// Returns whether the face of minimum (side 0) or maximum (side 1) coordinate is turned to the camera.
bool faces_eye(const Bounds& box, const Camera& camera, int axis, int side) {
  if (camera.orthographic) return side == 1 ? camera.back[axis] > kEdgeOnTolerance : camera.back[axis] < -kEdgeOnTolerance;
  const double slack = kEdgeOnTolerance * box.diagonal();
  return side == 1 ? camera.position[axis] > box.hi[axis] + slack : camera.position[axis] < box.lo[axis] - slack;
}

/// Returns the distance in the image from the edge's line to the point one step along `out` from its middle.
double leads_away(const Camera& camera, const AxisEdge& edge, const Vec3& out, double step) {
  const Vec3 middle = 0.5 * (edge.from + edge.to);
  const ScreenPoint a = seen_at(camera, edge.from), b = seen_at(camera, edge.to), m = seen_at(camera, middle),
                    o = seen_at(camera, middle + step * out);
  const double x = b.x - a.x, y = b.y - a.y, length = std::hypot(x, y), aside_x = o.x - m.x, aside_y = o.y - m.y;
  return length > 0 ? std::fabs(aside_x * y - aside_y * x) / length : std::hypot(aside_x, aside_y);
}

AxisEdge edge_of(const Bounds& box, const Camera& camera, int axis, bool upright) {
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  AxisEdge best;
  bool best_outlines = false;
  double best_score = HUGE_VAL;
  for (int corner = 0; corner < 4; ++corner) {
    const int side_b = corner & 1, side_c = corner >> 1;
    AxisEdge edge{box.lo, box.lo, Vec3(0.0)};
    if (side_b == 1) edge.from[b] = edge.to[b] = box.hi[b];
    if (side_c == 1) edge.from[c] = edge.to[c] = box.hi[c];
    edge.to[axis] = box.hi[axis];
    const bool outlines = faces_eye(box, camera, b, side_b) != faces_eye(box, camera, c, side_c);
    const ScreenPoint at = seen_at(camera, 0.5 * (edge.from + edge.to));
    const double score = upright ? at.x + kTieBreakWeight * at.y : at.y + kTieBreakWeight * at.x;
    if (outlines < best_outlines || (outlines == best_outlines && score >= best_score)) continue;
    Vec3 out_b(0.0), out_c(0.0);
    out_b[b] = 2 * side_b - 1;
    out_c[c] = 2 * side_c - 1;
    const double step = 0.01 * box.diagonal();
    edge.outward = leads_away(camera, edge, out_b, step) > leads_away(camera, edge, out_c, step) ? out_b : out_c;
    best = edge;
    best_outlines = outlines;
    best_score = score;
  }
  return best;
}

}  // namespace

std::array<AxisEdge, 3> find_axis_edges(const Bounds& box, const View& view) {
  const Camera camera = make_camera(view, 1, 1, Bounds());
  int upright = 2;
  for (const int axis : {1, 0})
    if (std::fabs(view.up[axis]) > std::fabs(view.up[upright])) upright = axis;
  std::array<AxisEdge, 3> edges;
  for (int axis = 0; axis < 3; ++axis) edges[std::size_t(axis)] = edge_of(box, camera, axis, axis == upright);
  return edges;
}

}  // namespace catena::render
