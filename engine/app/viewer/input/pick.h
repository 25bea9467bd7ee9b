// SPDX-License-Identifier: MIT
/// Picking: the nearest opaque object under the pointer, or within volumes the point that their color comes from.
///   a ray through volumes: a(t) = 1 - exp(-integral of sigma), over all volumes; the point is the first t with a(t) >= 0.5, or if that is
///   never reached the t of the largest contribution, the largest d a/dt. A projection (maximum, minimum): the point of its value. If a
///   ray's total opacity stays below kMinPickOpacity there is no hit. A solid object is visible through volumes as long as a(t) < 0.5.
/// The transfer tables are those of the image, applied to the exact values of the grids, in steps of half a voxel; crossings are refined
/// linearly. World units. Pure functions over the packet, any thread.
#pragma once
#include <cstdint>
#include <optional>

#include "render/frame/camera.h"

namespace catena::app {

inline constexpr double kHalfOpaque = 0.5, kMinPickOpacity = 0.02;

/// The result of a pick.
struct PickHit {
  Vec3 world{0.0};
  std::uint32_t id = 0;  ///< Id in FramePacket::objects; 0: none.
  bool is_volume = false;
  double opacity = 1;  ///< Opacity of the volumes: of the whole ray, or kHalfOpaque where that was reached.
};

/// Returns the extinction per world unit at a value: linear between the table's points, constant beyond them.
double extinction_at(const render::TransferTable& table, double value);

/// Picks in the volumes, along the ray from the camera to `max_depth` (world units, may be infinite).
std::optional<PickHit> pick_volume(const render::FramePacket& packet, const render::Ray& ray, double max_depth);

/// Picks at `x, y`, in pixels of the packet. `depth`, `id`: of the nearest opaque object there (Renderer::pick); infinite depth: none.
std::optional<PickHit> pick(const render::FramePacket& packet, double x, double y, double depth, std::uint32_t id);

/// Returns the nearest solid object on the ray up to `max_depth`: isosurfaces, slices, meshes, tubes, glyphs and spheres, opaque or not,
/// where the clip planes keep them. Excludes probe, overlays and widgets: it is what the probe can be placed on. Isosurfaces: the first
/// sign change in steps of half a voxel, refined by bisection; a tube: where the ray enters its cylinder.
std::optional<PickHit> pick_solid(const render::FramePacket& packet, const render::Ray& ray, double max_depth);

/// Picks at `x, y` on the processor, without a rendered image, ignoring the probe: otherwise as pick(). With several eyes, from the point
/// between them.
std::optional<PickHit> pick_on_cpu(const render::FramePacket& packet, double x, double y);

/// Returns "isosurface density"; empty for 0 and for ids of no object.
std::string object_label(const render::FramePacket& packet, std::uint32_t id);

}  // namespace catena::app
