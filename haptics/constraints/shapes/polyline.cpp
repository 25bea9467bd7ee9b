#include "haptics/constraints/shapes/shapes.h"

#include <fmt/format.h>

#include "haptics/constraints/shapes/closed_form.h"
#include "haptics/constraints/shapes/polyline_search.h"

namespace catena::haptics {
namespace {

constexpr int kFirstVisits = 1024;
constexpr int kVisits = 128;
constexpr int kPieces = 4096, kPiecesAStep = 2, kVisitWork = 3;
constexpr double kLeastExtent = 1e-300, kMaxExtent = 1e300;

struct PolylineShape {
  std::vector<Straight> pieces;
  bool closed = false;
  PolylineSearch tree;
};

class PolylineSurface final : public Surface {
 public:
  using Shape = PolylineShape;
  struct Memory {
    SearchState search;
    std::uint32_t piece;
    std::int32_t end;  // of the piece: -1, 1, or 0 between
  };
  PolylineSurface(const Shape& shape, Memory& memory, const SideMemory&) : shape_(shape), memory_(memory) {}

  static bool is_sane(const Shape& shape, const Memory& m) noexcept {
    const std::size_t pieces = shape.pieces.size();
    return shape.tree.is_sane(m.search) && m.search.best < pieces && m.piece < pieces && m.end >= -1 && m.end <= 1;
  }
  SideValue side(const Vec3&) noexcept override { return {}; }

  Hold place(const Vec3& probe) noexcept override {
    SearchState& search = memory_.search;
    shape_.tree.search(shape_.pieces, probe, search.any ? kVisits : kFirstVisits, search);
    work_ += kVisitWork * search.visits;
    return hold(search.best, probe, search.open ? Status::budget : Status::ok);
  }

  Hold slide(const Vec3& probe) noexcept override {
    if (memory_.search.open) return place(probe);
    std::uint32_t k = memory_.piece;
    int way = memory_.end == 0 ? 0 : leave_corner(k, probe);
    for (int visited = 0; visited < kPieces; ++visited, work_ += visited % kPiecesAStep) {
      const int end = shape_.pieces[k].end_of(shape_.pieces[k].along(probe));
      if (way == 0) way = end;
      if (end == 0 || end != way) return hold(k, probe, Status::ok);
      const std::uint32_t next = neighbour(k, way);
      if (next == k) return hold(k, probe, Status::ok);
      k = next;
    }
    return hold_end(k, -way);
  }

  Hold cross(const Vec3&, const Vec3&) noexcept override { return {}; }

  Hold near_by(const Vec3& probe, double limit) noexcept override {
    const Hold found = place(probe);
    if (!(norm(probe - found.proxy) <= limit)) return {};
    memory_.search.open = false;
    return {true, found.proxy, found.residual, Status::ok};
  }

  int work() const noexcept { return work_; }
  Vec3 normal() const noexcept override { return Vec3(0.0); }
  double domain_length() const noexcept override { return std::max(kSceneLength, shape_.tree.extent()); }

  bool primitive(const Vec3& at, Primitive& out) noexcept {
    memory_.search.open = false;
    const Hold held = slide(at);
    if (memory_.end != 0)
      out = {Primitive::Kind::point, held.proxy, Vec3(0.0)};
    else
      out = {Primitive::Kind::line, held.proxy, shape_.pieces[memory_.piece].d};
    return true;
  }

 private:
  /// The piece after (way 1) or before (-1) piece k; k itself at an open end.
  std::uint32_t neighbour(std::uint32_t k, int way) const {
    const auto last = static_cast<std::uint32_t>(shape_.pieces.size() - 1);
    if (way > 0) return k < last ? k + 1 : shape_.closed ? 0 : k;
    return k > 0 ? k - 1 : shape_.closed ? last : k;
  }

  /// From a corner both ways may lead nearer: the steeper one; at a tie onwards. Sets k to the piece on that side.
  int leave_corner(std::uint32_t& k, const Vec3& probe) const {
    const std::uint32_t other = neighbour(k, memory_.end);
    if (other == k) return 0;
    const std::uint32_t before = memory_.end > 0 ? k : other, after = memory_.end > 0 ? other : k;
    const Straight &down = shape_.pieces[before], &up = shape_.pieces[after];
    const Vec3 e = probe - up.a;
    k = dot(e, up.d) >= -dot(e, down.d) ? after : before;
    return k == after ? 1 : -1;
  }

  Hold hold(std::uint32_t k, const Vec3& probe, Status status) noexcept {
    const Straight& piece = shape_.pieces[k];
    const double s = piece.along(probe);
    memory_.piece = k;
    memory_.end = piece.end_of(s);
    const Vec3 proxy = piece.at(s);
    return {true, proxy, memory_.end != 0 ? 0 : piece.off_axis(proxy), status};
  }
  Hold hold_end(std::uint32_t k, int end) noexcept {
    memory_.piece = k;
    memory_.end = end;
    return {true, end < 0 ? shape_.pieces[k].a : shape_.pieces[k].b, 0, Status::budget};
  }

  const Shape& shape_;
  Memory& memory_;
  int work_ = 0;
};

/// Consecutive equal points are one.
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
  const std::size_t least = closed ? 3 : 2;
  if (points.size() < least)
    return json::error_at(*node, fmt::format("\"points\" holds {} different point{} in a row; at least {} were expected{}", points.size(),
                                             points.size() == 1 ? "" : "s", least, closed ? " of a closed polyline" : ""));
  CATENA_TRY(const SideSpec rules, read_side_rules(link, false, context));

  PolylineShape shape;
  shape.closed = closed;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) shape.pieces.emplace_back(points[i], points[i + 1]);
  if (closed) shape.pieces.emplace_back(points.back(), points.front());
  shape.tree = PolylineSearch(shape.pieces);
  const double extent = shape.tree.extent();
  if (!(extent >= kLeastExtent && extent <= kMaxExtent))
    return json::error_at(*node,
                          fmt::format("\"points\" spans {}; an extent from {} to {} was expected", extent, kLeastExtent, kMaxExtent));
  return make_closed_form<PolylineSurface>(std::move(shape), rules);
}

}  // namespace

ConstraintType polyline_constraint() {
  return {"polyline",
          "Holds the proxy on a polyline.",
          "section 3",
          {schema::places("points", "world", "Its corners in order.").items(2, 0).required(),
           schema::boolean("closed", "The last point joins the first; three points or more.").by_default("false")},
          build_polyline,
          true};
}

}  // namespace catena::haptics
