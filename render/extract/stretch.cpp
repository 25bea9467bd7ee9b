// SPDX-License-Identifier: MIT
#include "render/extract/stretch.h"

#include <map>

#include "engine/field/bricks/paged_grid.h"
#include "engine/field/grid/grid.h"
#include "render/extract/extract.h"
#include "render/extract/extract_internal.h"

namespace catena::render {
namespace {

/// Stretched copies of objects that frames share, by their originals. Copies that the last frame did not use are dropped.
template <class T>
class StretchedCopies {
 public:
  /// Returns the copy of `original`; made by `make` if there is none.
  template <class Make>
  std::shared_ptr<const T> get(const std::shared_ptr<const T>& original, const Make& make) {
    Copy& copy = copies_[original.get()];
    if (!copy.stretched) copy = {original, make(*original), true};
    copy.is_used = true;
    return copy.stretched;
  }
  /// Drops the copies that were not used since the last call.
  void drop_unused() {
    std::erase_if(copies_, [](const auto& entry) { return !entry.second.is_used; });
    for (auto& [original, copy] : copies_) copy.is_used = false;
  }

 private:
  struct Copy {
    std::shared_ptr<const T> original, stretched;  ///< the original is kept, so that its address stays its own
    bool is_used = false;
  };
  std::map<const T*, Copy> copies_;
};

struct StretchedData {
  Vec3 stretch{1.0};
  StretchedCopies<field::ScalarGrid> grids;
  StretchedCopies<field::PagedGrid> paged_grids;
  StretchedCopies<MeshGeometry> meshes;
  StretchedCopies<SphereSet> spheres;
};

/// Component of scene.cache: one for a scene, at its first entity.
struct StretchCache {
  std::shared_ptr<StretchedData> data;
};
constexpr scene::Entity kOwner{0};

/// Stretches items by one set of factors.
class Stretcher {
 public:
  Stretcher(StretchedData& data, double scale) : data_(data), s_(data.stretch), scale_(scale) {}

  void grid(std::shared_ptr<const field::ScalarGrid>& grid) const {
    if (!grid) return;
    grid = data_.grids.get(grid, [&](const field::ScalarGrid& original) { return original.with_mapping(stretched(original.mapping())); });
  }
  void grid(std::shared_ptr<const field::ScalarGrid>& grid, std::shared_ptr<const field::PagedGrid>& paged) const {
    this->grid(grid);
    if (!paged) return;
    paged =
        data_.paged_grids.get(paged, [&](const field::PagedGrid& original) { return original.over(grid, stretched(original.mapping())); });
  }
  field::Mapping stretched(const field::Mapping& from) const {
    Mat3 linear = from.world_from_index_linear;
    for (int column = 0; column < 3; ++column) linear[column] *= s_;
    return field::Mapping::from_linear(linear, s_ * from.origin);
  }
  void colors(std::optional<ColorSource>& source) const {
    if (source) grid(source->grid);
  }
  void operator()(VolumeItem& item) const {
    grid(item.grid, item.paged);
    colors(item.color_by);
    for (auto& row : item.transfer.extinctions) row[1] /= scale_;
    for (auto& row : item.transfer.gradient_factors) row[0] /= scale_;
    item.transfer.opacity_length *= scale_;
  }
  void operator()(IsosurfaceItem& item) const {
    grid(item.grid, item.paged);
    colors(item.color_by);
  }
  void operator()(MeshItem& item) const {
    item.geometry = data_.meshes.get(item.geometry, [&](const MeshGeometry& original) {
      auto copy = std::make_shared<MeshGeometry>(original);
      for (Vec3& p : copy->vertices) p *= s_;
      for (Vec3& n : copy->normals) n = direction(n / s_);
      return copy;
    });
  }
  void operator()(SliceItem& item) const {
    grid(item.grid, item.paged);
    (*this)(item.point, item.normal);
  }
  void operator()(Vec3& point, Vec3& normal) const {
    point *= s_;
    normal = direction(normal / s_);
  }
  void operator()(TubeItem& item) const {
    std::vector<Vec3> points = item.points.list();
    for (Vec3& p : points) p *= s_;
    item.points = std::move(points);
    item.radius *= scale_;
  }
  void operator()(ArrowItem& item) const {
    const double length = scale_ * norm(item.tip - item.base);
    item.base *= s_;
    item.tip = item.base + length * direction(s_ * item.tip - item.base);
    item.radius *= scale_;
  }
  void operator()(GlyphItem& item) const {
    std::vector<Glyph> glyphs = item.glyphs.list();
    for (Glyph& glyph : glyphs) glyph.tail *= s_, glyph.tip *= s_;
    item.glyphs = std::move(glyphs);
  }
  void operator()(SpheresItem& item) const {
    item.spheres = data_.spheres.get(item.spheres, [&](const SphereSet& original) {
      auto copy = std::make_shared<SphereSet>(original);
      copy->origin *= s_;
      for (glm::vec3& offset : copy->offsets) offset = glm::vec3(s_ * Vec3(offset));
      for (float& radius : copy->radii) radius = static_cast<float>(scale_ * radius);
      if (!copy->robust_bounds.empty()) copy->robust_bounds = copy->robust_bounds.scaled(s_);
      return copy;
    });
  }
  template <class Item>
  void all(std::vector<Item>& items) const {
    for (Item& item : items) (*this)(item);
  }

 private:
  StretchedData& data_;
  Vec3 s_;
  double scale_;
};

StretchedData& data_of(const scene::Scene& scene) { return *scene.cache.get<StretchCache>(kOwner).data; }

}  // namespace

double size_scale(const Bounds& world, const Vec3& stretch) {
  const double diagonal = world.diagonal();
  return diagonal > 0 ? norm(stretch * (world.hi - world.lo)) / diagonal : 1;
}

void prepare_stretch(scene::Scene& scene) {
  if (scene.stretch == Vec3(1.0)) return;
  if (!scene.cache.has<StretchCache>(kOwner)) scene.cache.emplace<StretchCache>(kOwner);
  auto& data = scene.cache.get<StretchCache>(kOwner).data;
  if (!data || data->stretch != scene.stretch) data = std::make_shared<StretchedData>(StretchedData{scene.stretch, {}, {}, {}, {}});
}

void stretch_cursor(const Vec3& stretch, double scale, CursorItem& cursor) {
  if (stretch == Vec3(1.0)) return;
  cursor.probe *= stretch;
  for (Vec3& p : cursor.proxies) p *= stretch;
  if (cursor.foot_point) *cursor.foot_point *= stretch;
  cursor.force_n = norm(cursor.force_n) * direction(stretch * cursor.force_n);
  cursor.radius *= scale;
}

void stretch_items(const scene::Scene& scene, FramePacket& packet) {
  if (scene.stretch == Vec3(1.0)) return;
  StretchedData& data = data_of(scene);
  const Bounds drawn = drawn_bounds(packet);
  packet.size_scale = size_scale(drawn.empty() ? packet_bounds(packet) : drawn, scene.stretch);
  packet.view.stretch = scene.stretch;
  const Stretcher stretch(data, packet.size_scale);
  stretch.all(packet.volumes);
  stretch.all(packet.isosurfaces);
  stretch.all(packet.meshes);
  stretch.all(packet.slices);
  stretch.all(packet.tubes);
  stretch.all(packet.arrows);
  stretch.all(packet.glyphs);
  stretch.all(packet.spheres);
  for (CursorItem& cursor : packet.cursors) stretch_cursor(scene.stretch, packet.size_scale, cursor);
  for (IndicatorItem& indicator : packet.indicators) stretch(indicator.tube), stretch(indicator.arrow);
  for (LabelItem& label : packet.overlay.labels) label.position *= scene.stretch;
  for (Plane& plane : packet.clip_planes) stretch(plane.point, plane.normal);
  data.grids.drop_unused();
  data.paged_grids.drop_unused();
  data.meshes.drop_unused();
  data.spheres.drop_unused();
}

void stretch_slices(const scene::Scene& scene, FramePacket& packet) {
  if (scene.stretch == Vec3(1.0)) return;
  Stretcher(data_of(scene), 1).all(packet.slices);
}

}  // namespace catena::render
