// SPDX-License-Identifier: MIT
/// Fields sampled on a grid. The NanoVDB buffer on the CPU is the authoritative copy; a GPU-resident copy is made from it and can be
/// discarded at any time. NanoVDB and OpenVDB are used in the private headers and .cpp files of this module only.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/field/cubic.h"
#include "engine/field/field.h"

namespace catena::field {

/// Counts and ranges over the active voxels of a grid.
struct GridStats {
  std::uint64_t active_voxels = 0;              ///< number of active (and valid) voxels
  std::uint64_t nan_count = 0;                  ///< number of active voxels with a NaN or an infinity
  double min = 0, max = 0;                      ///< scalar grids: values; vector grids: magnitudes (finite ones only)
  Vec3 component_min{0.0}, component_max{0.0};  ///< vector grids: range of each component, finite values only
};

/// Scalar grid: immutable and shared; every const function may be called from any thread.
class CATENA_EXPORT ScalarGrid final : public CellField {
 public:
  struct Storage;  ///< NanoVDB buffers
  struct Halo;     ///< halo samples of a cubic grid
  ScalarGrid(std::string name, const Mapping& mapping, const Box& index_box, std::shared_ptr<const Storage> storage, const GridStats& stats,
             Interpolation interpolation = Interpolation::linear, std::shared_ptr<const Halo> ghosts = {});
  ~ScalarGrid() override;

  /// Samples with the interpolation of the grid.
  ScalarSample sample(const Vec3& world, Cursor& cursor) const noexcept override;
  SampleStatus status_outside(const Vec3& world, Cursor& cursor) const noexcept override;
  /// Minimum as in ScalarField; for resampled data see max_value().
  double min_value() const noexcept override;
  /// Maximum as in ScalarField. For data that were resampled (engine/io/vtk/resample.h) min_value() and max_value() are the range of the
  /// file's own values, which the voxels, and stats(), may exceed.
  double max_value() const noexcept override;
  /// Returns this grid.
  const ScalarGrid* grid() const noexcept override { return this; }
  /// Returns the interpolation between voxel centers. It is fixed; as_cubic(), as_linear() and with_interpolation() return another grid.
  Interpolation interpolation() const noexcept override { return interpolation_; }
  /// Returns the memory of voxels, mask and halo samples in bytes.
  std::size_t bytes() const noexcept override;
  /// Returns a grid that shares the voxels, has cubic interpolation and its own version. Error (a message fragment): there is no memory for
  /// its halo samples, or the grid is too large for them.
  Result<std::shared_ptr<const ScalarGrid>> as_cubic() const;
  /// Returns a grid that shares the voxels and has trilinear interpolation.
  std::shared_ptr<const ScalarGrid> as_linear() const { return with_interpolation(Interpolation::linear); }
  /// Returns a grid that shares the voxels, with linear or nearest interpolation; Interpolation::cubic is a bug here.
  std::shared_ptr<const ScalarGrid> with_interpolation(Interpolation linear_or_nearest) const;
  /// Returns a grid that shares the voxels at another position.
  std::shared_ptr<const ScalarGrid> with_mapping(const Mapping& mapping) const;
  /// Returns the samples of a valid cell of a cubic grid; null for an invalid cell or base, or another interpolation. Valid until the
  /// cursor's next use.
  const CubicSamples<1>* cubic_samples(const Index3& base, Cursor& cursor) const noexcept;

  /// Returns the cell at `base`, clamped such that base and base + 1 are in the index box.
  ScalarCell cell(const Index3& base, Cursor& cursor) const noexcept override;
  Index3 cell_base(const Vec3& index) const noexcept override;
  const ScalarGrid& resident_grid() const noexcept override { return *this; }
  /// Returns the statistics of all voxels, computed when the grid was made.
  const GridStats& stats() const { return stats_; }
  /// Returns the value of voxels that the tree does not contain.
  float background() const;
  /// Returns true when cells may be invalid: the grid has a mask, or values that are not finite.
  bool has_mask() const;
  /// Returns true when cells may be invalid although all their corners are valid: the mask was given by cells and cannot be expressed by
  /// voxels.
  bool has_cell_mask() const;
  /// Copies `size` voxels starting at `origin` to `out` (x fastest); voxels outside of the tree give the background. A cubic grid gives its
  /// halo samples in place of missing samples.
  void read_block(const Index3& origin, const Index3& size, std::span<float> out) const;
  /// Writes 1 where the cell based at a voxel is valid (always inside of the box of a grid without a mask), else 0.
  void read_cell_validity(const Index3& origin, const Index3& size, std::span<std::uint8_t> out) const;
  /// Returns true when the 8^3 block at `origin` (a multiple of 8) has a single value and no leaf in the tree; sets `value`.
  bool is_constant_block(const Index3& origin, float& value) const;
  /// Returns the buffers; opaque outside of this module.
  const Storage& storage() const { return *storage_; }

 private:
  std::shared_ptr<const Storage> storage_;
  GridStats stats_;
  Interpolation interpolation_;
  std::shared_ptr<const Halo> halo_;  ///< set for a cubic grid
};

/// Vector grid: immutable and shared; every const function may be called from any thread.
class CATENA_EXPORT VectorGrid final : public VectorField {
 public:
  struct Storage;
  struct Halo;
  /// Makes a grid from NanoVDB buffers. Applications use make_vector_grid() or the loaders instead.
  VectorGrid(std::string name, const Mapping& mapping, const Box& index_box, std::shared_ptr<const Storage> storage, const GridStats& stats,
             std::shared_ptr<const Halo> ghosts = {});
  ~VectorGrid() override;

  /// Samples with the interpolation of the grid.
  VectorSample sample(const Vec3& world, Cursor& cursor) const noexcept override;
  LineSample sample_line(const Vec3& world, Cursor& cursor) const noexcept override;
  SampleStatus status_outside(const Vec3& world, Cursor& cursor) const noexcept override;
  /// Returns this grid.
  const VectorGrid* grid() const noexcept override { return this; }
  /// Returns true.
  bool is_grid() const noexcept override { return true; }
  /// Returns linear or cubic.
  Interpolation interpolation() const noexcept { return halo_ ? Interpolation::cubic : Interpolation::linear; }
  /// Returns a grid that shares the voxels and has cubic interpolation; errors as for ScalarGrid::as_cubic(). The axes of a line field are
  /// interpolated linearly in either case (line_field.h).
  Result<std::shared_ptr<const VectorGrid>> as_cubic() const;
  /// Returns a grid that shares the voxels and has trilinear interpolation.
  std::shared_ptr<const VectorGrid> as_linear() const;
  /// Returns the samples of a valid cell of a cubic grid; null as for ScalarGrid::cubic_samples().
  const CubicSamples<3>* cubic_samples(const Index3& base, Cursor& cursor) const noexcept;
  /// Returns the memory of voxels, mask and halo samples in bytes.
  std::size_t bytes() const noexcept override;

  /// Returns the cell at `base`, clamped such that base and base + 1 are in the index box.
  VectorCell cell(const Index3& base, Cursor& cursor) const noexcept;
  /// Returns the base voxel of the cell that contains an index position, clamped to valid bases.
  Index3 cell_base(const Vec3& index) const noexcept;
  /// Returns the statistics of all voxels, computed when the grid was made.
  const GridStats& stats() const { return stats_; }
  /// Returns true when cells may be invalid: the grid has a mask, or values that are not finite.
  bool has_mask() const;
  /// Returns the smallest magnitude, by the rules of ScalarGrid::min_value() and max_value().
  double min_magnitude() const noexcept;
  /// Returns the largest magnitude.
  double max_magnitude() const noexcept;
  /// Copies voxels as ScalarGrid::read_block() does, with three floats per voxel.
  void read_block(const Index3& origin, const Index3& size, std::span<float> xyz_out) const;
  /// Returns the buffers; opaque outside of this module.
  const Storage& storage() const { return *storage_; }

 private:
  std::shared_ptr<const Storage> storage_;
  GridStats stats_;
  std::shared_ptr<const Halo> halo_;  ///< set for a cubic grid
};

/// Makes a grid from values in memory, by voxel, x fastest, for `size` voxels from index (0, 0, 0). `valid` (optional): 0 marks an invalid
/// voxel. `cells` (optional, only with `valid`): one entry per cell, at the index of its base voxel; 0 makes a cell with valid corners
/// invalid. Values that are not finite are stored and counted. A grid without a usable value is a bug and aborts.
CATENA_EXPORT std::shared_ptr<const ScalarGrid> make_scalar_grid(std::string name, const Mapping& mapping, const Index3& size,
                                                                 std::span<const float> values, std::span<const std::uint8_t> valid = {},
                                                                 std::span<const std::uint8_t> cells = {});
/// Makes a vector grid from values in memory, by the rules of make_scalar_grid(). `xyz`: three floats per voxel, in world axes.
CATENA_EXPORT std::shared_ptr<const VectorGrid> make_vector_grid(std::string name, const Mapping& mapping, const Index3& size,
                                                                 std::span<const float> xyz, std::span<const std::uint8_t> valid = {},
                                                                 std::span<const std::uint8_t> cells = {});

/// Samples a field at `resolution` nodes along each axis, both ends included, over the cube lo..hi in world units (the grid that `generate`
/// writes). Nodes where the field is not inside are invalid. Aborts on an unusable request: see try_sample_on_grid(), if it can be
/// unusable.
CATENA_EXPORT std::shared_ptr<const ScalarGrid> sample_on_grid(const ScalarField& field, int resolution, double lo, double hi);
/// Samples a vector field at nodes, by the rules of the function for scalar fields above.
CATENA_EXPORT std::shared_ptr<const VectorGrid> sample_on_grid(const VectorField& field, int resolution, double lo, double hi);
/// Samples a field at nodes as sample_on_grid() does, but checks the request. Error: no node is inside (the sampling is too coarse for the
/// field's domain), a sample does not fit into a 32-bit float, the box is not usable, or the memory budget is exceeded.
CATENA_EXPORT Result<AnyField> try_sample_on_grid(const AnyField& field, int resolution, double lo, double hi);

}  // namespace catena::field
