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

constexpr double kRayGroups = 250;              // groups of rays through the image
constexpr double kSampleDistance = 2;           // distance of the samples, voxels
constexpr double kMaxSamples = 4096;            // maximum samples per ray
constexpr int kSamplesBeside = 3;               // samples taken in empty space beside visible space, in the same brick of 8
constexpr double kMinTransmittance = 1 / 256.;  // transmittance at which a ray ends
constexpr std::array<double, 2> kGroupOffsets[] = {
    {-1.5, -0.5}, {1.5, -0.5}, {-1.5, 0.5}, {1.5, 0.5}};  // pixels: the corners of the 4 x 2 pixels that are marched together

/// Part of a ray in a box of index space; empty if lo > hi.
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

/// Lists the samples that a ray takes; true: the extinction there is positive. A projection takes all samples.
void follow(const Ray& ray, const Part& part, double step, const VolumeItem& item, std::vector<bool>& samples) {
  samples.clear();
  const bool ends = item.projection == Projection::composite;
  field::Cursor cursor;
  double transmittance = 1;
  int empty = kSamplesBeside;  // samples since the last visible one
  for (double at = part.lo + 0.5 * step; at < part.hi && transmittance > kMinTransmittance; at += step) {
    const field::ScalarSample sample = item.grid->sample(ray.origin + at * ray.direction, cursor);
    const double sigma = sample.inside ? table_value(item.transfer, sample.value, 3) : 0;
    if (sigma > 0 || !ends) {
      samples.insert(samples.end(), std::size_t(std::clamp(empty - kSamplesBeside, 0, kSamplesBeside)), false);
      samples.push_back(true);
      empty = 0;
    } else if (++empty <= kSamplesBeside) {
      samples.push_back(false);
    }
    if (ends) transmittance *= std::exp(-sigma * step);
  }
}

}  // namespace

RayPathLength measure_ray_path_length(const FramePacket& packet) {
  Bounds bounds;
  for (const VolumeItem& item : packet.volumes) bounds.extend(field::world_bounds(item.grid->mapping(), item.grid->index_box()));
  const double width = packet.width, height = packet.height, spacing = std::max(1.0, std::sqrt(width * height / kRayGroups));
  const Camera camera = make_display_camera(packet.view, width, height, bounds);
  RayPathLength way;
  double groups = 0;
  std::vector<bool> samples, together;
  for (double y = 0.5 * spacing; y < height; y += spacing)
    for (double x = 0.5 * spacing; x < width; x += spacing, ++groups)
      for (const VolumeItem& item : packet.volumes) {
        const double edge = item.grid->mapping().min_voxel_edge(),
                     every = std::max(kSampleDistance,
                                      field::world_bounds(item.grid->mapping(), item.grid->index_box()).diagonal() / edge / kMaxSamples);
        together.clear();
        for (const auto [right, down] : kGroupOffsets) {
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
