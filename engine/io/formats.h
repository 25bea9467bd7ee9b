// SPDX-License-Identifier: MIT
/// Registry of file formats, by file extension (any case), used by all code that needs or prints extensions. A format is a function that
/// returns its row, in the file of its reader or writer, and one line in formats.cpp. Any thread.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/output_file.h"
#include "engine/geometry/curves/point_set.h"
#include "engine/geometry/flow/curve.h"
#include "engine/geometry/mesh/mesh.h"
#include "engine/io/volume/volume_reader.h"

namespace catena::mesh {
struct MeshExport;
}

namespace catena::io {

/// Kinds of data that a file can contain. One format may contain several.
enum class DataKind { volume, mesh, curves, points };

/// Relation of a file to other files that reading it opens.
enum class FileLayout {
  single,      ///< The file is complete.
  companions,  ///< Data files lie beside it, such as the other images of a DICOM series.
  index,       ///< A text that names the files with the data.
};

/// Writes a volume to a file.
using VolumeWriter = Outcome (*)(const std::string& path, const field::AnyField& field, const std::string& name, const field::Units& units);

/// A row of the registry: the functions that read and write a format. A null function: not supported.
struct Format {
  std::string_view name;                     ///< Name of the format, such as "NIfTI-1".
  std::vector<std::string_view> extensions;  ///< Lower case, with the dot.
  field::VolumeReader volume{};              ///< Reads volumes.
  Result<mesh::TriangleSoup> (*read_mesh)(const std::string& path, int step) = nullptr;
  Result<curves::CurveSet> (*read_curves)(const std::string& path, int step) = nullptr;
  Result<curves::PointSet> (*read_points)(const std::string& path, int step) = nullptr;
  VolumeWriter write_volume = nullptr;
  void (*write_mesh)(OutputFile& out, const mesh::MeshExport& surface) = nullptr;
  /// Writes streamlines of a field.
  void (*write_curves)(OutputFile& out, const std::vector<flow::CurvePtr>& curves, const field::VectorField& field) = nullptr;
  FileLayout layout = FileLayout::single;
  bool has_float_positions = false;  ///< Positions are written in single precision.
  bool has_cell_mask = false;        ///< Written volumes keep the cells that are masked between valid voxels.

  /// Returns whether the format is read as this kind of data.
  bool reads(DataKind kind) const;
  /// Returns whether the format is written from this kind of data.
  bool writes(DataKind kind) const;
};

/// Adds a format. Call it at startup, before any file is read.
void register_format(Format format);
/// Returns all formats, in the order of the registry.
const std::vector<Format>& formats();
/// Returns the format of a path by its extension; nullptr: none.
const Format* find_format(std::string_view path);
/// Returns the format of a path that is read as this kind of data; nullptr: none. Folders and DICOM files without an extension are
/// recognized as volumes by their contents.
const Format* find_reader(std::string_view path, DataKind kind);
/// Returns the format that a path can be written in from this kind of data; nullptr: none.
const Format* find_writer(std::string_view path, DataKind kind);

/// Returns the file extensions, such as ".vdb", that are read as this kind of data.
std::vector<std::string_view> readable_extensions(DataKind kind);
/// Returns the file extensions for output as a message fragment: ".vtp, .ply, .stl or .obj".
std::string writable_extensions(DataKind kind);

/// Returns whether the format does not state its own layout (.raw): a scene or an option has to.
bool needs_layout(std::string_view path);
/// Returns whether the file is a NumPy array (.npy, .npz), which does not state its position in the world.
bool is_numpy_file(std::string_view path);
/// Returns a message fragment that names the expected files: "a triangle mesh (.stl, .obj, ..)".
std::string describe_expected(DataKind kind);
/// Returns the file name without folder and extension.
std::string file_stem(const std::string& path);

}  // namespace catena::io
