// SPDX-License-Identifier: MIT
/// Protocol between catena and its reader processes, catena-read (.vdb, .npy) and catena-read-vtk (formats of VTK and ITK).
/// Private to this module, to engine/io/sandbox, engine/io/vdb and engine/io/vtk, and to the users of geometry (engine/geometry/mesh). Both
/// sides map one shared memory file:
///   catena writes       the header (with the offset of the request), then the request
///   the reader writes   buffers (each at a multiple of kBufferAlignment), the response, and last the header (with its offset)
/// Decoding checks bounds only; the contents are untrusted: see validate_nano and load_vdb.cpp.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/input_files.h"
#include "engine/io/volume/load_field.h"

namespace catena::field {

inline constexpr std::uint64_t kProtocolMagic = 0x31615644'6e746143;  // "CatnDVa1"
inline constexpr std::uint32_t kProtocolVersion = 5;
/// Name of the .vdb grid that masks cells, in addition to "valid": true at the base voxel of each valid cell.
inline constexpr std::string_view kCellMaskName = "valid_cells";
/// Alignment of the buffers in the shared memory file, bytes.
inline constexpr std::uint64_t kBufferAlignment = 4096;

/// Progress of a reader, or the system resource that it could not get. Written immediately, so that it is known even when the reader
/// crashes.
enum class ReaderState : std::uint32_t {
  not_started,  ///< The request has not been read: the program could not be loaded.
  /// The request has been read; no failure so far.
  reading,
  no_memory,       ///< An allocation failed.
  no_thread,       ///< A thread could not be started.
  no_stack,        ///< A thread could not be started for lack of memory for its stack.
  out_of_space,    ///< The shared memory file could not grow.
  refused_memory,  ///< The file needs more memory than the limit allows.
};

/// Header at the start of the shared memory file.
struct MessageHeader {
  std::uint64_t magic = kProtocolMagic;
  std::uint32_t version = kProtocolVersion;
  std::uint32_t from_reader = 0;  ///< 0: a request follows; 1: a response.
  /// Position and size of the message in the shared memory file.
  std::uint64_t offset = 0, bytes = 0;
  ReaderState state = ReaderState::not_started;
  std::uint32_t limit_is_address_space = 0;  ///< Request only; 1: its memory limit is the address-space limit (ulimit -v).
};

/// Kind of request. load: one grid. describe: the list of grids. metadata: only the part that every response has. geometry: triangles,
/// lines and points in the file.
enum class ReadMode : std::uint8_t { load, describe, metadata, geometry };

/// Request to a reader.
struct ReadRequest {
  ReadMode mode = ReadMode::load;
  LoadRequest load_request;  ///< Without the layout of raw files.
  /// Memory limit of the reader, bytes.
  std::uint64_t memory_bytes = 0;
  std::uint64_t user_memory_limit = 0;  ///< Limit given by the user (--memory), bytes; 0: none.
  /// CPU time limit, seconds.
  std::uint64_t cpu_s = 0;
};

/// A byte range in the shared memory file.
struct BufferRange {
  std::uint64_t offset = 0, bytes = 0;
};

/// Sandbox features in effect in the reader.
struct SandboxStatus {
  std::uint32_t landlock_version = 0;  ///< 0: not supported by this kernel.
  bool seccomp = false;
};

/// A dense array of voxels, x fastest.
struct DenseResponse {
  Size3 size;                   ///< Voxels per axis; x = 0: no array.
  std::int32_t components = 1;  ///< 1 or 3, interleaved per voxel.
  std::string type;             ///< Number type in the file: "float64", "int16".
  BufferRange values;           ///< 32-bit floats.
  BufferRange valid;            ///< One byte per voxel, 0 or 1; empty: all voxels are valid.
  BufferRange cells{};          ///< In addition to `valid`: one byte per voxel, 0: the cell based there is not valid; empty: no cell mask.
  bool has_range = false;       ///< The values were resampled: `range` is that of the original data.
  DisplayRange range;           ///< Display range of the data; of vectors: of their lengths.
};

/// Triangles, lines and points in the file. Point indices are 32-bit.
struct GeometryResponse {
  BufferRange points;        ///< Three doubles per point.
  BufferRange triangles;     ///< Three point indices per triangle.
  BufferRange lines;         ///< Point indices, line after line.
  BufferRange line_ends;     ///< 64-bit; for each line one past its last position in `lines`.
  BufferRange loose_points;  ///< Indices of points that are on no triangle and no line.
  std::string value_name;    ///< Name of the point array in `values`; empty: none.
  BufferRange values;        ///< One 32-bit float per point.
};

/// Text metadata of a grid that may name units, and whether the grid is declared a level set.
struct GridMetadata {
  std::string name, unit, unit_length;
  bool is_level_set = false;
};

/// Response of a reader.
struct ReadResponse {
  std::string error;  ///< Complete message; not empty: the other fields are meaningless.
  // load
  std::string name;
  bool is_vector = false, has_mask = false, has_cell_mask = false;
  Mapping mapping;
  BufferRange values, valid_voxels, valid_cells;
  // describe
  std::vector<GridInfo> grids;
  // from catena-read-vtk
  DenseResponse dense;
  GeometryResponse geometry;
  std::vector<std::string> notes;  ///< Differences between the data and the file: messages without a final period.
  std::vector<double> times;       ///< Times of the file's steps; empty: none.
  std::string time_unit;           ///< Unit of `times`; empty: not specified.
  // always
  std::string units, unit_length;  ///< Units of the file.
  bool is_patient_space = false;   ///< World coordinates are in patient space (engine/io/volume/units.h).
  std::vector<GridMetadata> grid_metadata;
  PrimitiveKinds primitives;  ///< Kinds of primitives in the file, whether returned or not.
  SandboxStatus sandbox;
  std::vector<FileId> opened_files;  ///< Data files that were opened, also in case of an error.
  std::int64_t newest_mtime_ns = 0;  ///< Latest modification time of `opened_files`, ns since 1970; 0: unknown.
};

/// Encodes a message; the result is written at MessageHeader::offset.
std::string encode(const ReadRequest& request);
std::string encode(const ReadResponse& reply);
/// Decodes a message and checks its bounds. Returns an Error with a message fragment.
Result<ReadRequest> decode_request(std::span<const std::byte> bytes);
Result<ReadResponse> decode_response(std::span<const std::byte> bytes);

}  // namespace catena::field
