/// Sampled fields: a NanoVDB buffer on the CPU is the truth; the GPU mirror is made from it and can always be thrown away.
/// NanoVDB and OpenVDB stay inside this room's .cpp files.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/cubic.h"
#include "engine/field/field.h"

namespace catena::field {

/// Counts and ranges over a grid's active voxels.
struct GridStats {
  std::uint64_t active_voxels = 0;              ///< active (and valid) voxels
  std::uint64_t nan_count = 0;                  ///< active voxels with a NaN or an infinity
  double min = 0, max = 0;                      ///< scalars: values; vectors: magnitudes (finite ones only)
  Vec3 component_min{0.0}, component_max{0.0};  ///< vectors: by component, finite ones only
};

/// A scalar grid: immutable, shared; every const function is for any thread.
class ScalarGrid final : public ScalarField {
 public:
  struct Storage;  ///< the NanoVDB buffers
  struct Halo;     ///< what cubic cells need beside them
  ScalarGrid(std::string name, const Mapping& mapping, const Box& index_box, std::shared_ptr<const Storage> storage, const GridStats& stats,
             Interpolation interpolation = Interpolation::linear, std::shared_ptr<const Halo> ghosts = {});
  ~ScalarGrid() override;

  /// As ScalarField says, by the grid's interpolation.
  ScalarSample sample(const Vec3& world, Cursor& cursor) const noexcept override;
  SampleStatus status_outside(const Vec3& world, Cursor& cursor) const noexcept override;
  double min_value() const noexcept override;
  /// As ScalarField says. Of data that were resampled (engine/io/vtk/resample.h) both are the range of the file's own values, which
  /// stats(), of the voxels, may leave.
  double max_value() const noexcept override;
  /// Itself.
  const ScalarGrid* grid() const noexcept override { return this; }
  /// True.
  bool is_grid() const noexcept override { return true; }
  /// How it is read between its voxel centres. It never changes: cubic(), linear() and interpolated() give another grid.
  Interpolation interpolation() const noexcept override { return interpolation_; }
  /// Of voxels, mask and ghosts.
  std::size_t bytes() const noexcept override;
  /// A grid that shares the voxels, is read by cubic cells and has a version of its own. An error (one phrase) where there is no memory for
  /// its ghosts.
  Result<std::shared_ptr<const ScalarGrid>> as_cubic() const;
  /// Reads trilinearly.
  std::shared_ptr<const ScalarGrid> as_linear() const { return with_interpolation(Interpolation::linear); }
  /// The same voxels, read trilinearly or by the nearest one; Interpolation::cubic is a bug here.
  std::shared_ptr<const ScalarGrid> with_interpolation(Interpolation linear_or_nearest) const;
  /// Of a cubic grid, the samples of a legal cell that is valid; null elsewhere. Good until the cursor's next use.
  const CubicSamples<1>* cubic_samples(const Index3& base, Cursor& cursor) const noexcept;

  /// The cell whose base is the nearest legal one to `base` (clamped so that base and base + 1 lie in the index box).
  ScalarCell cell(const Index3& base, Cursor& cursor) const noexcept;
  Index3 cell_base(const Vec3& index) const noexcept;  ///< floor, clamped to legal bases
  /// Of all its voxels, taken when it was made.
  const GridStats& stats() const { return stats_; }
  /// The value of voxels that the tree does not hold.
  float background() const;
  bool has_mask() const;  ///< some cells may be invalid: a `valid` mask, or values that are not finite
  /// CellCache may be invalid though all their corners are valid: the mask was given by cells, and voxels alone do not say it.
  bool has_cell_mask() const;
  /// Copies `size` voxels an axis from `origin` into out (x fastest); voxels outside the tree give the background. Of a cubic grid
  /// missing samples are given as their ghosts (ghosts.h).
  void read_block(const Index3& origin, const Index3& size, std::span<float> out) const;
  /// 1 where the *cell* based at the voxel is valid (always 1 inside the box without a mask), 0 elsewhere.
  void read_cell_validity(const Index3& origin, const Index3& size, std::span<std::uint8_t> out) const;
  /// True where the 8^3 block at `origin` (a multiple of 8) holds only one value and no tree leaf; `value` is it.
  bool is_constant_block(const Index3& origin, float& value) const;
  const Storage& storage() const { return *storage_; }  ///< opaque outside this room

 private:
  std::shared_ptr<const Storage> storage_;
  GridStats stats_;
  Interpolation interpolation_;
  std::shared_ptr<const Halo> halo_;  ///< of a cubic grid
};

/// A vector grid: immutable, shared; every const function is for any thread.
class VectorGrid final : public VectorField {
 public:
  struct Storage;
  struct Halo;
  /// From NanoVDB's buffers; programs use make_vector_grid() or load().
  VectorGrid(std::string name, const Mapping& mapping, const Box& index_box, std::shared_ptr<const Storage> storage, const GridStats& stats,
             std::shared_ptr<const Halo> ghosts = {});
  ~VectorGrid() override;

  /// As VectorField says.
  VectorSample sample(const Vec3& world, Cursor& cursor) const noexcept override;
  LineSample sample_line(const Vec3& world, Cursor& cursor) const noexcept override;
  SampleStatus status_outside(const Vec3& world, Cursor& cursor) const noexcept override;
  /// Itself.
  const VectorGrid* grid() const noexcept override { return this; }
  /// True.
  bool is_grid() const noexcept override { return true; }
  /// Linear, or cubic where it was made so.
  Interpolation interpolation() const noexcept { return halo_ ? Interpolation::cubic : Interpolation::linear; }
  /// As in ScalarGrid. A line field's axes are mixed linearly either way (line_axis.h).
  Result<std::shared_ptr<const VectorGrid>> as_cubic() const;
  /// Reads trilinearly.
  std::shared_ptr<const VectorGrid> as_linear() const;
  /// As in ScalarGrid.
  const CubicSamples<3>* cubic_samples(const Index3& base, Cursor& cursor) const noexcept;
  /// Of voxels, mask and ghosts.
  std::size_t bytes() const noexcept override;

  /// As in ScalarGrid.
  VectorCell cell(const Index3& base, Cursor& cursor) const noexcept;
  /// As in ScalarGrid.
  Index3 cell_base(const Vec3& index) const noexcept;
  /// Of all its voxels, taken when it was made.
  const GridStats& stats() const { return stats_; }
  /// As in ScalarGrid.
  bool has_mask() const;
  /// The least and the greatest length, as ScalarGrid's min_value() and max_value().
  double min_magnitude() const noexcept;
  /// As min_magnitude() the least.
  double max_magnitude() const noexcept;
  /// As in ScalarGrid, three floats a voxel.
  void read_block(const Index3& origin, const Index3& size, std::span<float> xyz_out) const;
  const Storage& storage() const { return *storage_; }  ///< opaque outside this room

 private:
  std::shared_ptr<const Storage> storage_;
  GridStats stats_;
  std::shared_ptr<const Halo> halo_;  ///< of a cubic grid
};

/// Grids made in memory: values by voxel, x fastest, over `size` voxels from index (0, 0, 0). `valid` (optional) by voxel.
/// `cells` (optional, beside `valid`) by cell, at the number of the voxel at its base: 0 makes a cell with valid corners invalid.
/// Voxels whose value is not finite are kept and counted.
std::shared_ptr<const ScalarGrid> make_scalar_grid(std::string name, const Mapping& mapping, const Index3& size,
                                                   std::span<const float> values, std::span<const std::uint8_t> valid = {},
                                                   std::span<const std::uint8_t> cells = {});
/// The same of vectors, three floats a voxel in world axes.
std::shared_ptr<const VectorGrid> make_vector_grid(std::string name, const Mapping& mapping, const Index3& size, std::span<const float> xyz,
                                                   std::span<const std::uint8_t> valid = {}, std::span<const std::uint8_t> cells = {});

/// Samples any field at `resolution` nodes an axis, both ends included, over the cube lo..hi (the grid `generate` writes).
std::shared_ptr<const ScalarGrid> sample_on_grid(const ScalarField& field, int resolution, double lo, double hi);
/// The same of vectors.
std::shared_ptr<const VectorGrid> sample_on_grid(const VectorField& field, int resolution, double lo, double hi);
/// The same for what a user asks for: an error where the samples hold nothing (too coarse for the field's domain) or do not
/// fit into 32-bit floats.
Result<AnyField> try_sample_on_grid(const AnyField& field, int resolution, double lo, double hi);

}  // namespace catena::field
