// SPDX-License-Identifier: MIT
#include "render/quality/ray_path_length.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/field/grid/grid.h"
#include "render/frame/camera.h"
#include "render/raycast/transfer_tables.h"

namespace catena::render {
namespace {

constexpr double kRays = 250;             // groups of them through the whole picture
constexpr double kEvery = 2;              // voxels between the samples here,
constexpr double kMostSamples = 4096;     // of which a ray has so many at most
constexpr int kBeside = 3;                // samples in what is empty beside what is seen, in the same brick of 8
constexpr double kLeastLight = 1 / 256.;  // where a ray ends
constexpr std::array<double, 2> kTogether[] = {{-1.5, -0.5}, {1.5, -0.5}, {-1.5, 0.5}, {1.5, 0.5}};  // pixels: of 4 x 2 in a vector's lanes

/// The part of a ray in a box of index space; empty: lo > hi.
struct Part {
  double lo = 0, hi = 1e300;
  void cut(double origin, double along, double from, double to) {
    if (along == 0) {
      if (origin < from || origin > to) hi = -1;
      return;
    }
    const auto [first, last] = std::minmax({(from - origin) / along, (to - origin) / along});
    lo = std::max(lo, first);
    hi = std::min(hi, last);
  }
};

Part part_of(const Ray& ray, const VolumeItem& item, const FramePacket& packet) {
  const field::Mapping& mapping = item.grid->mapping();
  const field::Box& box = item.grid->index_box();
  const Vec3 origin = mapping.index_from_world(ray.origin), end = mapping.index_from_world(ray.origin + ray.direction);
  Part part;
  for (int a = 0; a < 3; ++a) part.cut(origin[a], end[a] - origin[a], box.lo[a], box.hi[a]);
  if (!item.is_clipped) return part;
  for (const Plane& plane : packet.clip_planes)
    part.cut(dot(plane.normal, ray.origin - plane.point), dot(plane.normal, ray.direction), 0, 1e300);
  return part;
}

/// What a ray does, by the sample: true where it meets an extinction.
void follow(const Ray& ray, const Part& part, double step, const VolumeItem& item, std::vector<bool>& samples) {
  samples.clear();
  const bool ends = item.projection == Projection::composite;
  field::Cursor cursor;
  double light = 1;
  int empty = kBeside;  // samples since what was seen last
  for (double at = part.lo + 0.5 * step; at < part.hi && light > kLeastLight; at += step) {
    const field::ScalarSample sample = item.grid->sample(ray.origin + at * ray.direction, cursor);
    const double sigma = sample.inside ? table_value(item.transfer, sample.value, 3) : 0;
    if (sigma > 0 || !ends) {
      samples.insert(samples.end(), std::size_t(std::clamp(empty - kBeside, 0, kBeside)), false);
      samples.push_back(true);
      empty = 0;
    } else if (++empty <= kBeside) {
      samples.push_back(false);
    }
    if (ends) light *= std::exp(-sigma * step);
  }
}

}  // namespace

RayPathLength measure_ray_path_length(const FramePacket& packet) {
  Bounds bounds;
  for (const VolumeItem& item : packet.volumes) bounds.extend(field::world_bounds(item.grid->mapping(), item.grid->index_box()));
  const double width = packet.width, height = packet.height, spacing = std::max(1.0, std::sqrt(width * height / kRays));
  const Camera camera = make_camera(packet.view, width, height, bounds);
  RayPathLength way;
  double groups = 0;
  std::vector<bool> samples, together;
  for (double y = 0.5 * spacing; y < height; y += spacing)
    for (double x = 0.5 * spacing; x < width; x += spacing, ++groups)
      for (const VolumeItem& item : packet.volumes) {
        const double edge = item.grid->mapping().min_voxel_edge(),
                     every = std::max(kEvery,
                                      field::world_bounds(item.grid->mapping(), item.grid->index_box()).diagonal() / edge / kMostSamples);
        together.clear();
        for (const auto [right, down] : kTogether) {
          const Ray ray = pixel_ray(camera, x + right, y + down);
          const Part part = part_of(ray, item, packet);
          if (part.lo >= part.hi) continue;
          follow(ray, part, every * edge, item, samples);
          together.resize(std::max(together.size(), samples.size()));
          for (std::size_t i = 0; i < samples.size(); ++i) together[i] = together[i] || samples[i];
        }
        way.marched += every * double(together.size());
        way.visible += every * double(std::ranges::count(together, true));
      }
  way.marched *= width * height / groups;
  way.visible *= width * height / groups;
  return way;
}

}  // namespace catena::render
