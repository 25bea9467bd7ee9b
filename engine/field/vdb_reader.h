/// Private to this room and to engine/vdb: what is written to a .vdb file goes to the program catena-write, block by block, and from there
/// to the file's temporary, which takes its name when all is complete. The stream, after a head for each grid, is records of 32 bytes;
/// behind a leaf's come its mask (64 bytes) and, unless it is a mask's, its 512 values. The answer is empty, or why it failed.
#pragma once
#include <nanovdb/NanoVDB.h>
#include <cstdint>
#include <optional>
#include <string>

#include "engine/base/helper_process.h"
#include "engine/base/output_file.h"
#include "engine/field/mapping.h"
#include "engine/field/nano_build.h"
#include "engine/field/vdb_exchange.h"

namespace catena::field {

enum class StreamKind : std::uint32_t { scalar, vector, mask };

inline constexpr std::uint32_t kStreamMagic = 0x6e746143;

struct StreamHead {
  std::uint32_t magic = kStreamMagic;
  StreamKind kind = StreamKind::scalar;
  std::uint32_t name_bytes = 0;  ///< the name follows
  std::uint32_t merge = 0;       ///< 1: nodes full of one value become tiles
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

class VdbStream {
 public:
  /// Opens the file's temporary and starts the writer. Errors are whole sentences.
  static Result<VdbStream> open(const std::string& path);

  /// Failures are kept for finish().
  void begin_grid(StreamKind kind, const std::string& name, const Mapping& mapping, const float* background, bool merge);
  void leaf(const nanovdb::Coord& origin, const nanovdb::Mask<3>& active, const void* values);
  void tile(const nanovdb::Coord& origin, std::int32_t edge, const float* value, bool active);
  void end_grid();
  /// The file is complete and has its name, or one line why not and nothing stays behind.
  Outcome finish();

 private:
  VdbStream(std::string path, OutputFile file, HelperProcess writer, Descriptor line);
  void put(const void* data, std::size_t bytes);
  void flush();

  std::string path_;
  OutputFile file_;
  HelperProcess writer_;
  Descriptor line_;
  std::string buffer_;
  std::size_t value_bytes_ = 0, value_count_ = 0;
  bool broken_ = false;
};

/// Private to this room: the program catena-read is asked for what is in a .vdb file. It reads the file in a process of its own, shut in,
/// with limits on its time and memory, and writes grids into a file in memory that is sealed and mapped here, read-only, without a copy.
/// What it says is bounded, nothing more: it may have been taken over by the file.
struct ReaderAnswer {
  ReadReply reply;    ///< without an error
  NanoMemory memory;  ///< all that the reader wrote
};

/// Errors are whole sentences: those of the reader, or what became of it. Blocks until the reader has ended.
Result<ReaderAnswer> ask_reader(ReadMode mode, const LoadRequest& request);

/// For tests: another program in its place, and other limits. Zero and empty: what users have.
struct ReaderSettings {
  std::string program;
  std::uint64_t cpu_s = 0;
  double wall_s = 0;
};
ReaderSettings& reader_settings();

/// The processor time that reading a file of so many bytes may take.
std::uint64_t reading_time_s(std::uint64_t file_bytes);

/// The words on units of a file, from the last answer about it or from a new one; nothing where it cannot be read.
std::optional<ReadReply> unit_words_of(const std::string& path);

}  // namespace catena::field
