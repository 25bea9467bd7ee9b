// SPDX-License-Identifier: MIT
/// Scene of the path tracer: what a packet shows, as rays on the processor meet it. Volumes, isosurfaces, meshes, tubes, arrows, glyphs,
/// spheres, the environment's and the widgets' items, and slices, which are unlit, cast nothing and are seen directly only. Immutable after
/// make(): any thread. The packet must outlive it.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/random.h"
#include "engine/base/result.h"
#include "render/frame/frame_packet.h"
#include "render/path/level_surface.h"
#include "render/path/shape_tree.h"
#include "render/path/volume_tracker.h"

namespace catena::render {

/// Place where light is scattered inside of a volume.
struct VolumeCollision {
  double t = 0;            ///< distance along the ray
  std::size_t volume = 0;  ///< index in volumes()
};

/// Scene of a packet.
class PathScene {
 public:
  /// Copies the voxels and sorts the shapes. Error: the packet has an item that cannot be traced.
  static Result<PathScene> make(const FramePacket& packet);

  /// Returns the nearest surface between two distances. `is_primary`: slices are seen, too.
  SurfaceHit surface(const PathRay& ray, double from, double to, bool is_primary) const;
  /// Returns the first collision in a volume between two distances.
  std::optional<VolumeCollision> collide(const PathRay& ray, double from, double to, Random& random) const;
  /// Returns an unbiased estimate of the transmittance up to distance `to`.
  double transmittance(const PathRay& ray, double to, Random& random) const;
  /// Volumes of the packet.
  const std::vector<VolumeTracker>& volumes() const { return volumes_; }
  /// Returns the color of a volume at a position, in the encoding of its transfer function.
  Color volume_color(std::size_t volume, const Vec3& position) const;
  /// One line for each kind of item that is not shown.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  /// Colors of another grid.
  struct OtherColors {
    std::shared_ptr<const DenseGrid> grid;
    PiecewiseCurve colors;
    const ColorSource* source;
    Color at(const Vec3& position, const Color& own) const;
  };
  explicit PathScene(const FramePacket& packet) : packet_(&packet) {}
  Result<std::shared_ptr<const DenseGrid>> dense(const field::ScalarGrid& grid);
  Result<std::optional<OtherColors>> other_colors(const std::optional<ColorSource>& source);
  Outcome add_slice(const SliceItem& slice);
  void add_shapes();
  void add(const TubeItem& item);
  void add(const ArrowItem& item);
  void add(const GlyphItem& item);
  void add(const SpheresItem& item);
  void add(const MeshItem& item);
  PathInterval visible(const PathRay& ray, bool is_clipped, double to) const;

  const FramePacket* packet_;
  std::map<const field::ScalarGrid*, std::shared_ptr<const DenseGrid>> grids_;
  std::vector<VolumeTracker> volumes_;
  std::vector<LevelSurface> surfaces_;
  std::vector<std::optional<OtherColors>> volume_colors_, surface_colors_;
  struct Slice {
    const SliceItem* item;
    std::shared_ptr<const DenseGrid> grid;
    PiecewiseCurve colors;
  };
  std::vector<Slice> slices_;
  ShapeTree shapes_;
  std::vector<std::string> notes_;
};

}  // namespace catena::render
