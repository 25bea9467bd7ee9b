// SPDX-License-Identifier: MIT
/// Private to this module and to engine/io/vdb: a .vdb file is written by the process catena-write, which receives it leaf by leaf and
/// writes a temporary file, renamed to its final path when complete. The stream has a header per grid, then records of 32 bytes; a leaf's
/// record is followed by its mask (64 bytes) and, unless the grid is a mask, by its 512 values. The response is empty, or the error
/// message.
#pragma once
#include <nanovdb/NanoVDB.h>
#include <cstdint>
#include <string>

#include "engine/base/helper_process.h"
#include "engine/base/output_file.h"
#include "engine/field/mapping.h"

namespace catena::field {

/// Value type of a grid in the stream.
enum class StreamKind : std::uint32_t { scalar, vector, mask };

inline constexpr std::uint32_t kStreamMagic = 0x6e746143;

/// Header of a grid in the stream.
struct StreamHeader {
  std::uint32_t magic = kStreamMagic;
  StreamKind kind = StreamKind::scalar;
  std::uint32_t name_bytes = 0;  ///< Length of the name, which follows the header.
  std::uint32_t prune = 0;       ///< 1: nodes filled with one value become tiles.
  float background[4]{};
  double world_from_index[4][3]{};  ///< World vectors of the three index axes, then the origin.
};

/// A leaf or tile in the stream. `active` and `value` are used by tiles only.
struct StreamRecord {
  enum Type : std::uint32_t { leaf, tile_8, tile_128, tile_4096, end_of_grid };
  std::uint32_t type = end_of_grid;
  std::uint32_t active = 0;
  std::int32_t origin[3]{};
  float value[3]{};
};

/// Writes a .vdb file through catena-write. Not thread-safe.
class VdbStreamWriter {
 public:
  /// Opens the temporary file and starts the writer process. Returns an Error with a complete message.
  static Result<VdbStreamWriter> open(const std::string& path);

  /// Starts a grid; `merge`: nodes filled with one value become tiles. Failures of this and the next functions are reported by finish().
  void begin_grid(StreamKind kind, const std::string& name, const Mapping& mapping, const float* background, bool merge);
  /// Writes a leaf of 8^3 voxels; `values`: 512 scalars or vectors, unused for a mask.
  void write_leaf(const nanovdb::Coord& origin, const nanovdb::Mask<3>& active, const void* values);
  /// Writes a tile of edge 8, 128 or 4096 voxels.
  void write_tile(const nanovdb::Coord& origin, std::int32_t edge, const float* value, bool active);
  /// Ends the grid.
  void end_grid();
  /// Completes the file and renames it to its final path. Returns an Error of one line otherwise; then no file remains.
  Outcome finish();

 private:
  VdbStreamWriter(std::string path, OutputFile file, HelperProcess writer, FileDescriptor line);
  void write(const void* data, std::size_t bytes);
  void flush();

  std::string path_;
  OutputFile file_;
  HelperProcess writer_;
  FileDescriptor socket_;
  std::string buffer_;
  std::size_t value_bytes_ = 0, value_count_ = 0;
  bool has_failed_ = false;
};

}  // namespace catena::field
