/// What catena and the programs that read files for it, catena-read (.vdb) and catena-read-vtk (what VTK and ITK read), tell each other.
/// Private to this room, to engine/reader, engine/vdb and engine/vtk, and to who asks for shapes (engine/mesh). Both sides see one file in
/// memory:
///   catena writes       the head (where the request is), the request
///   the reader writes   buffers (each at a multiple of kPieceAlignment), the reply, and last the head (where the reply is)
/// What is decoded is held to its bounds, but nothing in it is believed: see check_nano and load_vdb.cpp.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/input_files.h"
#include "engine/field/load.h"

namespace catena::field {

inline constexpr std::uint64_t kExchangeMagic = 0x31615644'6e746143;  // "CatnDVa1"
inline constexpr std::uint32_t kExchangeVersion = 5;
/// Of the grid of a .vdb that masks cells, beside "valid": true at the base of each that is valid.
inline constexpr std::string_view kCellMaskName = "valid_cells";
inline constexpr std::uint64_t kPieceAlignment = 4096;

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

struct ExchangeHead {
  std::uint64_t magic = kExchangeMagic;
  std::uint32_t version = kExchangeVersion;
  std::uint32_t from_reader = 0;  ///< 0: a request follows; 1: a reply
  std::uint64_t offset = 0, bytes = 0;
  ReaderState state = ReaderState::not_started;
  std::uint32_t of_addresses = 0;  ///< of a request: 1: its limit on memory is what ulimit -v leaves
};

/// load: one grid. describe: what there is. words: what every reply has, nothing else. shape: what is drawn as it lies, triangles, lines
/// and points.
enum class ReadMode : std::uint8_t { load, describe, words, shape };

struct ReadRequest {
  ReadMode mode = ReadMode::load;
  LoadRequest what;  ///< without the layout of raw files
  std::uint64_t memory_bytes = 0;
  std::uint64_t stated_memory = 0;  ///< what the user allows (--memory), in bytes; 0: nothing is stated
  std::uint64_t cpu_s = 0;
};

struct Piece {
  std::uint64_t offset = 0, bytes = 0;
};

/// What the reader could shut itself into.
struct Confinement {
  std::uint32_t landlock_version = 0;  ///< 0: this kernel has none
  bool seccomp = false;
};

/// Numbers that lie in a buffer as they are, x fastest.
struct DenseReply {
  Size3 size;                   ///< voxels an axis; x = 0: there are none
  std::int32_t components = 1;  ///< 1 or 3, one after the other
  std::string type;             ///< as the file says: "float64", "int16"
  Piece values;                 ///< 32-bit floats
  Piece valid;                  ///< a byte a voxel, 0 or 1; empty: all are valid
  Piece cells{};                ///< beside `valid`: a byte a voxel, 0 where the cell based at it is not valid; empty: no mask of cells
  bool has_range = false;       ///< the values were resampled: `range` is that of the data
  DisplayRange range;           ///< of vectors: of their lengths
};

/// What is drawn as it lies. Numbers of points are 32-bit.
struct ShapeReply {
  Piece points;            ///< three doubles a point
  Piece triangles;         ///< three numbers a triangle
  Piece lines;             ///< numbers of points, line after line
  Piece ends;              ///< of each line, one past its last place in `lines`, 64-bit
  Piece loose;             ///< points that are on no triangle and no line
  std::string value_name;  ///< of what the points carry; empty: nothing
  Piece values;            ///< a 32-bit float a point
};

/// Text metadata of a grid that may name units, and whether it says that it is a level set.
struct GridWords {
  std::string name, unit, unit_length;
  bool level_set = false;
};

struct ReadReply {
  std::string error;  ///< not empty: a sentence, and nothing else
  // load
  std::string name;
  bool is_vector = false, masked = false, cells_masked = false;
  Mapping mapping;
  Piece values, voxels, cells;
  // describe
  std::vector<GridInfo> grids;
  // of catena-read-vtk
  DenseReply dense;
  ShapeReply shape;
  std::vector<std::string> notes;  ///< what of the file is not as it was: sentences without an end
  std::vector<double> times;       ///< of the file's steps; empty: it has none
  std::string time_unit;           ///< of `times`; empty: not stated
  // always
  std::string units, unit_length;  ///< of the file
  bool patient = false;            ///< the world is a patient's (engine/field/units.h)
  std::vector<GridWords> words;
  Shapes shapes;  ///< that it has, handed over or not
  Confinement confinement;
  std::vector<FileId> opened;  ///< the data files that were opened, with an error, too
  std::int64_t newest_ns = 0;  ///< when the youngest of them was last changed, since 1970; 0: not known
};

std::string encode(const ReadRequest& request);
std::string encode(const ReadReply& reply);
/// An error is a phrase.
Result<ReadRequest> decode_request(std::span<const std::byte> bytes);
Result<ReadReply> decode_reply(std::span<const std::byte> bytes);

}  // namespace catena::field
