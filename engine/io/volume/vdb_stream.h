/// Private to this room and to engine/io/vdb: what is written to a .vdb file goes to the program catena-write, block by block, and from
/// there to the file's temporary, which takes its name when all is complete. The stream, after a head for each grid, is records of 32
/// bytes; behind a leaf's come its mask (64 bytes) and, unless it is a mask's, its 512 values. The answer is empty, or why it failed.
#pragma once
#include <nanovdb/NanoVDB.h>
#include <cstdint>
#include <string>

#include "engine/base/helper_process.h"
#include "engine/base/output_file.h"
#include "engine/field/mapping.h"

namespace catena::field {

enum class StreamKind : std::uint32_t { scalar, vector, mask };

inline constexpr std::uint32_t kStreamMagic = 0x6e746143;

struct StreamHeader {
  std::uint32_t magic = kStreamMagic;
  StreamKind kind = StreamKind::scalar;
  std::uint32_t name_bytes = 0;  ///< the name follows
  std::uint32_t prune = 0;       ///< 1: nodes full of one value become tiles
  float background[4]{};
  double world_from_index[4][3]{};  ///< images of the axes, then the origin
};

struct StreamRecord {
  enum Type : std::uint32_t { leaf, tile_8, tile_128, tile_4096, end_of_grid };
  std::uint32_t type = end_of_grid;
  std::uint32_t active = 0;
  std::int32_t origin[3]{};
  float value[3]{};
};

class VdbStreamWriter {
 public:
  /// Opens the file's temporary and starts the writer. Errors are whole sentences.
  static Result<VdbStreamWriter> open(const std::string& path);

  /// Failures are kept for finish().
  void begin_grid(StreamKind kind, const std::string& name, const Mapping& mapping, const float* background, bool merge);
  void write_leaf(const nanovdb::Coord& origin, const nanovdb::Mask<3>& active, const void* values);
  void write_tile(const nanovdb::Coord& origin, std::int32_t edge, const float* value, bool active);
  void end_grid();
  /// The file is complete and has its name, or one line why not and nothing stays behind.
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
