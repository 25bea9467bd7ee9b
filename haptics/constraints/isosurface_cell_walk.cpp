#include "haptics/constraints/isosurface_cell_walk.h"

namespace catena::haptics {
namespace {

constexpr double kRelease = 1e-8;     // of L: a smaller tangential descent is none
constexpr double kConverged = 1e-10;  // of L: within a piece
constexpr double kStill = 1e-13;      // of L: a shorter move is none
constexpr double kAccepted = 1e-6;    // of L: what may remain where no piece moves any more
constexpr double kFaceSlack = 1e-12;  // voxels: closer to a face than this is on it
constexpr double kNearFace = 1e-10;   // voxels: a step out that cannot be shortened into the cell starts on the face
constexpr int kWalkRounds = 600;
constexpr double kFarAway = 2;        // voxels
constexpr double kLeastSlope = 0.87;  // of the last point's: less is a fold
constexpr double kFlat = 0.25;        // voxels: so far off the level a straight way may end
constexpr int kHalvings = 24;         // to find where a way passes its limit
constexpr double kSmoothTurn = 0.95;  // cosine: a larger turn of the normal from step to step is no smooth surface

bool is_flat(const field::Box& box, int a) { return !(box.hi[a] > box.lo[a]); }

/// The cells fetched in this tick: each is counted once.
class Cells {
 public:
  Cells(LevelField& field, int most) : field_(field), grid_(*field.grid()), last_(field.evaluations() + most) {}

  /// nullptr: a wall, of which `wall` then says the kind, or the budget is spent.
  const field::ScalarCell* find(const field::Index3& base) {
    ++field_.steps();
    const field::Box& box = grid_.index_box();
    const std::array<std::int32_t, 3> at{base.x, base.y, base.z};
    for (int a = 0; a < 3; ++a) {
      const double last = is_flat(box, a) ? box.lo[a] : box.hi[a] - 1;
      const double b = at[static_cast<std::size_t>(a)];
      if (b < box.lo[a] || b > last) {
        wall = Reason::box;
        return nullptr;
      }
    }
    for (std::size_t i = 1; i <= kCells && i <= count_; ++i) {
      const std::size_t k = (count_ - i) % kCells;
      if (keys_[k].base == base) return usable(k);
    }
    if (field_.spent() || field_.evaluations() >= last_) {
      spent_ = true;
      return nullptr;
    }
    field_.count_fetch();
    const std::size_t k = count_++ % kCells;
    field::ScalarCell& cell = *new (slot(k)) field::ScalarCell(grid_.cell(base, field_.cursor()));
    cell.base = base;
    bool finite = true;
    for (const double c : cell.corner) finite = finite && std::isfinite(c);
    keys_[k] = {base, !cell.valid ? Reason::mask : finite ? Reason::none : Reason::not_finite};
    return usable(k);
  }
  bool spent() const { return spent_; }
  Reason wall = Reason::none;

 private:
  struct Key {
    field::Index3 base;
    Reason wall;  ///< none: a cell to walk in
  };
  const field::ScalarCell* usable(std::size_t k) {
    if (keys_[k].wall == Reason::none) return slot(k);
    wall = keys_[k].wall;
    return nullptr;
  }
  LevelField& field_;
  const field::ScalarGrid& grid_;
  int last_;
  // raw bytes: most ticks need one cell, and clearing 32 would cost as much as the walk
  static constexpr std::size_t kCells = 32;
  field::ScalarCell* slot(std::size_t k) {
    return std::launder(reinterpret_cast<field::ScalarCell*>(&bytes_[k * sizeof(field::ScalarCell)]));
  }
  alignas(field::ScalarCell) std::array<std::byte, kCells * sizeof(field::ScalarCell)> bytes_;
  std::array<Key, kCells> keys_;  // NOLINT: set as cells come
  std::size_t count_ = 0;
  bool spent_ = false;
};

/// The faces through a point: which axes, and the cells on either side of them.
struct Corner {
  unsigned flat = 0, faces = 0;  // bit masks of axes
  CellPoint at;

  Corner(const field::Box& box, const CellPoint& point) : at(point) {
    for (int a = 0; a < 3; ++a) {
      if (is_flat(box, a))
        flat |= 1u << a;
      else if (at.f[a] == 0 || at.f[a] == 1)
        faces |= 1u << a;
    }
  }
  /// Bit a of `upper`: the cell that has the point on its lower face a (f = 0).
  CellPoint seen_from(unsigned upper) const {
    CellPoint out = at;
    std::array<std::int32_t*, 3> base{&out.base.x, &out.base.y, &out.base.z};
    for (int a = 0; a < 3; ++a) {
      if (!(faces >> a & 1u)) continue;
      const bool is_upper = out.f[a] == 0, wanted = (upper >> a & 1u) != 0;
      if (is_upper == wanted) continue;
      *base[static_cast<std::size_t>(a)] += wanted ? 1 : -1;
      out.f[a] = wanted ? 0 : 1;
    }
    return out;
  }
  unsigned upper() const {
    unsigned bits = 0;
    for (int a = 0; a < 3; ++a)
      if ((faces >> a & 1u) && at.f[a] == 0) bits |= 1u << a;
    return bits;
  }
};

/// The empty set first, then every subset of `mask`, rising.
template <class Visit>
void for_subsets(unsigned mask, const Visit& visit) {
  unsigned subset = 0;
  do {
    visit(subset);
    subset = (subset - mask) & mask;
  } while (subset != 0);
}

enum class Followed { converged, landed, blocked };

/// Moves f within one piece towards the closest point, until it converges or meets a face of the cell. `s` and `t` are the sample
/// and the tangential part at f, on the way in, and on the way out where it converged. Steepest: by t, not by Newton's step, which
/// on a folded piece may lead out of the cell where t leads in.
Followed follow(const LevelField& field, const Piece& piece, const Vec3& probe, bool steepest, Vec3& f, PieceSample& s, Vec3& t) {
  const field::Mapping& mapping = field.grid()->mapping();
  const double length = field.length(), voxel = field.voxel();
  const auto gain = [&](const Vec3& from, const Vec3& to) {
    const Vec3 dp = mapping.world_from_index_linear * (to - from);
    return dot(dp, probe - piece.world(from)) - 0.5 * dot(dp, dp);
  };
  for (int i = 0; i < 40 && !field.exhausted(); ++i) {
    if (!s.usable) return Followed::blocked;
    const double size = norm(t);
    if (size <= std::max(kConverged * length, 1e-15 * norm(probe - piece.world(f)))) return Followed::converged;
    Vec3 u = steepest ? t : piece.newton(f, probe, s, t);
    const double wanted = norm(u);
    if (wanted > 2 * voxel) u = u * (2 * voxel / wanted);

    bool accepted = false;
    for (int trial = 0; trial < 30 && !accepted && !field.exhausted(); ++trial, u = u * 0.35) {
      Vec3 g;
      int axis;
      if (!piece.retract(f, u, s, g)) continue;
      if (piece.outside(g, axis) <= 0) {
        const double won = gain(f, g);
        accepted = won >= 1e-4 * dot(t, u);
        if (!accepted && size <= 1e-5 * length) {
          const PieceSample next = piece.sample(g);
          accepted = next.usable && norm(piece.tangential(g, probe, next)) <= 0.5 * size;
        }
        if (accepted) f = g;
        continue;
      }

      // an inner end of the bracket: the first halving that stays in the cell
      double low = 0, high = 1, v_low = 0, v_high = piece.outside(g, axis);
      Vec3 outer = g, within = f;
      bool inner = false;
      const bool hurried = field.hurried();
      const double first = hurried ? std::min(0.5, piece.part_inside(f, u)) : 0.5;
      for (double alpha = first; alpha > 1e-14 && !field.exhausted(); alpha *= 0.5) {
        if (!piece.retract(f, u * alpha, s, g)) continue;  // a fold: nearer by there is none
        int worst;
        const double v = piece.outside(g, worst);
        if (v <= 0) {
          low = alpha;
          v_low = v;
          within = g;
          inner = true;
          break;
        }
        high = alpha;
        v_high = v;
        axis = worst;
        outer = g;
      }
      if (!inner) {
        // a rounding away from a face, but not on it
        for (int a = axis, k = 0; k < 3; ++k, a = (a + 1) % 3) {
          const double face = f[a] < 0.5 ? 0.0 : 1.0;
          if (piece.frame().held[static_cast<std::size_t>(a)] || f[a] == face || std::fabs(f[a] - face) > kNearFace) continue;
          f[a] = face;
          return Followed::landed;
        }
        return Followed::blocked;
      }

      // land on the face: false position on how far the point is outside, to the last bit; where time is short by Illinois' rule (an
      // end is halved only where it stays twice), which needs a quarter of the steps
      double a = v_low, b = v_high;
      int stays = 0;
      double along = 0;
      for (int k = 0; k < 80 && high - low > 1e-16 * high && v_high > 1e-15 && !(hurried && v_low > -kFaceSlack) && !field.exhausted();
           ++k) {
        double w = k % 4 == 3 || !(a < 0) ? 0.5 : a / (a - b);
        if (!(w > 0 && w < 1)) w = 0.5;
        const double mid = low + (high - low) * w;
        if (!(mid > low && mid < high) || !piece.retract(f, u * mid, s, g, along)) break;
        if (!hurried) along = 0;
        const double v = piece.outside(g, axis);
        const bool replaces_low = v <= 0;
        const double other = hurried && stays != (replaces_low ? 1 : -1) ? 1 : 0.5;
        stays = replaces_low ? 1 : -1;
        if (replaces_low)
          low = mid, within = g, a = v_low = v, b *= other;
        else
          high = mid, b = v_high = v, outer = g, a *= other;
      }
      if (hurried && v_low > -kFaceSlack) outer = within, v_high = 0;
      if (v_high > 1e-9) {
        // a fold between: as far as the cell's level goes
        accepted = gain(f, within) >= 1e-4 * low * dot(t, u);
        if (accepted) f = within;
        continue;
      }
      piece.outside(outer, axis);
      for (int k = 0; k < 3; ++k) outer[k] = std::min(std::max(outer[k], 0.0), 1.0);
      outer[axis] = outer[axis] < 0.5 ? 0.0 : 1.0;
      if (!(gain(f, outer) > 0)) continue;
      f = outer;
      return Followed::landed;
    }
    if (!accepted) return size <= kRelease * length ? Followed::converged : Followed::blocked;
    s = piece.sample(f);
    t = piece.tangential(f, probe, s);
  }
  return Followed::converged;
}

/// Far from the probe, straight along t to the face where it leaves the cell, and on that face back to the level. False: the level
/// bends too much for that, or the way is no way down.
bool cross_cell(const LevelField& field, const PieceFrames& frames, const Piece& piece, const field::ScalarCell& cell, unsigned held,
                const Vec3& probe, const PieceSample& s, const Vec3& t, Vec3& f) {
  const field::Mapping& mapping = field.grid()->mapping();
  const Vec3 d = piece.frame().index_step(mapping, t);
  int axis = -1;
  double part = 1;
  for (int a = 0; a < 3; ++a) {
    const double way = d[a] > 0 ? (1 - f[a]) / d[a] : d[a] < 0 ? -f[a] / d[a] : 2;
    if (way < part) part = way, axis = a;
  }
  if (axis < 0) return false;
  Vec3 exit = f + d * part;
  for (int a = 0; a < 3; ++a) exit[a] = std::min(std::max(exit[a], 0.0), 1.0);
  exit[axis] = d[axis] > 0 ? 1 : 0;

  const Piece face(mapping, cell, field.level(), frames.of[held | 1u << axis], field.steps());
  const PieceSample there = face.sample(exit);
  Vec3 g;
  int worst;
  if (!there.usable || there.slope < kLeastSlope * s.slope || std::fabs(there.distance) > kFlat * field.voxel()) return false;
  if (!face.retract(exit, Vec3(0.0), there, g) || face.outside(g, worst) > 0) return false;
  const Vec3 dp = mapping.world_from_index_linear * (g - f);
  if (!(dot(dp, probe - piece.world(f)) - 0.5 * dot(dp, dp) > 0)) return false;
  f = g;
  return true;
}

/// The last point of the way from..to over one piece that keeps within `limit` and is no further from the probe than `from`.
Vec3 cut_short(const LevelField& field, const Piece& piece, const Vec3& probe, const TravelLimit& limit, const PieceSample& s,
               const Vec3& from, const Vec3& to) {
  const Vec3 chord = field.grid()->mapping().world_from_index_linear * (to - from), along = chord - s.n * dot(s.n, chord);
  const double most = norm(probe - piece.world(from));
  Vec3 kept = from, g;
  double low = 0, high = 1;
  for (int i = 0; i < kHalvings && !field.exhausted(); ++i) {
    const double mid = 0.5 * (low + high);
    int axis;
    const bool fits = piece.retract(from, along * mid, s, g) && piece.outside(g, axis) <= 0 && !limit.passed_by(piece.world(g)) &&
                      norm(probe - piece.world(g)) <= most;
    (fits ? low : high) = mid;
    if (fits) kept = g;
  }
  return kept;
}

}  // namespace

CellPoint cell_point(const field::ScalarGrid& grid, const Vec3& world) noexcept {
  const Vec3 index = grid.mapping().index_from_world(world);
  CellPoint out;
  out.base = grid.base_of(index);
  const Vec3 base(out.base.x, out.base.y, out.base.z);
  for (int a = 0; a < 3; ++a) out.f[a] = is_flat(grid.index_box(), a) ? 0 : std::min(std::max(index[a] - base[a], 0.0), 1.0);
  for (int a = 0; a < 3; ++a) {
    if (out.f[a] < kFaceSlack) out.f[a] = 0;
    if (out.f[a] > 1 - kFaceSlack) out.f[a] = 1;
  }
  return out;
}

Vec3 world_of(const field::ScalarGrid& grid, const CellPoint& at) noexcept {
  return grid.mapping().world_from_index({at.base.x + at.f.x, at.base.y + at.f.y, at.base.z + at.f.z});
}

WalkResult walk_cells(LevelField& field, const PieceFrames& frames, const Vec3& probe, int most, CellPoint& at,
                      TravelLimit* limit) noexcept {
  const field::ScalarGrid& grid = *field.grid();
  const field::Mapping& mapping = grid.mapping();
  const double length = field.length();
  Cells cells(field, most);
  WalkResult result;
  std::uint64_t exhausted = 0;
  bool steepest = false;
  Reason wall = Reason::none;
  double remaining = 0;
  Vec3 last_normal(0.0);
  const auto turn_to = [&](const Vec3& n) {
    if (max_abs(last_normal) > 0 && dot(n, last_normal) < kSmoothTurn) result.smooth = false;
    last_normal = n;
  };

  for (int round = 0; round < kWalkRounds; ++round) {
    // every piece that meets the point: the steepest feasible descent
    const Corner corner(grid.index_box(), at);
    const unsigned own = corner.upper();
    struct {
      double size;
      unsigned upper, held;
      const field::ScalarCell* cell;
      PieceSample s;
      Vec3 t;
    } best{kRelease * length, 0, 0, nullptr, {}, Vec3(0.0)};
    bool usable = false, pulled = false, found = false;
    remaining = 0;
    for_subsets(corner.faces, [&](unsigned flip) {
      const unsigned upper = own ^ flip;
      const CellPoint here = corner.seen_from(upper);
      const field::ScalarCell* cell = cells.find(here.base);
      if (!cell) return;
      found = true;
      for_subsets(corner.faces, [&](unsigned held) {
        const Piece piece(mapping, *cell, field.level(), frames.of[held | corner.flat], field.steps());
        const PieceSample s = piece.sample(here.f);
        if (!s.usable) return;
        if (!usable || (flip == 0 && held == 0)) {
          result.residual = std::fabs(s.distance);
          result.normal = s.n;
        }
        usable = true;
        const Vec3 t = piece.tangential(here.f, probe, s);
        const double size = norm(t);
        if (!(size > kRelease * length)) return;
        const Vec3 d = piece.frame().index_step(mapping, t);
        bool feasible = true;
        for (int a = 0; a < 3; ++a) {
          if (!(corner.faces >> a & 1u) || (held >> a & 1u)) continue;
          if (here.f[a] == 0 ? d[a] >= 0 : d[a] <= 0) continue;
          feasible = false;
          // pulled across a face with nothing behind it
          if (held == 0 && size > 1e-7 * length && !cells.find(corner.seen_from(upper ^ (1u << a)).base)) {
            pulled = true;
            wall = cells.wall;
          }
        }
        if (!feasible) return;
        remaining = std::max(remaining, size);
        if (size > best.size && !(exhausted >> (upper * 8 + held) & 1u)) best = {size, upper, held, cell, s, t};
      });
    });
    if (cells.spent() || field.exhausted()) {
      result.status = Status::budget;
      return result;
    }
    if (!usable) {
      result.status = Status::critical;
      result.reason = found ? Reason::zero : cells.wall;
      return result;
    }
    turn_to(result.normal);
    if (!best.cell) {
      const bool stuck = remaining > kAccepted * length;
      if (stuck && !steepest) {
        steepest = true;
        exhausted = 0;
        continue;
      }
      result.status = stuck ? Status::budget : pulled ? Status::boundary : Status::ok;
      result.reason = wall;
      return result;
    }

    // follow it
    CellPoint next = corner.seen_from(best.upper);
    best.cell = cells.find(next.base);  // the others of the round may have taken its place
    if (!best.cell) {
      result.status = Status::budget;
      return result;
    }
    const Vec3 before = next.f;
    const PieceSample start = best.s;
    const Piece piece(mapping, *best.cell, field.level(), frames.of[best.held | corner.flat], field.steps());
    const bool crossed = best.size > kFarAway * field.voxel() &&
                         cross_cell(field, frames, piece, *best.cell, best.held | corner.flat, probe, best.s, best.t, next.f);
    const Followed how = crossed ? Followed::landed : follow(field, piece, probe, steepest, next.f, best.s, best.t);
    if (limit != nullptr && !limit->passed && limit->passed_by(piece.world(next.f))) {
      limit->passed = true;
      limit->last = next;
      limit->last.f = cut_short(field, piece, probe, *limit, start, before, next.f);
      limit->normal = start.n;
    }
    const unsigned faces = Corner(grid.index_box(), next).faces;
    if (how == Followed::converged && faces == 0 && norm(best.t) <= kRelease * length) {
      // within the cell no other piece meets the point
      at = next;
      turn_to(best.s.n);
      result.status = Status::ok;
      result.residual = std::fabs(best.s.distance);
      result.normal = best.s.n;
      return result;
    }
    const bool moved = norm(mapping.world_from_index_linear * (next.f - before)) > kStill * length;
    const bool snapped = !moved && faces != corner.faces;
    if (moved || snapped) exhausted = 0;
    if (moved) steepest = false;
    if ((!moved && !snapped) || how == Followed::blocked) exhausted |= std::uint64_t{1} << (best.upper * 8 + best.held);
    at = next;
  }
  result.status = Status::budget;
  return result;
}

}  // namespace catena::haptics
