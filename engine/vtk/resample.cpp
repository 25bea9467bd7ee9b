#include "engine/vtk/resample.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/vtk/cell_places.h"

namespace catena::vtk {
namespace {

struct Span3 {
  int lo[3], hi[3];
};

Span3 span_of(const Lattice& lattice, const double* bounds, double more) {
  const int n[3] = {lattice.size.x, lattice.size.y, lattice.size.z};
  Span3 span;
  for (int a = 0; a < 3; ++a) {
    const double lo = (bounds[2 * a] - lattice.origin[a]) / lattice.spacing[a],
                 hi = (bounds[2 * a + 1] - lattice.origin[a]) / lattice.spacing[a];
    span.lo[a] = std::clamp(static_cast<int>(std::ceil(lo - more - kInside)), 0, n[a]);
    span.hi[a] = std::clamp(static_cast<int>(std::floor(hi + more + kInside)), -1, n[a] - 1);
  }
  return span;
}

template <class Visit>
void each_voxel(const Lattice& lattice, const Span3& span, const Visit& visit) {
  for (int k = span.lo[2]; k <= span.hi[2]; ++k)
    for (int j = span.lo[1]; j <= span.hi[1]; ++j)
      for (int i = span.lo[0]; i <= span.hi[0]; ++i) visit(lattice.number(i, j, k), lattice.origin + lattice.spacing * Vec3(i, j, k));
}

void put(CellWork& work, bool inside, float* values, std::size_t components) {
  double value[3];
  work.value(inside, value);
  for (std::size_t c = 0; c < components; ++c) values[c] = static_cast<float>(value[c]);
}

constexpr std::uint8_t kNear = 2;  ///< of `valid`, meanwhile: next to a voxel inside

/// Voxels that touch one inside: straight on from those behind it, 2 v(1) - v(2), on average over the directions in which both are inside.
void continue_lattice(const Lattice& lattice, std::size_t components, float* values, std::uint8_t* valid) {
  const int n[3] = {lattice.size.x, lattice.size.y, lattice.size.z};
  const auto inside = [&](int i, int j, int k) {
    return i >= 0 && j >= 0 && k >= 0 && i < n[0] && j < n[1] && k < n[2] && valid[lattice.number(i, j, k)] == 1;
  };
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const std::size_t here = lattice.number(i, j, k);
        if (valid[here] != 0) continue;
        double straight[3] = {0, 0, 0}, beside[3] = {0, 0, 0};
        int lines = 0, neighbours = 0;
        for (int d = 0; d < 27; ++d) {
          const int x = d % 3 - 1, y = d / 3 % 3 - 1, z = d / 9 - 1;
          if (!inside(i + x, j + y, k + z)) continue;
          const std::size_t first = lattice.number(i + x, j + y, k + z);
          const bool far = inside(i + 2 * x, j + 2 * y, k + 2 * z);
          const std::size_t second = far ? lattice.number(i + 2 * x, j + 2 * y, k + 2 * z) : first;
          ++neighbours;
          lines += far ? 1 : 0;
          for (std::size_t c = 0; c < components; ++c) {
            const double v = static_cast<double>(values[first * components + c]);
            beside[c] += v;
            if (far) straight[c] += 2 * v - static_cast<double>(values[second * components + c]);
          }
        }
        if (neighbours == 0) continue;
        for (std::size_t c = 0; c < components; ++c)
          values[here * components + c] = static_cast<float>(lines > 0 ? straight[c] / lines : beside[c] / neighbours);
        valid[here] = kNear;
      }
}

/// Where cells are thinner than voxels no voxel may lie inside: those within a voxel's diagonal of a cell get the nearest one's polynomial.
void continue_cells(const std::vector<CellValues>& blocks, const Lattice& lattice, std::size_t components, float* values,
                    std::uint8_t* valid) {
  constexpr std::uint8_t kThin = 3;
  std::vector<float> nearest;
  const double near2 = dot(lattice.spacing, lattice.spacing);  // no corner around a place inside is farther from it
  for (const CellValues& block : blocks) {
    CellWork work(block);
    for (vtkIdType id = 0; id < block.data->GetNumberOfCells(); ++id) {
      double b[6];
      block.data->GetCellBounds(id, b);
      const Span3 span = span_of(lattice, b, 1);
      bool some = false;
      each_voxel(lattice, span, [&](std::size_t at, const Vec3&) { some = some || valid[at] == 0 || valid[at] == kThin; });
      if (!some || !work.at(id)) continue;
      if (nearest.empty()) nearest.assign(lattice.voxels(), std::numeric_limits<float>::infinity());
      each_voxel(lattice, span, [&](std::size_t at, const Vec3& p) {
        if (valid[at] != 0 && valid[at] != kThin) return;
        double distance2 = 0;
        const bool inside = work.inside(p, distance2);
        if (!(static_cast<float>(distance2) < nearest[at]) || (!inside && distance2 > near2)) return;
        nearest[at] = static_cast<float>(distance2);
        put(work, inside, values + at * components, components);
        valid[at] = kThin;
      });
    }
  }
}

void fill(const std::vector<CellValues>& blocks, const Lattice& lattice, float* values, std::uint8_t* valid) {
  const std::size_t components = components_of(blocks);
  for (const CellValues& block : blocks) {
    CellWork work(block);
    for (vtkIdType id = 0; id < block.data->GetNumberOfCells(); ++id) {
      if (!work.at(id)) continue;
      each_voxel(lattice, span_of(lattice, work.bounds(), 0), [&](std::size_t at, const Vec3& p) {
        double distance2 = 0;
        if (valid[at] != 0 || !work.inside(p, distance2)) return;
        put(work, true, values + at * components, components);
        valid[at] = 1;
      });
    }
  }
  continue_lattice(lattice, components, values, valid);
  continue_cells(blocks, lattice, components, values, valid);
}

/// The cells of a lattice that overlap cells of the data.
class Overlap {
 public:
  Overlap(const Lattice& lattice, std::vector<std::uint8_t>& cells) : lattice_(lattice), cells_(cells) {}

  void find(const std::vector<CellValues>& blocks) {
    for (const Test test : {Test::own_points, Test::middles, Test::corners})
      for (const CellValues& block : blocks) {
        CellWork work(block);
        for (vtkIdType id = 0; id < block.data->GetNumberOfCells(); ++id) {
          double b[6];
          block.data->GetCellBounds(id, b);
          if (!is_open(b) || !work.at(id)) continue;
          if (test == Test::own_points)
            work.each_corner([&](const Vec3& p) { mark(p); });
          else
            each_open(b, [&](std::size_t at, const Vec3& lowest) { cells_[at] = overlaps(work, lowest, test) ? 1 : 0; });
        }
      }
  }

 private:
  enum class Test { own_points, middles, corners };

  void mark(const Vec3& p) {
    int base[3];
    double t[3];
    if (CellPlaces::locate(lattice_, p, base, t)) cells_[lattice_.number(base[0], base[1], base[2])] = 1;
  }

  /// Calls visit(number, lowest corner) for the cells within bounds that are not marked.
  template <class Visit>
  void each_open(const double* b, const Visit& visit) const {
    const int n[3] = {lattice_.size.x, lattice_.size.y, lattice_.size.z};
    int lo[3], hi[3];
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::clamp(static_cast<int>(std::floor((b[2 * a] - lattice_.origin[a]) / lattice_.spacing[a])), 0, n[a] - 2);
      hi[a] = std::clamp(static_cast<int>(std::floor((b[2 * a + 1] - lattice_.origin[a]) / lattice_.spacing[a])), 0, n[a] - 2);
    }
    for (int k = lo[2]; k <= hi[2]; ++k)
      for (int j = lo[1]; j <= hi[1]; ++j)
        for (int i = lo[0]; i <= hi[0]; ++i) {
          const std::size_t at = lattice_.number(i, j, k);
          if (cells_[at] == 0) visit(at, lattice_.origin + lattice_.spacing * Vec3(i, j, k));
        }
  }
  bool is_open(const double* b) const {
    bool some = false;
    each_open(b, [&](std::size_t, const Vec3&) { some = true; });
    return some;
  }

  /// A place of the data's cell lies in the lattice's, not on its faces.
  bool overlaps(CellWork& work, const Vec3& lowest, Test test) const {
    constexpr double kBeside = 0.01;  // of a voxel
    const auto meets = [&](const Vec3& place) {
      double distance2 = 0;
      if (work.inside(lowest + place * lattice_.spacing, distance2)) return work.strictly_inside();
      bool in = true;
      for (int a = 0; a < 3; ++a) {
        const double at = (work.nearest()[a] - lowest[a]) / lattice_.spacing[a];
        in = in && at > kBeside && at < 1 - kBeside;
      }
      return in;
    };
    if (test == Test::middles) return meets(Vec3(0.5));
    for (int c = 0; c < 8; ++c)
      if (meets({(c & 1) != 0 ? 1 - kBeside : kBeside, (c & 2) != 0 ? 1 - kBeside : kBeside, (c & 4) != 0 ? 1 - kBeside : kBeside}))
        return true;
    return false;
  }

  const Lattice& lattice_;
  std::vector<std::uint8_t>& cells_;
};

/// Cells with a voxel that has no value are none; of the voxels the corners of cells are valid.
void agree(const Lattice& lattice, std::vector<std::uint8_t>& valid, std::vector<std::uint8_t>& cells) {
  std::vector<std::uint8_t> corners(valid.size(), 0);
  for (int k = 0; k < lattice.size.z; ++k)
    for (int j = 0; j < lattice.size.y; ++j)
      for (int i = 0; i < lattice.size.x; ++i) {
        std::uint8_t& cell = cells[lattice.number(i, j, k)];
        if (i + 1 == lattice.size.x || j + 1 == lattice.size.y || k + 1 == lattice.size.z) {
          cell = 1;  // there is none
          continue;
        }
        const auto corner = [&](int c) { return lattice.number(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)); };
        for (int c = 0; c < 8; ++c) cell = cell != 0 && valid[corner(c)] != 0 ? 1 : 0;
        for (int c = 0; c < 8 && cell != 0; ++c) corners[corner(c)] = 1;
      }
  valid = std::move(corners);
}

/// The grid at places of the least and the greatest value.
void find_extremes(const CellPlaces& places, Resampled& made, std::size_t components) {
  std::vector<double> read;
  for (const CellPlaces::Place& place : places.extremes()) {
    int base[3];
    double t[3], sum[3] = {0, 0, 0};
    if (!CellPlaces::locate(made.lattice, place.at, base, t)) continue;
    for (int k = 0; k < 8; ++k) {
      double weight = 1;
      for (int a = 0; a < 3; ++a) weight *= (k >> a & 1) != 0 ? t[a] : 1 - t[a];
      const std::size_t at = made.lattice.number(base[0] + (k & 1), base[1] + (k >> 1 & 1), base[2] + (k >> 2));
      for (std::size_t c = 0; c < components; ++c) sum[c] += weight * static_cast<double>(made.values[at * components + c]);
    }
    read.push_back(components == 1 ? sum[0] : std::hypot(sum[0], sum[1], sum[2]));
  }
  if (read.empty()) return;
  made.least = read.front();
  made.most = read.back();
}

ResampleError error_of(const CellPlaces& places, const Resampled& made, std::size_t components) {
  const Lattice& lattice = made.lattice;
  return places.error_on(lattice, places.places(), 1, [&](const CellPlaces::Place&, const int(&base)[3], int k, double* value) {
    const std::size_t at = lattice.number(base[0] + (k & 1), base[1] + (k >> 1 & 1), base[2] + (k >> 2));
    for (std::size_t c = 0; c < components; ++c) value[c] = static_cast<double>(made.values[at * components + c]);
    return made.valid[at] != 0;
  });
}

Lattice finer_than(const Lattice& lattice, double factor) {
  const Vec3 steps(lattice.size.x - 1, lattice.size.y - 1, lattice.size.z - 1);
  return lattice_of(lattice.origin, lattice.origin + lattice.spacing * steps, lattice.spacing, 1 / factor);
}

}  // namespace

Result<Resampled> resample(const std::vector<CellValues>& blocks, const ResamplePlan& plan, double most_voxels) {
  Resampled made;
  made.lattice = plan.lattice;
  const std::size_t components = components_of(blocks);
  const CellPlaces places(blocks, 2);
  Within within(blocks);
  const Vec3 steps(plan.lattice.size.x - 1, plan.lattice.size.y - 1, plan.lattice.size.z - 1);
  const BoxPlaces box(within, plan.lattice.origin, plan.lattice.origin + plan.lattice.spacing * steps, 4);
  const auto finished = [&]() -> Resampled {
    made.cells.assign(made.lattice.voxels(), 0);
    Overlap(made.lattice, made.cells).find(blocks);
    agree(made.lattice, made.valid, made.cells);
    made.range = places.range();
    made.shares = box.shares(made.lattice, made.cells);
    find_extremes(places, made, components);
    return std::move(made);
  };
  constexpr int kMostTimes = 6;
  double before = 1e300;
  for (int time = 0; time < kMostTimes; ++time) {
    made.values.assign(made.lattice.voxels() * components, 0.f);
    made.valid.assign(made.lattice.voxels(), 0);
    fill(blocks, made.lattice, made.values.data(), made.valid.data());
    made.error = error_of(places, made, components);
    if (made.error.p99 <= kWantedError) return finished();
    made.jumps = made.error.p99 > kWorthIt * before || plan.jumps;
    if ((made.jumps || !plan.fine) && time > 0) return finished();
    before = made.error.p99;
    constexpr double kLeastStep = 1.15, kMostStep = 1.6;
    const double finer = std::clamp(std::sqrt(made.error.p99 / (0.8 * kWantedError)), kLeastStep, kMostStep);
    made.wanted_voxels = static_cast<double>(made.lattice.voxels()) * std::pow(made.error.p99 / kWantedError, 1.5);
    Lattice next = finer_than(made.lattice, finer);
    if (static_cast<double>(next.voxels()) > most_voxels) {
      made.wanted_voxels = std::max(made.wanted_voxels, static_cast<double>(next.voxels()));
      break;
    }
    if (time + 1 < kMostTimes) made.lattice = next;
  }
  return finished();
}

}  // namespace catena::vtk
