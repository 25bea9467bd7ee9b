/// Fields: immutable, versioned, in world coordinates and double precision. Grids and analytic fields serve one interface, so
/// that every algorithm can be tested against closed forms. One fetch (= one evaluation) gives the value and, for scalars,
/// the analytic gradient: of the trilinear or cubic cell on grids, of the formula on analytic fields.
/// Threads: any number at once, each with its own Cursor. No allocation, lock or throw in any const noexcept function.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/sample_status.h"
#include "engine/base/vec.h"
#include "engine/field/cell.h"
#include "engine/field/line_field.h"
#include "engine/field/mapping.h"

namespace catena::field {

/// Where a walk remembers the nodes it last touched. Plain bytes, one per walk and thread; never changes a result.
/// Zero-initialised it belongs to no grid; a fetch from another grid than the last starts it anew.
struct Cursor {
  const void* owner = nullptr;  ///< the grid that the bytes are about; null: none yet
  /// The grid's own, meaningless to anybody else.
  alignas(16) std::byte memory[1280]{};
};

/// What one fetch of a scalar field gives.
struct ScalarSample {
  double value = 0;     ///< the field's own unit
  Vec3 gradient{0.0};   ///< world units
  bool inside = false;  ///< within the domain (and the valid mask); outside, value and gradient extend the nearest cell or formula
};

/// What one fetch of a vector field gives.
struct VectorSample {
  Vec3 value{0.0};      ///< components in world axes
  bool inside = false;  ///< as in ScalarSample
};

/// A vector field read as a line field, where v and -v mean the same (line_axis.h).
struct LineSample : LineAxis {
  bool inside = false;  ///< as in ScalarSample
};

/// How a grid says what lies between its voxel centres.
///   linear    trilinear in the cell of eight centres
///   nearest   the value of the nearest centre (of two as near, the one of the greater index), never a mix; its gradient is 0
///   cubic     of 4 x 4 x 4 centres: smooth (C1) from cell to cell (cubic.h)
/// The domain is the box of voxel centres, less cells with a missing corner, every time.
enum class Interpolation { linear, nearest, cubic };

/// What scalar and vector fields share: a name, a version, and where in the world they lie.
class Field {
 public:
  virtual ~Field() = default;
  Field() = default;
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;

  const std::string& name() const { return name_; }   ///< the grid's or the formula's name
  std::uint64_t version() const { return version_; }  ///< unique in the process; the key of mirrors
  /// World from index; the identity of a formula.
  const Mapping& mapping() const { return mapping_; }
  const Box& index_box() const { return index_box_; }                                ///< of voxel centres; no grid: of the domain, world
  Vec3 corner(int i) const { return world_corner(mapping_, index_box_, i); }         ///< of the domain, world: i + 2 j + 4 k by index
  Bounds world_bounds() const { return field::world_bounds(mapping_, index_box_); }  ///< of all eight
  double domain_length() const { return domain_length_; }    ///< L: the longest edge of the domain box, world units; 4 for make_analytic()
  double max_voxel_edge() const { return max_voxel_edge_; }  ///< of a voxel, world units; no grid: 1
  /// Whether it is sampled on a grid (then grid() gives it) rather than a formula or a function.
  virtual bool is_grid() const noexcept { return false; }
  /// Memory that it holds, bytes; 0 of a formula.
  virtual std::size_t bytes() const noexcept { return 0; }
  /// Why a sample at this place is not inside: box, mask or not_finite; none where it is. Here: a formula, which has no box.
  virtual SampleStatus status_outside(const Vec3& world, Cursor& cursor) const noexcept;

 protected:
  /// For classes that derive from it: their constructor calls it once.
  void set_domain(std::string name, const Mapping& mapping, const Box& index_box);

 private:
  std::string name_;
  std::uint64_t version_ = 0;
  Mapping mapping_;
  Box index_box_;
  double domain_length_ = 0, max_voxel_edge_ = 0;
};

class ScalarGrid;
class VectorGrid;

/// A number at every place. Values have the unit of the data; places are world units.
class ScalarField : public Field {
 public:
  /// Value and gradient at a place: one evaluation. Any thread, each with a Cursor of its own; no allocation, lock or throw.
  virtual ScalarSample sample(const Vec3& world, Cursor& cursor) const noexcept = 0;
  /// The values that the field attains: of the active (and valid) voxels; of the formula, over all space (may be infinite).
  virtual double min_value() const noexcept = 0;
  /// The greatest value, as min_value() the least.
  virtual double max_value() const noexcept = 0;
  /// The grid, where it is one; else null.
  virtual const ScalarGrid* grid() const noexcept { return nullptr; }
  /// How it reads between voxel centres; a formula is exact and says linear.
  virtual Interpolation interpolation() const noexcept { return Interpolation::linear; }
};

/// An arrow at every place, in world axes.
class VectorField : public Field {
 public:
  /// The vector at a place: one evaluation. Any thread, each with a Cursor of its own; no allocation, lock or throw.
  virtual VectorSample sample(const Vec3& world, Cursor& cursor) const noexcept = 0;
  /// The same place read as a line field. Formulas: the value's axis, coherent wherever it is not zero.
  virtual LineSample sample_line(const Vec3& world, Cursor& cursor) const noexcept;
  /// The grid, where it is one; else null.
  virtual const VectorGrid* grid() const noexcept { return nullptr; }
};

/// What to do where a field that is read by its nearest voxels cannot have a surface: empty for other fields.
std::string no_surface_hint(const ScalarField& field, const std::string& name);

/// Fields are shared and never change.
using ScalarFieldPtr = std::shared_ptr<const ScalarField>;
/// Fields are shared and never change.
using VectorFieldPtr = std::shared_ptr<const VectorField>;

/// Either kind; exactly one is set.
struct AnyField {
  ScalarFieldPtr scalar;             ///< set: it is a scalar field
  VectorFieldPtr vector;             ///< set: it is a vector field
  std::vector<double> times{};       ///< of the file's steps in time; one, or empty: it has one step
  std::string time_unit{};           ///< of `times`: "s", "hours since 2001-01-01"; empty: not stated
  std::int64_t newest_mtime_ns = 0;  ///< when the youngest file that was read was last changed, since 1970; 0: not known
  std::vector<std::string> notes{};  ///< what is not as it was in the file: sentences without an end
  /// What both kinds share; null where neither is set.
  const Field* get() const { return scalar ? static_cast<const Field*>(scalar.get()) : vector.get(); }
};

}  // namespace catena::field
