// SPDX-License-Identifier: MIT
#include "haptics/constraints/mesh/god_object.h"

#include "haptics/constraints/mesh/mesh_walk.h"

namespace catena::haptics {
namespace {

constexpr double kAtRest = 1e-14;              // a shorter move counts as none
constexpr double kSlack = 2e-14;               // tolerance of a face's outline; closes the seams between faces
constexpr double kBehind = 4 * kGodObjectGap;  // distance behind a face up to which it still holds: tolerates round-off
// tolerance in height and outline within which a face is touched; shorter moves leave no face
constexpr double kTouching = 8 * kGodObjectGap;
constexpr double kSlip = 1e-9;  // minimum move past a vertex
constexpr double kAtVertex = 64 * kGodObjectGap;
constexpr std::size_t kMaxFan = 12;  // maximum number of faces tried at a vertex
constexpr double kReach = 31;        // maximum travel in a tick; the mesh has size 1

class Mover {
 public:
  Mover(const mesh::TriangleMesh& mesh, double outside, int nodes, GodObject& god)
      : mesh_(mesh), outside_(outside), god_(god), nodes_(nodes) {}
  int nodes_left() const noexcept { return nodes_; }

  GodObjectMove run(const Vec3& x) noexcept {
    if (!enter_box(x)) return {true, true};
    const Vec3 way = x - god_.p;
    const bool far = max_abs(way) > kReach;
    const Vec3 target = far ? god_.p + way * (kReach / max_abs(way)) : x;
    const Vec3 start = god_.p;
    drop_left();
    for (int move = 0; move < kMaxGodObjectMoves; ++move) {
      const PlaneSolution to = planes().closest(target);
      if (!to.found) return done(true);
      note(to);
      const Vec3 step = to.q - god_.p;
      if (max_abs(step) <= kAtRest) {
        if (to.count == 0) return {true, true};
        if (slip_past(to, target)) continue;
        return done(true);
      }
      const Hit hit = sweep(to.q);
      god_.p = hit.part >= 1 ? to.q : god_.p + hit.part * step;
      const bool moved = hit.part * max_abs(step) > kTouching;
      if (hit.face != kNone) {
        if (moved) drop_left();
        touch(hit.face);
        continue;
      }
      if (hit.part < 1) return done(false);
      if (to.count == 0) {
        god_.p = x;
        god_.count = god_.binding = 0;
        return {true, true};
      }
      if (all_touch() || !moved) {
        if (slip_past(to, target)) continue;
        return done(true);
      }
      drop_left();
    }
    return done(max_abs(god_.p - start) <= kAtRest);
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Hit {
    double part = 1;
    std::uint32_t face = kNone;
  };

  /// At a vertex where several faces bind, some of them may end (a saddle), so that the path can be free over a face or an edge of the
  /// vertex's fan. The sweep detects obstacles on that path.
  bool slip_past(const PlaneSolution& at, const Vec3& target) noexcept {
    if (at.count < 2) return false;
    const std::uint32_t face = god_.faces[static_cast<std::size_t>(at.binding[0])];
    int corner = -1;
    for (int k = 0; k < 3; ++k)
      if (max_abs(mesh_.corner(face, k) - god_.p) <= kAtVertex) corner = k;
    if (corner < 0) return false;
    const auto fan = mesh_.faces_around(mesh_.triangles()[face][static_cast<std::size_t>(corner)]);
    const std::size_t count = std::min<std::size_t>(fan.size(), kMaxFan);
    const GodObject before = god_;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i; j < count; ++j) {
        god_.faces[0] = fan[i];
        god_.faces[1] = fan[j];
        god_.count = i == j ? 1 : 2;
        if (i != j && !share_edge(fan[i], fan[j])) continue;
        const PlaneSolution to = planes().closest(target);
        const Vec3 step = to.q - god_.p;
        const bool nearer = to.found && dot(to.q - target, to.q - target) < dot(god_.p - target, god_.p - target);
        const Hit hit = nearer ? sweep(to.q) : Hit{0, kNone};
        if (hit.part * max_abs(step) > kSlip) {
          god_.p += hit.part * step;
          drop_left();
          if (hit.face != kNone) touch(hit.face);
          return true;
        }
      }
    god_ = before;
    return false;
  }
  bool share_edge(std::uint32_t f, std::uint32_t g) const {
    return mesh_.adjacent_face(f, 0) == g || mesh_.adjacent_face(f, 1) == g || mesh_.adjacent_face(f, 2) == g;
  }

  double height(std::uint32_t f, const Vec3& p) const { return outside_ * mesh_.face(f).signed_distance(p); }
  GodObjectMove done(bool complete) const { return {false, complete}; }

  /// Moves a distant p to the point where the path to x enters the box around the mesh. Returns false, with p at x, if it does not enter.
  bool enter_box(const Vec3& x) noexcept {
    if (max_abs(god_.p) <= 1) return true;
    double in = 0, out = 1;
    for (int i = 0; i < 3; ++i) {
      const double from = god_.p[i], d = x[i] - from;
      if (d == 0) {
        if (std::fabs(from) > 1) out = -1;
        continue;
      }
      const double a = (-1 - from) / d, b = (1 - from) / d;
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    god_.count = god_.binding = 0;
    if (in > out) {
      god_.p = x;
      return false;
    }
    god_.p += in * (x - god_.p);
    return true;
  }

  bool touches(std::uint32_t f) const { return std::fabs(height(f, god_.p)) <= kTouching && mesh_.face(f).covers(god_.p, kTouching); }
  bool all_touch() const {
    for (int i = 0; i < god_.count; ++i)
      if (!touches(god_.faces[static_cast<std::size_t>(i)])) return false;
    return true;
  }
  /// Drops the faces that p has left. Faces met since the last real move are kept, because all of them count around a corner.
  void drop_left() noexcept {
    int kept = 0;
    for (int i = 0; i < god_.count; ++i) {
      const std::uint32_t f = god_.faces[static_cast<std::size_t>(i)];
      if (touches(f)) {
        god_.faces[static_cast<std::size_t>(kept++)] = f;
      } else {
        left_ = f;
      }
    }
    god_.count = kept;
  }
  void touch(std::uint32_t face) noexcept {
    if (god_.count == GodObject::kMaxFaces) {
      int highest = 0;
      for (int i = 1; i < god_.count; ++i)
        if (height(god_.faces[static_cast<std::size_t>(i)], god_.p) > height(god_.faces[static_cast<std::size_t>(highest)], god_.p))
          highest = i;
      god_.faces[static_cast<std::size_t>(highest)] = god_.faces[static_cast<std::size_t>(--god_.count)];
    }
    god_.faces[static_cast<std::size_t>(god_.count++)] = face;
  }
  PlaneConstraints planes() const noexcept {
    PlaneConstraints out;
    for (int i = 0; i < god_.count; ++i) {
      const mesh::Face& face = mesh_.face(god_.faces[static_cast<std::size_t>(i)]);
      out.add(outside_ * face.normal, outside_ * face.offset + kGodObjectGap);
    }
    return out;
  }
  void note(const PlaneSolution& to) noexcept {
    god_.binding = to.count;
    for (int i = 0; i < to.count; ++i)
      god_.normals[static_cast<std::size_t>(i)] =
          outside_ * mesh_.face(god_.faces[static_cast<std::size_t>(to.binding[static_cast<std::size_t>(i)])]).normal;
  }

  /// Returns whether the face lies wholly behind a touched face: a point in front of that face never meets it. So convex edges do not stop
  /// the slide.
  bool is_covered(std::uint32_t f) const noexcept {
    for (int i = 0; i < god_.count; ++i) {
      const std::uint32_t a = god_.faces[static_cast<std::size_t>(i)];
      if (a == f) return true;
      if (height(a, mesh_.corner(f, 0)) <= 0.25 * kGodObjectGap && height(a, mesh_.corner(f, 1)) <= 0.25 * kGodObjectGap &&
          height(a, mesh_.corner(f, 2)) <= 0.25 * kGodObjectGap)
        return true;
    }
    return false;
  }

  /// Returns the first face on the path to q that is met from its outer side; if the nodes run out, a shorter path (part < 1, no face).
  Hit sweep(const Vec3& q) noexcept {
    double reach = 1;
    for (int attempt = 0; attempt < 3; ++attempt) {
      Hit hit;
      if (sweep_part(god_.p + reach * (q - god_.p), hit)) {
        hit.part *= reach;
        return hit;
      }
      reach *= 1.0 / 64;
    }
    return {0, kNone};
  }

  bool sweep_part(const Vec3& q, Hit& hit) noexcept {
    const Vec3 from = god_.p;
    Vec3 to = q;
    const auto meet = [&](std::uint32_t f) {
      const double h0 = height(f, from), h1 = height(f, q);
      if (!(h1 < 0 && h1 < h0 && h0 >= -kBehind)) return;
      const double part = h0 <= kGodObjectGap ? 0 : (h0 - kGodObjectGap) / (h0 - h1);
      if (part > hit.part || (part == hit.part && f > hit.face)) return;
      const double crossing = h0 <= 0 ? 0 : h0 / (h0 - h1);
      const Vec3 at = from + crossing * (q - from);
      if (!mesh_.face(f).covers(at, kSlack) || is_covered(f)) return;
      hit = {part, f};
      to = at;
    };
    // the neighbors of the face just left are likely the next ones: they are tested first, to shorten the path
    for (int k = 0; left_ != kNone && k < 3; ++k) meet(mesh_.adjacent_face(left_, k));
    int nodes = nodes_ / 2;
    nodes_ -= nodes;
    const bool complete = mesh_.bvh().visit_segment(from, to, kBehind, nodes, meet);
    nodes_ += std::max(nodes, 0);
    return complete;
  }

  const mesh::TriangleMesh& mesh_;
  double outside_;
  GodObject& god_;
  std::uint32_t left_ = kNone;  ///< the face that the god-object slid off last
  int nodes_;
};

}  // namespace

GodObjectMove move_god_object(const mesh::TriangleMesh& mesh, double outside, const Vec3& x, int nodes, GodObject& god) noexcept {
  Mover mover(mesh, outside, nodes, god);
  GodObjectMove move = mover.run(x);
  move.nodes = nodes - mover.nodes_left();
  return move;
}

}  // namespace catena::haptics
