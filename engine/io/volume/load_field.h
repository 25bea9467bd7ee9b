/// Reading and writing of fields: .vdb (float, half, double, integer scalars; 3-vectors), .nii and .nii.gz, .raw.
/// Every failure is one sentence that names the file, what is wrong and what was expected. .vdb files are read and written by programs of
/// their own, catena-read and catena-write (engine/io/vdb): a damaged file ends the reader, not the program that asked for it. Nothing is
/// allocated on the word of a header beyond what engine/base/memory_limit.h allows.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/display_range.h"
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"

namespace catena::field {

/// What a .raw file does not say of itself.
struct RawLayout {
  Index3 shape{0, 0, 0};         ///< voxels along x, y, z
  Vec3 spacing{1.0};             ///< world units a voxel
  Vec3 origin{0.0};              ///< world place of voxel (0, 0, 0)
  std::string type = "float32";  ///< float32 float64 uint8 int8 uint16 int16 uint32 int32; little-endian, x fastest; "float32x3" a vector
  bool operator==(const RawLayout&) const = default;
};

/// Which grid of which file, and how it is to be read.
struct LoadRequest {
  std::string path;                                     ///< the file, or a folder of DICOM images
  std::string grid;                                     ///< empty: the only usable grid of the file, or an error that lists them
  std::optional<std::string> mask_grid = "valid";       ///< nullopt: no mask ("valid": null); a missing default mask is fine
  bool mask_required = false;                           ///< the user named the mask: it must exist
  std::int32_t step = 0;                                ///< which of the file's steps in time, from 0
  bool axes_xyz = false;                                ///< .npy, .npz: the first index is x, not z
  Vec3 spacing{1.0}, origin{0.0};                       ///< .npy, .npz
  std::optional<RawLayout> raw;                         ///< for .raw
  Interpolation interpolation = Interpolation::linear;  ///< of a scalar grid; nearest: of scalar grids only
  std::optional<Box> crop;                              ///< world: only the voxels that it needs (crop.h)
  std::int32_t level = 0;                               ///< of detail (level.h); 0: as it is in the file
  bool operator==(const LoadRequest&) const = default;
};

/// Loads one grid (and its mask), nothing else of the file.
Result<AnyField> load(const LoadRequest& request);

/// Voxels an axis: a file's indices may be farther apart than an index can say.
struct Size3 {
  std::int64_t x = 0, y = 0, z = 0;  ///< along x, y, z
  Size3() = default;
  /// From three counts.
  Size3(std::int64_t nx, std::int64_t ny, std::int64_t nz) : x(nx), y(ny), z(nz) {}
  /// From an index's three counts.
  Size3(const Index3& n) : x(n.x), y(n.y), z(n.z) {}
  bool operator==(const Size3&) const = default;
};

/// What values belong to: a grid's voxels, or the points or cells of a mesh that a grid is resampled from.
enum class ElementKind : std::uint8_t { voxels, points, cells };
/// "voxels", "points" or "cells".
std::string_view to_string(ElementKind counted);

/// What a file says of one of its grids, without loading it.
struct GridInfo {
  std::string name, type;                          ///< type as the file says: float, half, vec3s, bool, ...
  Size3 size;                                      ///< voxels along x, y, z
  Index3 first_index{0, 0, 0};                     ///< index of the first voxel
  Mapping mapping;                                 ///< world from index
  GridStats stats;                                 ///< active_voxels: how many of what is counted
  DisplayRange display_range;                      ///< of a usable grid (display_range.h)
  ElementKind element_kind = ElementKind::voxels;  ///< what size and active_voxels count
  std::size_t bytes = 0;                           ///< in memory, as NanoVDB
  bool is_usable = false;                          ///< Catena can load it as a field
  bool is_vector = false;                          ///< Vectors of three components.
  std::string series_number;                       ///< of a DICOM series, by which --grid finds it, too; empty: none
  std::int32_t image_count = 0;                    ///< that a DICOM volume was made of; 0: not counted
};
/// Describes every grid of a file, as it is at a step in time.
Result<std::vector<GridInfo>> describe_grids(const std::string& path, int step = 0);

/// What of a file of the program catena-read-vtk is drawn as it lies, beside points.
struct PrimitiveKinds {
  bool triangles = false, lines = false;  ///< which of them there are
};
/// Empty where the file cannot be read.
std::optional<PrimitiveKinds> read_primitive_kinds(const std::string& path);

/// The times of the steps that a file of the program catena-read-vtk states; empty: none, or it is another file.
std::vector<double> read_times(const std::string& path);

/// Writes grids to a .vdb through a temporary file beside it, renamed when complete: nothing half-written stays behind.
struct NamedGrid {
  AnyField field;    ///< grids only
  std::string name;  ///< of the grid in the file
};
/// Writes the grids. An error names the file; what was there stays then.
Outcome write_vdb(const std::string& path, const std::vector<NamedGrid>& items);

/// Reads one grid and writes it to a .vdb; raw and NIfTI files layer by layer, without a grid in this process's memory. Returns the grid's
/// name in the output: `name`, else its own, else the file's.
Result<std::string> import_as_vdb(const LoadRequest& request, const std::string& path, const std::string& name);

/// Called about once a second while a file is read by another program, with the seconds so far, and once with `ended`. Any thread.
using ReadProgress = std::function<void(const std::string& path, double seconds, bool ended)>;
/// Once, before anything is read.
void set_read_progress(ReadProgress called);

/// Counts of what was really loaded, so that a test can show that only what the scene names is.
struct LoadCounters {
  std::uint64_t files = 0, grids = 0;  ///< fields
  std::uint64_t masks = 0;             ///< `valid` grids read along with them
};
/// Since the program began. Any thread.
LoadCounters load_counters();

}  // namespace catena::field
