// SPDX-License-Identifier: MIT
/// Reading and writing of fields (formats: formats.h; in .vdb: float, half, double and integer scalars, and 3-vectors). Every Error is one
/// complete message that names the file, the problem and what was expected. .vdb files are read and written by separate processes,
/// catena-read and catena-write (engine/io/vdb): a damaged file crashes the reader, not the calling program. No header makes a reader
/// allocate more than engine/base/memory_limit.h allows.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/affine.h"
#include "engine/base/display_range.h"
#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"

namespace catena::field {

/// Layout of a .raw file, which has no header.
struct RawLayout {
  Index3 shape{0, 0, 0};  ///< Voxels along x, y, z.
  Vec3 spacing{1.0};      ///< World units per voxel.
  Vec3 origin{0.0};       ///< World position of voxel (0, 0, 0).
  /// float32 float64 uint8 int8 uint16 int16 uint32 int32; little-endian, x fastest; with the suffix "x3", as in "float32x3", a vector.
  std::string type = "float32";
  bool operator==(const RawLayout&) const = default;
};

/// Transform of a field to another position (transform.h).
struct FieldTransform {
  AffineMap map;                ///< World positions of the file to those of the scene; with a reference image the matrix of flirt.
  std::string flirt_reference;  ///< Reference image of a matrix of flirt; empty: `map` is between world positions.
  bool operator==(const FieldTransform&) const = default;
};

/// Request to load a grid of a file, with the parameters of loading.
struct LoadRequest {
  std::string path;                                ///< File, or a folder of DICOM images.
  std::string grid;                                ///< Empty: the only usable grid of the file; if there are several, an Error lists them.
  std::optional<std::string> mask_grid = "valid";  ///< Nullopt: no mask ("valid": null in a scene). The default mask may be missing.
  bool mask_required = false;                      ///< The mask was named explicitly: it must exist.
  std::int32_t step = 0;                           ///< Time step in the file, from 0.
  bool axes_xyz = false;                           ///< For .npy, .npz: the first index is x, not z.
  Vec3 spacing{1.0}, origin{0.0};                  ///< For .npy, .npz: world units per voxel, and world position of voxel (0, 0, 0).
  std::optional<RawLayout> raw;                    ///< For .raw.
  Interpolation interpolation = Interpolation::linear;  ///< Interpolation of the grid; nearest: scalar grids only.
  std::optional<FieldTransform> transform;              ///< Applied before `crop`; nullopt: the position that the file states.
  std::optional<Box> crop;                              ///< World box: load only the voxels that it needs (crop.h).
  std::int32_t level = 0;                               ///< Resolution level (downsample.h); 0: full resolution.
  bool operator==(const LoadRequest&) const = default;
};

/// Loads one grid (and its mask), nothing else of the file. Any thread; blocks.
CATENA_EXPORT Result<AnyField> load(const LoadRequest& request);

/// Voxels per axis, 64-bit: the index range in a file may exceed 32 bits.
struct Size3 {
  std::int64_t x = 0, y = 0, z = 0;  ///< Voxels along x, y, z.
  Size3() = default;
  /// Creates a size from three counts.
  Size3(std::int64_t nx, std::int64_t ny, std::int64_t nz) : x(nx), y(ny), z(nz) {}
  /// Converts a 32-bit size.
  Size3(const Index3& n) : x(n.x), y(n.y), z(n.z) {}
  bool operator==(const Size3&) const = default;
};

/// Kind of the elements to which the values of a grid belong: its voxels, or the points or cells of a mesh from which it is resampled.
enum class ElementKind : std::uint8_t { voxels, points, cells };
/// Returns "voxels", "points" or "cells".
CATENA_EXPORT std::string_view to_string(ElementKind counted);

/// A resolution level of a grid in a store of chunks.
struct LevelInfo {
  Size3 size;   ///< Voxels along x, y, z.
  Size3 chunk;  ///< Voxels that are stored together.
};

/// Description of a grid in a file, without loading it.
struct GridInfo {
  std::string name, type;                          ///< Type as named in the file: float, half, vec3s, bool, ...
  Size3 size;                                      ///< Voxels along x, y, z.
  Index3 first_index{0, 0, 0};                     ///< Index of the first voxel.
  Mapping mapping;                                 ///< World from index.
  GridStats stats;                                 ///< Value statistics; active_voxels counts elements of `element_kind`.
  DisplayRange display_range;                      ///< Display range of a usable grid (display_range.h).
  ElementKind element_kind = ElementKind::voxels;  ///< Elements that `size` and `active_voxels` count.
  std::size_t bytes = 0;                           ///< Size in memory as NanoVDB, bytes.
  bool is_usable = false;                          ///< Can be loaded as a field.
  bool is_vector = false;                          ///< Vectors with three components.
  std::string series_number;                       ///< Number of a DICOM series, which --grid accepts, too; empty: none.
  std::int32_t image_count = 0;                    ///< Number of images in a DICOM volume; 0: not counted.
  std::vector<LevelInfo> levels;                   ///< Levels of a store of chunks, the finest first; empty: another file.
  std::int32_t range_level = 0;                    ///< Level of which `stats` and `display_range` are; -1: they are not known.
  std::vector<double> window;                      ///< Range to display that the file states, two numbers; empty: none.
  std::int32_t color = -1;                         ///< Color that the file states, 0xRRGGBB; -1: none.
};
/// Describes every grid of a file, at a time step.
CATENA_EXPORT Result<std::vector<GridInfo>> describe_grids(const std::string& path, int step = 0);

/// Kinds of geometry, besides points, in a file read by catena-read-vtk.
struct PrimitiveKinds {
  bool triangles = false, lines = false;  ///< True: the file has triangles, or lines.
};
/// Returns nullopt when the file cannot be read.
CATENA_EXPORT std::optional<PrimitiveKinds> read_primitive_kinds(const std::string& path);

/// Times of the steps in a file read by catena-read-vtk; empty: none, a file of another format, or one that cannot be read.
CATENA_EXPORT std::vector<double> read_times(const std::string& path);

/// A grid to be written to a .vdb.
struct NamedGrid {
  AnyField field;    ///< A grid (not an analytic field).
  std::string name;  ///< Name of the grid in the file.
};
/// Writes grids to a .vdb through a temporary file, renamed when it is complete: the write is atomic. An Error names the file; an
/// existing file is then unchanged.
CATENA_EXPORT Outcome write_vdb(const std::string& path, const std::vector<NamedGrid>& items);

/// Converts one grid to a .vdb; raw and NIfTI files slice by slice, without a grid in the memory of this process. Returns the name of the
/// grid in the output: `name`, else its own, else the file's.
CATENA_EXPORT Result<std::string> import_as_vdb(const LoadRequest& request, const std::string& path, const std::string& name);

/// Called about once a second while a reader process reads a file, with the seconds elapsed, and a last time with `ended`. Any thread.
using ReadProgress = std::function<void(const std::string& path, double seconds, bool ended)>;
/// Sets the callback. Call it once, before anything is read.
CATENA_EXPORT void set_read_progress(ReadProgress callback);

/// Counts of loaded objects, with which tests show that only the objects that the scene names are loaded.
struct LoadCounters {
  std::uint64_t files = 0, grids = 0;  ///< Files and fields loaded.
  std::uint64_t masks = 0;             ///< `valid` grids loaded with them.
};
/// Counts since program start. Any thread.
CATENA_EXPORT LoadCounters load_counters();

}  // namespace catena::field
