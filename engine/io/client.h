/// Private to this room and to engine/geometry/mesh: another program is asked for what is in a file, catena-read for a .vdb,
/// catena-read-vtk for what VTK and ITK read. It reads in a process of its own, shut in, with limits on its time and memory, and writes
/// what it found into a file in memory that is sealed and mapped here, read-only, without a copy. What it says is bounded, nothing more: it
/// may have been taken over by the file.
#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "engine/field/nanovdb/nano_builder.h"
#include "engine/io/protocol.h"

namespace catena::field {

struct MappedResponse {
  ReadResponse response;  ///< without an error
  NanoMemory memory;      ///< all that the reader wrote

  /// The numbers in a buffer; empty where it is not one, or not a multiple of their size.
  template <class T>
  std::span<const T> numbers(const BufferRange& piece) const {
    if (piece.offset % kBufferAlignment != 0 || piece.offset > memory.size() || piece.bytes > memory.size() - piece.offset ||
        piece.bytes % sizeof(T) != 0)
      return {};
    return {reinterpret_cast<const T*>(memory.data() + piece.offset), piece.bytes / sizeof(T)};
  }
};

/// Errors are whole sentences: those of the reader, or what became of it. Blocks until the reader has ended.
Result<MappedResponse> run_reader(ReadMode mode, const LoadRequest& request);

/// What the reader says of each grid, checked.
Result<std::vector<GridInfo>> describe_with_reader(const std::string& path, int step);

/// The sentence on an answer that cannot be: "FILE: the file is damaged (of what its reader made of it, WHAT), expected a sound .vdb file".
Error damaged_response_error(const std::string& path, std::string_view what);

/// For tests: another program in its place, and other limits. Zero and empty: what users have.
struct ReaderSettings {
  std::string program;
  std::uint64_t cpu_s = 0;
  double wall_s = 0;
  std::uint64_t memory_bytes = 0;  ///< that the machine has free; not stated by anybody
};
ReaderSettings& reader_settings();

/// The processor time that reading a .vdb file of so many bytes may take.
std::uint64_t read_cpu_limit_s(std::uint64_t file_bytes);

/// The data files that readers have opened so far where this path was asked for.
std::set<FileId> files_opened_by_readers(const std::string& path);

/// What every answer about a file has, its words on units and what of it is drawn, from the last one or from a new one; nothing where it
/// cannot be read.
std::optional<ReadResponse> read_file_metadata(const std::string& path);

}  // namespace catena::field
