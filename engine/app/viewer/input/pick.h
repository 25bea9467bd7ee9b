/// These functions say what the pointer shows: the nearest opaque thing, or within volumes the place where their colour comes from.
///   a ray through a volume: a(t) = 1 - exp(-integral of sigma), of all volumes together; the place is the first t with a(t) >= 0.5, and
///   where it never gets there the t of the largest contribution, the largest d a/dt. A projection (maximum, minimum): the place of its
///   value. Where all that a ray meets stays below kMinPickOpacity there is nothing. A solid thing shows through volumes short of a(t) =
///   0.5.
/// The same transfer tables as the picture's, on the exact values of the grids, in steps of half a voxel; crossings are refined linearly.
/// World units. Pure functions over the packet, any thread.
#pragma once
#include <cstdint>
#include <optional>

#include "render/frame/camera.h"

namespace catena::app {

inline constexpr double kHalfOpaque = 0.5, kMinPickOpacity = 0.02;

struct PickHit {
  Vec3 world{0.0};
  std::uint32_t id = 0;  ///< of FramePacket::objects; 0: none
  bool is_volume = false;
  double opacity = 1;  ///< of the volumes: gathered on the whole ray, or kHalfOpaque where that was reached
};

/// Extinction per world unit of a value, linear between the table's points, constant beyond them.
double extinction_at(const render::TransferTable& table, double value);

/// Along the ray from the eye to `farthest` (world units, may be infinite).
std::optional<PickHit> pick_volume(const render::FramePacket& packet, const render::Ray& ray, double farthest);

/// In the picture's place `x, y`, in pixels of the packet. `depth`, `id`: of the nearest opaque thing there (Renderer::pick); infinite:
/// none.
std::optional<PickHit> pick(const render::FramePacket& packet, double x, double y, double depth, std::uint32_t id);

/// The nearest solid thing on the ray, up to `farthest`: isosurfaces, slices, meshes, tubes, opaque or not, of which the clip planes keep
/// something there. Not the hand, nor aids and widgets: it is what the hand can be put onto. Isosurfaces: the first change of sign in
/// steps of half a voxel, refined by bisection; a tube: where the ray enters its cylinder.
std::optional<PickHit> pick_solid(const render::FramePacket& packet, const render::Ray& ray, double farthest);

/// What a picture of the packet without the hand would show in its place `x, y`: as pick, without a picture. Where there are several
/// eyes, as seen from between them.
std::optional<PickHit> pick_on_cpu(const render::FramePacket& packet, double x, double y);

/// "isosurface density"; empty for 0 and for ids of no object.
std::string object_label(const render::FramePacket& packet, std::uint32_t id);

}  // namespace catena::app
