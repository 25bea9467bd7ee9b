/// What catena and the programs that read files for it, catena-read (.vdb) and catena-read-vtk (what VTK and ITK read), tell each other.
/// Private to this room, to engine/io/sandbox, engine/io/vdb and engine/io/vtk, and to who asks for shapes (engine/geometry/mesh). Both
/// sides see one file in memory:
///   catena writes       the head (where the request is), the request
///   the reader writes   buffers (each at a multiple of kBufferAlignment), the reply, and last the head (where the reply is)
/// What is decoded is held to its bounds, but nothing in it is believed: see validate_nano and load_vdb.cpp.
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
/// Of the grid of a .vdb that masks cells, beside "valid": true at the base of each that is valid.
inline constexpr std::string_view kCellMaskName = "valid_cells";
inline constexpr std::uint64_t kBufferAlignment = 4096;

/// How far a reader has come, and what the machine did not give it. It is written as it happens, so that it is known of a reader that
/// dies, too.
enum class ReaderState : std::uint32_t {
  not_started,  ///< it has not read the request: the program could not be loaded
  reading,
  no_memory,       ///< an allocation has failed
  no_thread,       ///< a thread could not be started
  no_stack,        ///< nor could this one, for want of memory for its stack
  no_room,         ///< the file in memory could not grow
  refused_memory,  ///< the file needs more memory than it may take
};

struct MessageHeader {
  std::uint64_t magic = kProtocolMagic;
  std::uint32_t version = kProtocolVersion;
  std::uint32_t from_reader = 0;  ///< 0: a request follows; 1: a reply
  std::uint64_t offset = 0, bytes = 0;
  ReaderState state = ReaderState::not_started;
  std::uint32_t limit_is_address_space = 0;  ///< of a request: 1: its limit on memory is what ulimit -v leaves
};

/// load: one grid. describe: what there is. words: what every reply has, nothing else. shape: what is drawn as it lies, triangles, lines
/// and points.
enum class ReadMode : std::uint8_t { load, describe, metadata, geometry };

struct ReadRequest {
  ReadMode mode = ReadMode::load;
  LoadRequest load_request;  ///< without the layout of raw files
  std::uint64_t memory_bytes = 0;
  std::uint64_t user_memory_limit = 0;  ///< what the user allows (--memory), in bytes; 0: nothing is stated
  std::uint64_t cpu_s = 0;
};

struct BufferRange {
  std::uint64_t offset = 0, bytes = 0;
};

/// What the reader could shut itself into.
struct SandboxStatus {
  std::uint32_t landlock_version = 0;  ///< 0: this kernel has none
  bool seccomp = false;
};

/// NumberArray that lie in a buffer as they are, x fastest.
struct DenseResponse {
  Size3 size;                   ///< voxels an axis; x = 0: there are none
  std::int32_t components = 1;  ///< 1 or 3, one after the other
  std::string type;             ///< as the file says: "float64", "int16"
  BufferRange values;           ///< 32-bit floats
  BufferRange valid;            ///< a byte a voxel, 0 or 1; empty: all are valid
  BufferRange cells{};          ///< beside `valid`: a byte a voxel, 0 where the cell based at it is not valid; empty: no mask of cells
  bool has_range = false;       ///< the values were resampled: `range` is that of the data
  DisplayRange range;           ///< of vectors: of their lengths
};

/// What is drawn as it lies. NumberArray of points are 32-bit.
struct GeometryResponse {
  BufferRange points;        ///< three doubles a point
  BufferRange triangles;     ///< three numbers a triangle
  BufferRange lines;         ///< numbers of points, line after line
  BufferRange line_ends;     ///< of each line, one past its last place in `lines`, 64-bit
  BufferRange loose_points;  ///< points that are on no triangle and no line
  std::string value_name;    ///< of what the points carry; empty: nothing
  BufferRange values;        ///< a 32-bit float a point
};

/// Text metadata of a grid that may name units, and whether it says that it is a level set.
struct GridMetadata {
  std::string name, unit, unit_length;
  bool is_level_set = false;
};

struct ReadResponse {
  std::string error;  ///< not empty: a sentence, and nothing else
  // load
  std::string name;
  bool is_vector = false, has_mask = false, has_cell_mask = false;
  Mapping mapping;
  BufferRange values, valid_voxels, valid_cells;
  // describe
  std::vector<GridInfo> grids;
  // of catena-read-vtk
  DenseResponse dense;
  GeometryResponse geometry;
  std::vector<std::string> notes;  ///< what of the file is not as it was: sentences without an end
  std::vector<double> times;       ///< of the file's steps; empty: it has none
  std::string time_unit;           ///< of `times`; empty: not stated
  // always
  std::string units, unit_length;  ///< of the file
  bool is_patient_space = false;   ///< the world is a patient's (engine/io/volume/units.h)
  std::vector<GridMetadata> grid_metadata;
  PrimitiveKinds primitives;  ///< that it has, handed over or not
  SandboxStatus sandbox;
  std::vector<FileId> opened_files;  ///< the data files that were opened, with an error, too
  std::int64_t newest_mtime_ns = 0;  ///< when the youngest of them was last changed, since 1970; 0: not known
};

std::string encode(const ReadRequest& request);
std::string encode(const ReadResponse& reply);
/// An error is a phrase.
Result<ReadRequest> decode_request(std::span<const std::byte> bytes);
Result<ReadResponse> decode_response(std::span<const std::byte> bytes);

}  // namespace catena::field
