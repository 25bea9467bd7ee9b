#include "haptics/constraints/isosurface_cell_walk.h"

namespace catena::haptics {
namespace {

constexpr double kRelease = 1e-8;     // of L: a smaller tangential descent is none
constexpr double kConverged = 1e-10;  // of L: within a piece
constexpr double kStill = 1e-13;      // of L: a shorter move is none
constexpr double kAccepted = 1e-6;    // of L: what may remain where no piece moves any more
constexpr double kFaceSlack = 1e-12;  // voxels: closer to a face than this is on it
constexpr int kWalkRounds = 600;

bool is_flat(const field::Box& box, int a) { return !(box.hi[a] > box.lo[a]); }

/// The cells fetched in this tick: each is counted once.
class Cells {
 public:
  Cells(LevelField& field, int most) : field_(field), grid_(*field.grid()), last_(field.evaluations() + most) {}

  /// nullptr: a wall, or the budget is spent.
  const field::ScalarCell* find(const field::Index3& base) {
    const field::Box& box = grid_.index_box();
    const std::array<std::int32_t, 3> at{base.x, base.y, base.z};
    for (int a = 0; a < 3; ++a) {
      const double last = is_flat(box, a) ? box.lo[a] : box.hi[a] - 1;
      const double b = at[static_cast<std::size_t>(a)];
      if (b < box.lo[a] || b > last) return nullptr;
    }
    for (std::size_t k = 0; k < kCells && k < count_; ++k)
      if (slot(k)->base == base) return slot(k)->valid ? slot(k) : nullptr;
    if (field_.spent() || field_.evaluations() >= last_) {
      spent_ = true;
      return nullptr;
    }
    ++field_.evaluations();
    field::ScalarCell& cell = *new (slot(count_ % kCells)) field::ScalarCell(grid_.cell(base, field_.cursor()));
    ++count_;
    cell.base = base;
    for (const double c : cell.corner) cell.valid = cell.valid && std::isfinite(c);
    return cell.valid ? &cell : nullptr;
  }
  bool spent() const { return spent_; }

 private:
  LevelField& field_;
  const field::ScalarGrid& grid_;
  int last_;
  // raw bytes: most ticks need one cell, and clearing 32 would cost as much as the walk
  static constexpr std::size_t kCells = 32;
  field::ScalarCell* slot(std::size_t k) {
    return std::launder(reinterpret_cast<field::ScalarCell*>(&bytes_[k * sizeof(field::ScalarCell)]));
  }
  alignas(field::ScalarCell) std::array<std::byte, kCells * sizeof(field::ScalarCell)> bytes_;
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
/// and the tangential part at f, on the way in, and on the way out where it converged.
Followed follow(const Piece& piece, const field::Mapping& mapping, const Vec3& probe, double length, double voxel, Vec3& f, PieceSample& s,
                Vec3& t) {
  const auto gain = [&](const Vec3& from, const Vec3& to) {
    const Vec3 dp = mapping.world_from_index_linear * (to - from);
    return dot(dp, probe - piece.world(from)) - 0.5 * dot(dp, dp);
  };
  for (int i = 0; i < 40; ++i) {
    if (!s.usable) return Followed::blocked;
    const double size = norm(t);
    if (size <= std::max(kConverged * length, 1e-15 * norm(probe - piece.world(f)))) return Followed::converged;
    Vec3 u = piece.newton(f, probe, s, t);
    const double wanted = norm(u);
    if (wanted > 2 * voxel) u = u * (2 * voxel / wanted);

    bool accepted = false;
    for (int trial = 0; trial < 30 && !accepted; ++trial, u = u * 0.35) {
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
      Vec3 outer = g;
      bool inner = false;
      for (double alpha = 0.5; alpha > 1e-14; alpha *= 0.5) {
        if (!piece.retract(f, u * alpha, s, g)) break;
        int worst;
        const double v = piece.outside(g, worst);
        if (v <= 0) {
          low = alpha;
          v_low = v;
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
        const double face = outer[axis] < 0.5 ? 0.0 : 1.0;
        if (f[axis] == face || std::fabs(f[axis] - face) > kFaceSlack) return Followed::blocked;
        f[axis] = face;
        return Followed::landed;
      }

      // land on the face: Illinois on how far the point is outside
      double a = v_low, b = v_high;
      for (int k = 0; k < 80 && high - low > 1e-16 * high && v_high > 1e-15; ++k) {
        double w = k % 4 == 3 || !(a < 0) ? 0.5 : a / (a - b);
        if (!(w > 0 && w < 1)) w = 0.5;
        const double mid = low + (high - low) * w;
        if (!(mid > low && mid < high) || !piece.retract(f, u * mid, s, g)) break;
        const double v = piece.outside(g, axis);
        if (v <= 0)
          low = mid, a = v, b *= 0.5;
        else
          high = mid, b = v_high = v, outer = g, a *= 0.5;
      }
      if (v_high > 1e-9) continue;
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

WalkResult walk_cells(LevelField& field, const PieceFrames& frames, const Vec3& probe, int most, CellPoint& at) noexcept {
  const field::ScalarGrid& grid = *field.grid();
  const field::Mapping& mapping = grid.mapping();
  const double length = field.length();
  Cells cells(field, most);
  WalkResult result;
  std::uint64_t exhausted = 0;
  double remaining = 0;

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
    bool usable = false, pulled = false;
    remaining = 0;
    for_subsets(corner.faces, [&](unsigned flip) {
      const unsigned upper = own ^ flip;
      const CellPoint here = corner.seen_from(upper);
      const field::ScalarCell* cell = cells.find(here.base);
      if (!cell) return;
      for_subsets(corner.faces, [&](unsigned held) {
        const Piece piece(mapping, *cell, field.level(), frames.of[held | corner.flat]);
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
          if (held == 0 && size > 1e-7 * length && !cells.find(corner.seen_from(upper ^ (1u << a)).base)) pulled = true;
        }
        if (!feasible) return;
        remaining = std::max(remaining, size);
        if (size > best.size && !(exhausted >> (upper * 8 + held) & 1u)) best = {size, upper, held, cell, s, t};
      });
    });
    if (cells.spent()) {
      result.status = Status::budget;
      return result;
    }
    if (!usable) {
      result.status = Status::critical;
      return result;
    }
    if (!best.cell) {
      result.status = remaining > kAccepted * length ? Status::budget : pulled ? Status::boundary : Status::ok;
      return result;
    }

    // follow it
    CellPoint next = corner.seen_from(best.upper);
    const Vec3 before = next.f;
    const Piece piece(mapping, *best.cell, field.level(), frames.of[best.held | corner.flat]);
    const Followed how = follow(piece, mapping, probe, length, field.voxel(), next.f, best.s, best.t);
    const unsigned faces = Corner(grid.index_box(), next).faces;
    if (how == Followed::converged && faces == 0 && norm(best.t) <= kRelease * length) {
      // within the cell no other piece meets the point
      at = next;
      return {Status::ok, std::fabs(best.s.distance), best.s.n};
    }
    const bool moved = norm(mapping.world_from_index_linear * (next.f - before)) > kStill * length;
    const bool snapped = !moved && faces != corner.faces;
    if (moved || snapped) exhausted = 0;
    if ((!moved && !snapped) || how == Followed::blocked) exhausted |= std::uint64_t{1} << (best.upper * 8 + best.held);
    at = next;
  }
  result.status = Status::budget;
  return result;
}

}  // namespace catena::haptics
