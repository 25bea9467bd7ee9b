// SPDX-License-Identifier: MIT
#include "render/extract/auto_camera.h"

#include <algorithm>
#include <cmath>

#include "engine/field/grid/grid.h"
#include "engine/io/volume/units.h"
#include "engine/scene/visibility.h"
#include "render/extract/extract.h"
#include "render/extract/extract_internal.h"

namespace catena::render {
namespace {

constexpr double kMaxSamples = 1 << 18;
// a sample is visible if a slab of kThickness x domain length has at least this opacity
constexpr double kMinOpacity = 0.02, kThickness = 1.0 / 25;
constexpr double kOutlierShare = 0.002;                      // share of the points that the view may leave outside
constexpr double kHeight = 0.88, kWidth = 0.94, kFovy = 30;  // shares of the image that the data fill; degrees
constexpr double kImagePt = 576, kBarPt = 92, kHorizontalBarPt = 52, kTitlePt = 30, kAxesShare = 0.84, kLetterPt = 6.7;
constexpr std::size_t kNumberLetters = 6;
constexpr double kMinDataShare = 0.3;  // minimum share of the image for the data, beside bars and titles
constexpr double kFlat = 0.4;          // a box is flat if its shortest edge is less than this share of its middle edge

/// Cached visible points of a surface or volume, and the inputs that they were found from.
template <class T>
struct VisiblePoints {
  std::uint64_t version = 0;
  double level = 0;
  std::vector<std::array<double, 2>> extinctions;
  std::vector<Vec3> positions;
};

/// Reads rows of the sample grid along x at index (j, k) in y and z; invalid values are NaN.
class Rows {
 public:
  explicit Rows(const field::ScalarGrid& grid) : grid_(grid) {
    const field::Box& box = grid.index_box();
    for (int a = 0; a < 3; ++a) {
      lo_[a] = static_cast<int>(box.lo[a]);
      size_[a] = static_cast<int>(box.hi[a]) - lo_[a] + 1;
    }
    const double voxels = double(size_[0]) * size_[1] * size_[2];
    step_ = std::max(1, static_cast<int>(std::ceil(std::cbrt(voxels / kMaxSamples))));
    for (int a = 0; a < 3; ++a) count_[a] = (size_[a] - 1) / step_ + 1;
  }

  int count(int axis) const { return count_[axis]; }
  Vec3 world(double i, double j, double k) const {
    return grid_.mapping().world_from_index(Vec3(lo_[0] + i * step_, lo_[1] + j * step_, lo_[2] + k * step_));
  }

  void read(int j, int k, std::vector<float>& row) {
    row.assign(static_cast<std::size_t>(count_[0]), NAN);
    if (j >= count_[1] || k >= count_[2]) return;
    whole_.resize(static_cast<std::size_t>(size_[0]));
    const int y = lo_[1] + j * step_, z = lo_[2] + k * step_;
    grid_.read_block({lo_[0], y, z}, {size_[0], 1, 1}, whole_);
    valid_.assign(whole_.size(), 1);
    // validity belongs to cells; the last layer of voxels takes the validity of the cells before it
    const auto cell = [&](int a, int at) { return std::min(at, lo_[a] + std::max(size_[a] - 2, 0)); };
    if (grid_.has_mask()) grid_.read_cell_validity({lo_[0], cell(1, y), cell(2, z)}, {size_[0], 1, 1}, valid_);
    for (int i = 0; i < count_[0]; ++i)
      if (valid_[static_cast<std::size_t>(cell(0, lo_[0] + i * step_) - lo_[0])] != 0)
        row[static_cast<std::size_t>(i)] = whole_[static_cast<std::size_t>(i) * static_cast<std::size_t>(step_)];
  }

 private:
  const field::ScalarGrid& grid_;
  int lo_[3]{}, size_[3]{}, count_[3]{}, step_ = 1;
  std::vector<float> whole_;
  std::vector<std::uint8_t> valid_;
};

/// The first and the last visible index of a row along an axis.
struct Ends {
  int axis = 0;
  double first = INFINITY, last = -INFINITY;
  Vec3 first_place{0.0}, last_place{0.0};
  void add(const Vec3& index) {
    if (index[axis] < first) first = index[axis], first_place = index;
    if (index[axis] > last) last = index[axis], last_place = index;
  }
  void give(const Rows& rows, std::vector<Vec3>& positions) const {
    if (first > last) return;
    positions.push_back(rows.world(first_place.x, first_place.y, first_place.z));
    if (last > first) positions.push_back(rows.world(last_place.x, last_place.y, last_place.z));
  }
};

std::vector<Vec3> corners_of(const Bounds& bounds) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8 && !bounds.empty(); ++i) corners.push_back(bounds.corner(i));
  return corners;
}

std::vector<Vec3> domain_of(const field::ScalarGrid& grid) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back(grid.corner(i));
  return corners;
}

/// Returns the points that no clipping plane cuts away.
std::vector<Vec3> points_inside_clip_planes(std::vector<Vec3> positions, const FramePacket& packet) {
  std::erase_if(positions, [&](const Vec3& p) {
    return std::ranges::any_of(packet.clip_planes, [&](const Plane& plane) { return dot(p - plane.point, plane.normal) < 0; });
  });
  return positions;
}

/// Returns the points where the plane of a slice crosses the edges of its grid's domain.
std::vector<Vec3> slice_points(const SliceItem& slice) {
  std::vector<Vec3> positions;
  for (int i = 0; i < 8; ++i)
    for (int axis = 1; axis < 8; axis *= 2) {
      if ((i & axis) != 0) continue;
      const Vec3 a = slice.grid->corner(i), b = slice.grid->corner(i | axis);
      const double from = dot(a - slice.point, slice.normal), to = dot(b - slice.point, slice.normal);
      if (from == to || (from < 0) == (to < 0)) continue;
      positions.push_back(a + from / (from - to) * (b - a));
    }
  return positions;
}

template <class T>
void add_seen(const scene::Scene& scene, const FramePacket& packet, std::vector<FitPoints>& clouds) {
  for (const scene::Entity e : entities_with<T>(scene.entities)) {
    if (scene::is_hidden(scene.entities, e)) continue;
    const field::AnyField& any = scene::rendered_field(scene, scene.entities.get<T>(e).field);
    std::vector<Vec3> positions;
    if (scene.cache.has<VisiblePoints<T>>(e)) positions = scene.cache.get<VisiblePoints<T>>(e).positions;
    if (positions.empty() && any.scalar && any.scalar->grid() != nullptr) positions = domain_of(*any.scalar->grid());
    for (Vec3& p : positions) p *= scene.stretch;
    clouds.push_back(
        {scene.entities.get<T>(e).clipped ? points_inside_clip_planes(std::move(positions), packet) : std::move(positions), kOutlierShare});
  }
}

/// Returns whether a file of the scene states patient coordinates.
bool is_patient(const scene::Scene& scene) {
  bool patient = false;
  scene.entities.each<scene::FieldSource>([&](scene::Entity, const scene::FieldSource& source) {
    if (source.file && source.rendered.get() != nullptr)
      patient = patient || field::read_units(source.file->path, source.file->grid).is_patient_space;
  });
  scene.entities.each<scene::CurvesSource>(
      [&](scene::Entity, const scene::CurvesSource& source) { patient = patient || (source.loaded && source.loaded->is_patient_space); });
  return patient;
}

/// Returns the direction from which a single slice is seen as an image, if the scene shows nothing else.
std::optional<Vec3> image_direction(const scene::Scene& scene, const FramePacket& packet) {
  const bool others = !packet.volumes.empty() || !packet.isosurfaces.empty() || !packet.meshes.empty() || !packet.tubes.empty() ||
                      !packet.glyphs.empty() || !packet.spheres.empty();
  if (packet.slices.size() != 1 || others) return std::nullopt;
  const Vec3 normal = direction(packet.slices.front().normal);
  // x to the right, or y; of a patient the right side is on the left
  const Vec3 before = is_patient(scene) ? Vec3(-0.1, 1.0, -1.1) : Vec3(0.9, -1.0, 1.1);
  return dot(normal, before) < 0 ? -1.0 * normal : normal;
}

Vec3 first_direction(const scene::Scene& scene, const FramePacket& packet, const std::vector<FitPoints>& clouds) {
  if (const auto along = image_direction(scene, packet)) return *along;
  if (is_patient(scene)) return Vec3(0.4, 1.0, 0.3);
  Bounds all;
  for (const FitPoints& cloud : clouds)
    for (const Vec3& p : cloud.points) all.extend(p);
  if (all.empty()) return default_view_direction();
  const Vec3 size = all.hi - all.lo;
  std::array<double, 3> edges{size.x, size.y, size.z};
  std::ranges::sort(edges);
  if (!(edges[0] < kFlat * edges[1])) return default_view_direction();
  if (size.z == edges[0]) return Vec3(0.25, -0.7, 1.0);
  return size.y == edges[0] ? Vec3(0.35, -1.0, 0.3) : Vec3(1.0, -0.35, 0.3);
}

/// Returns the extra width that the names of a legend need beyond a scalar bar's numbers, in points; estimated by the count of letters.
double legend_pt(const ScalarBarItem& bar) {
  std::size_t longest = 0;
  const auto begins_letter = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
  for (const BarTick& tick : bar.ticks)
    longest = std::max(longest, static_cast<std::size_t>(std::ranges::count_if(tick.text, begins_letter)));
  return bar.band_count > 0 && longest > kNumberLetters ? kLetterPt * double(longest - kNumberLetters) : 0;
}

/// The part of the image that is left for the data.
struct Room {
  Vec2 share;        ///< shares of the image's width and height
  double shift = 0;  ///< distance of the room's middle to the left of the image's middle, by the image's height
};

/// Scalar bars, titles and axis numbers narrow the room on both sides alike, so that the data stay centered; legend names move its middle.
Room room(const scene::Scene& scene, const FramePacket& packet) {
  const double points = kImagePt / std::min(packet.width, packet.height);
  const double width_pt = packet.width * points, height_pt = packet.height * points;
  double sides[4] = {0, 0, 0, 0}, names[4] = {0, 0, 0, 0};
  for (const ScalarBarItem& bar : packet.overlay.scalar_bars) {
    sides[int(bar.side)] += bar.side == Side::left || bar.side == Side::right ? kBarPt : kHorizontalBarPt;
    names[int(bar.side)] += legend_pt(bar);
  }
  if (!packet.overlay.texts.empty()) sides[int(Side::top)] += kTitlePt;
  const double beside = std::max(sides[int(Side::left)], sides[int(Side::right)]);
  const double above = std::max(sides[int(Side::top)], sides[int(Side::bottom)]);
  const auto left_of = [&](double max_share, double taken_pt, double whole_pt) {
    return std::clamp(1 - packet.overlay.scale * taken_pt / whole_pt, kMinDataShare, max_share);
  };
  const double left = names[int(Side::left)], right = names[int(Side::right)];
  Room room{{left_of(kWidth, 2 * beside + left + right, width_pt), left_of(kHeight, 2 * above, height_pt)}};
  room.shift = 0.5 * packet.overlay.scale * (right - left) / height_pt;
  if (scene.axes) room.share = kAxesShare * room.share;
  return room;
}

}  // namespace

std::vector<Vec3> find_visible_points(const field::ScalarGrid& grid, double level) {
  Rows rows(grid);
  std::vector<Vec3> positions;
  std::vector<float> row, beside, above;
  for (int k = 0; k < rows.count(2); ++k)
    for (int j = 0; j < rows.count(1); ++j) {
      rows.read(j, k, row);
      rows.read(j + 1, k, beside);
      rows.read(j, k + 1, above);
      Ends ends[3]{{0}, {1}, {2}};
      const auto cross = [&](int axis, double a, double b, Vec3 at) {
        if (!std::isfinite(a) || !std::isfinite(b) || (a < level) == (b < level)) return;
        at[axis] += (level - a) / (b - a);
        ends[axis].add(at);
      };
      for (std::size_t i = 0; i < row.size(); ++i) {
        const Vec3 at(static_cast<double>(i), j, k);
        if (i + 1 < row.size()) cross(0, row[i], row[i + 1], at);
        cross(1, row[i], beside[i], at);
        cross(2, row[i], above[i], at);
      }
      for (const Ends& one : ends) one.give(rows, positions);
    }
  return positions;
}

std::vector<Vec3> find_visible_points(const field::ScalarGrid& grid, const TransferTable& transfer) {
  const double min_extinction = -std::log(1 - kMinOpacity) / (kThickness * grid.domain_length());
  Rows rows(grid);
  std::vector<Vec3> positions;
  std::vector<float> row;
  for (int k = 0; k < rows.count(2); ++k)
    for (int j = 0; j < rows.count(1); ++j) {
      rows.read(j, k, row);
      Ends ends;
      for (std::size_t i = 0; i < row.size(); ++i)
        if (std::isfinite(row[i]) && interpolate_piecewise(transfer.extinctions, row[i], 1) >= min_extinction)
          ends.add(Vec3(static_cast<double>(i), j, k));
      ends.give(rows, positions);
    }
  return positions;
}

void prepare_auto_camera(scene::Scene& scene) {
  if (scene.camera.is_explicit) return;
  const auto analyze = [&]<class T>(const T*, const auto& fill) {
    for (const scene::Entity e : entities_with<T>(scene.entities)) {
      const T& thing = scene.entities.get<T>(e);
      if (scene::is_hidden(scene.entities, e)) continue;
      const field::AnyField& any = scene::rendered_field(scene, thing.field);
      if (!any.scalar || any.scalar->grid() == nullptr) continue;  // extract_frame reports the error
      const field::ScalarGrid& grid = *any.scalar->grid();
      if (!scene.cache.has<VisiblePoints<T>>(e)) scene.cache.emplace<VisiblePoints<T>>(e);
      fill(thing, any, grid, scene.cache.get<VisiblePoints<T>>(e));
    }
  };
  analyze(static_cast<const scene::Isosurface*>(nullptr),
          [](const scene::Isosurface& surface, const field::AnyField&, const field::ScalarGrid& grid, auto& cached) {
            if (cached.version == grid.version() && cached.level == surface.level) return;
            cached = {grid.version(), surface.level, {}, find_visible_points(grid, surface.level)};
          });
  analyze(static_cast<const scene::Volume*>(nullptr),
          [](const scene::Volume& volume, const field::AnyField& any, const field::ScalarGrid& grid, auto& cached) {
            const TransferTable transfer = make_transfer_table(volume.transfer, any);
            if (cached.version == grid.version() && cached.extinctions == transfer.extinctions) return;
            cached = {grid.version(), 0, transfer.extinctions, find_visible_points(grid, transfer)};
          });
}

/// Adds the points of tubes, at most about 200000 in even steps, because the view is fitted often.
static void add_tubes(const FramePacket& packet, std::vector<FitPoints>& clouds) {
  constexpr std::size_t kMaxPoints = 200000;
  std::size_t all = 0;
  for (const TubeItem& tube : packet.tubes) all += tube.points.size();
  const std::size_t step = 1 + all / kMaxPoints;
  std::size_t next = 0;  // index from the first point of the current tube
  for (const TubeItem& tube : packet.tubes) {
    std::vector<Vec3> positions;
    for (; next < tube.points.size(); next += step) positions.push_back(tube.points[next]);
    next -= tube.points.size();
    clouds.push_back({tube.is_clipped ? points_inside_clip_planes(std::move(positions), packet) : std::move(positions)});
  }
}

View make_auto_view(const scene::Scene& scene, const FramePacket& packet) {
  std::vector<FitPoints> clouds;
  add_seen<scene::Volume>(scene, packet, clouds);
  add_seen<scene::Isosurface>(scene, packet, clouds);
  for (const SliceItem& slice : packet.slices)
    clouds.push_back({slice.is_clipped ? points_inside_clip_planes(slice_points(slice), packet) : slice_points(slice)});
  for (const MeshItem& mesh : packet.meshes)
    clouds.push_back({mesh.is_clipped ? points_inside_clip_planes(mesh.geometry->vertices, packet) : mesh.geometry->vertices});
  add_tubes(packet, clouds);
  for (const GlyphItem& item : packet.glyphs) {
    std::vector<Vec3> positions;
    for (const Glyph& glyph : item.glyphs) positions.insert(positions.end(), {glyph.tail, glyph.tip});
    clouds.push_back({item.is_clipped ? points_inside_clip_planes(std::move(positions), packet) : std::move(positions)});
  }
  for (const SpheresItem& item : packet.spheres) {
    constexpr std::size_t kMaxPoints = 200000;
    const Bounds& core = item.spheres->robust_bounds;
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < item.spheres->offsets.size(); i += 1 + item.spheres->offsets.size() / kMaxPoints)
      if (const Vec3 p = item.spheres->position(i); core.empty() || core.contains(p)) positions.push_back(p);
    clouds.push_back({item.is_clipped ? points_inside_clip_planes(std::move(positions), packet) : std::move(positions)});
  }
  Bounds remaining;
  for (const ArrowItem& arrow : packet.arrows) remaining.extend(arrow.tip);
  for (const IndicatorItem& indicator : packet.indicators)
    for (const Vec3& p : indicator.tube.points) remaining.extend(p, indicator.arrow.radius);
  for (const CursorItem& cursor : packet.cursors) {
    remaining.extend(cursor.probe, cursor.radius);
    for (const Vec3& p : cursor.proxies) remaining.extend(p, cursor.radius);
  }
  clouds.push_back({corners_of(remaining)});
  // everything is clipped away: the bounds without clipping
  if (std::ranges::all_of(clouds, [](const FitPoints& cloud) { return cloud.points.empty(); }))
    clouds.push_back({corners_of(packet_bounds(packet))});
  const Vec3 to_camera = first_direction(scene, packet, clouds);
  constexpr double kSteep = 0.9;
  const Vec3 up = std::fabs(direction(to_camera).z) > kSteep ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
  // a box or axes around everything drawn must be visible, too
  if (scene.bounding_box || scene.axes) clouds.push_back({corners_of(packet_bounds(packet))});
  const Room left = room(scene, packet);
  const auto fit = [&] {
    return fit_view(clouds, static_cast<double>(packet.width) / packet.height, left.share.x, left.share.y, to_camera, kFovy, up);
  };
  View view = fit();
  // of several volumes, such as channels, nothing is left outside if the rest stays almost as large
  if (packet.volumes.size() > 1) {
    constexpr double kMostDistance = 1.25;
    for (FitPoints& cloud : clouds) cloud.outlier_share = 0;
    const View whole = fit();
    if (norm(whole.position - whole.target) <= kMostDistance * norm(view.position - view.target)) view = whole;
  }
  if (left.shift != 0) {
    const Vec3 shift = left.shift * view.height * make_camera(view, packet.width, packet.height, {}).right;
    view.position += shift;
    view.target += shift;
  }
  return view;
}

}  // namespace catena::render
