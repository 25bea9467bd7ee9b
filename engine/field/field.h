// SPDX-License-Identifier: MIT
/// Fields: immutable, versioned, in world coordinates and double precision. Grids and analytic fields have the same interface, so every
/// algorithm can be tested against closed forms. One fetch (= one evaluation) gives the value and, for scalar fields, the analytic
/// gradient: that of the trilinear or cubic cell on grids, that of the formula on analytic fields.
/// Threads: any number concurrently, each with its own Cursor. The const noexcept functions do not allocate, lock or throw.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/sample_status.h"
#include "engine/base/vec.h"
#include "engine/field/cell.h"
#include "engine/field/line_field.h"
#include "engine/field/mapping.h"

namespace catena::field {

class BrickSnapshot;
class PagedGrid;

/// Cell cache of a sequence of fetches: the grid nodes and the cell that were accessed last. Plain bytes, one per thread; the cache never
/// changes a result. Zero-initialized it belongs to no grid; a fetch from a different grid resets it.
/// For paged grids (engine/field/bricks/paged_grid.h) it also selects the bricks that are in memory.
struct Cursor {
  const void* owner = nullptr;  ///< the grid to which the bytes belong; null: none yet
  /// Bricks of paged grids; null: their coarse level is sampled.
  const BrickSnapshot* bricks = nullptr;
  bool is_coarse = false;                             ///< set when a fetch uses the coarse level of a paged grid; reset by the user
  std::uint64_t missing_grid = 0, missing_brick = 0;  ///< the last brick that such a fetch lacked: PagedGrid::version(), number
  /// Private data of the owner.
  alignas(16) std::byte memory[1280]{};
};

/// Sample of a scalar field.
struct ScalarSample {
  double value = 0;    ///< in the field's own unit
  Vec3 gradient{0.0};  ///< per world unit
  /// The position is inside the domain (and the mask of valid voxels). Outside, value and gradient extrapolate the nearest cell or the
  /// formula.
  bool inside = false;
};

/// Sample of a vector field.
struct VectorSample {
  Vec3 value{0.0};      ///< components in world axes
  bool inside = false;  ///< as in ScalarSample
};

/// Sample of a vector field interpreted as a line field, in which v and -v mean the same (line_field.h).
struct LineSample : LineAxis {
  bool inside = false;  ///< as in ScalarSample
};

/// Interpolation of a grid between its voxel centers. The domain is always the box of voxel centers without the cells that have an invalid
/// corner.
///   linear    trilinear in the cell of eight voxel centers
///   nearest   value of the nearest voxel center (of two equally near ones that with the larger index), never a mixture; gradient 0
///   cubic     from 4 x 4 x 4 voxel centers: smooth (C1) from cell to cell (cubic.h)
enum class Interpolation { linear, nearest, cubic };

/// Base of scalar and vector fields: name, version, and domain in the world.
class CATENA_EXPORT Field {
 public:
  virtual ~Field() = default;
  Field() = default;
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;

  const std::string& name() const { return name_; }   ///< name of the grid or formula
  std::uint64_t version() const { return version_; }  ///< unique in the process; key for GPU-resident copies
  /// Returns the map from index space to the world; the identity for a formula.
  const Mapping& mapping() const { return mapping_; }
  /// Returns the box of voxel centers, in index space; without a grid the domain, in world coordinates.
  const Box& index_box() const { return index_box_; }
  /// Returns the world position of domain corner number i + 2 j + 4 k (i, j, k along the index axes).
  Vec3 corner(int i) const { return world_corner(mapping_, index_box_, i); }
  /// Returns the world-axis-aligned box that encloses the eight corners.
  Bounds world_bounds() const { return field::world_bounds(mapping_, index_box_); }
  /// Returns L, the longest edge of the domain box, world units; 4 for make_analytic().
  double domain_length() const { return domain_length_; }
  /// Returns the longest edge of a voxel, world units; 1 without a grid.
  double max_voxel_edge() const { return max_voxel_edge_; }
  /// Returns true when the field is sampled on a grid, false for a formula or a function.
  virtual bool is_grid() const noexcept { return false; }
  /// Returns the memory of the field in bytes; 0 for a formula.
  virtual std::size_t bytes() const noexcept { return 0; }
  /// Returns why a sample at this position is not inside (outside_box, masked or not_finite), or ok when it is. The implementation here is
  /// for formulas, which have no box.
  virtual SampleStatus status_outside(const Vec3& world, Cursor& cursor) const noexcept;

 protected:
  /// Sets name, domain and a new version. To be called once by the constructor of a derived class.
  void set_domain(std::string name, const Mapping& mapping, const Box& index_box);

 private:
  std::string name_;
  std::uint64_t version_ = 0;
  Mapping mapping_;
  Box index_box_;
  double domain_length_ = 0, max_voxel_edge_ = 0;
};

class CellField;
class ScalarGrid;
class VectorGrid;

/// Scalar field. Values have the unit of the data; positions are in world units.
class CATENA_EXPORT ScalarField : public Field {
 public:
  /// Returns value and gradient at a position: one evaluation. Any thread, each with its own Cursor; no allocation, lock or throw.
  virtual ScalarSample sample(const Vec3& world, Cursor& cursor) const noexcept = 0;
  /// Returns the same without a gradient, where one takes longer.
  virtual ScalarSample sample_value(const Vec3& world, Cursor& cursor) const noexcept { return sample(world, cursor); }
  /// Returns the minimum of the field: over the active (and valid) voxels of a grid; over all space for a formula (may be -infinity).
  virtual double min_value() const noexcept = 0;
  /// Returns the maximum of the field, over the same set as min_value().
  virtual double max_value() const noexcept = 0;
  /// Returns the grid, or null when the field is not a grid that is in memory as a whole.
  virtual const ScalarGrid* grid() const noexcept { return nullptr; }
  /// Returns the field as cells, or null when it has none: a formula.
  virtual const CellField* cells() const noexcept { return nullptr; }
  /// Returns the interpolation between voxel centers; a formula is exact and returns linear.
  virtual Interpolation interpolation() const noexcept { return Interpolation::linear; }
};

/// Scalar field of voxels, in trilinear cells: a grid, of which all or some voxels are in memory. The const functions may be called from
/// any thread, each with its own Cursor; no allocation, lock or throw.
class CATENA_EXPORT CellField : public ScalarField {
 public:
  const CellField* cells() const noexcept final { return this; }
  bool is_grid() const noexcept final { return true; }
  /// Returns the cell at `base`, clamped such that base and base + 1 are in the index box.
  virtual ScalarCell cell(const Index3& base, Cursor& cursor) const noexcept = 0;
  /// Returns the base voxel of the cell that contains an index position: its floor, clamped to valid bases.
  virtual Index3 cell_base(const Vec3& index) const noexcept = 0;
  /// Returns the grid that is in memory as a whole: this one, or a coarser level of it.
  virtual const ScalarGrid& resident_grid() const noexcept = 0;
};

/// Vector field, in world axes.
class CATENA_EXPORT VectorField : public Field {
 public:
  /// Returns the vector at a position: one evaluation. Any thread, each with its own Cursor; no allocation, lock or throw.
  virtual VectorSample sample(const Vec3& world, Cursor& cursor) const noexcept = 0;
  /// Samples the field as a line field at a position. For formulas: the axis of the vector, with coherence 1 wherever it is not zero.
  virtual LineSample sample_line(const Vec3& world, Cursor& cursor) const noexcept;
  /// Returns the grid, or null when the field is not a grid.
  virtual const VectorGrid* grid() const noexcept { return nullptr; }
};

/// Returns what the user can do when a surface is requested of a field with nearest interpolation, which has none; empty for other fields.
CATENA_EXPORT std::string no_surface_hint(const ScalarField& field, const std::string& name);

/// Shared ownership of an immutable field.
using ScalarFieldPtr = std::shared_ptr<const ScalarField>;
/// Shared ownership of an immutable field.
using VectorFieldPtr = std::shared_ptr<const VectorField>;

/// A scalar or a vector field; exactly one of the two pointers is set.
struct AnyField {
  ScalarFieldPtr scalar;        ///< set for a scalar field
  VectorFieldPtr vector;        ///< set for a vector field
  std::vector<double> times{};  ///< times of the file's time steps; one entry or none: a single step
  std::string time_unit{};      ///< unit of `times`: "s", "hours since 2001-01-01"; empty: unknown
  /// Latest modification time of the files that were read, nanoseconds since 1970; 0: unknown.
  std::int64_t newest_mtime_ns = 0;
  /// Differences between the field and its file: sentences without a final period.
  std::vector<std::string> notes{};
  /// Finest level of data of which `scalar` is a coarser one, because they do not fit into memory: a PagedGrid, which haptics samples.
  /// Null: `scalar` has the full resolution, or the one that was requested.
  std::shared_ptr<const PagedGrid> paged{};
  /// Returns the common base of both kinds; null when neither is set.
  const Field* get() const { return scalar ? static_cast<const Field*>(scalar.get()) : vector.get(); }
};

}  // namespace catena::field
