// SPDX-License-Identifier: MIT
/// Private to this module and to engine/geometry/mesh: runs the reader processes, catena-read for .vdb and .npy files and
/// catena-read-vtk for the formats of VTK and ITK. A reader is sandboxed, with limits on time and memory, and writes its response into a
/// shared memory file, which is then sealed and mapped here, read-only and without a copy. Only the bounds of a response are checked on
/// decoding; the contents are untrusted, because the file may have compromised the reader.
#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "engine/field/nanovdb/nano_builder.h"
#include "engine/io/protocol.h"

namespace catena::field {

/// A reader's response and the memory to which its buffer ranges refer.
struct MappedResponse {
  ReadResponse response;  ///< The decoded response; `error` is empty.
  NanoMemory memory;      ///< All memory that the reader wrote.

  /// Returns the values in a buffer range; empty when the range is out of bounds, misaligned or not a multiple of sizeof(T).
  template <class T>
  std::span<const T> numbers(const BufferRange& piece) const {
    if (piece.offset % kBufferAlignment != 0 || piece.offset > memory.size() || piece.bytes > memory.size() - piece.offset ||
        piece.bytes % sizeof(T) != 0)
      return {};
    return {reinterpret_cast<const T*>(memory.data() + piece.offset), piece.bytes / sizeof(T)};
  }
};

/// Runs a reader and blocks until it has ended. Returns an Error with a complete message: the reader's own, or the cause of its end. Any
/// thread.
Result<MappedResponse> run_reader(ReadMode mode, const LoadRequest& request);

/// Runs a reader and returns its validated description of each grid at a time step.
Result<std::vector<GridInfo>> describe_with_reader(const std::string& path, int step);

/// Error for an invalid response: "FILE: the file is damaged (invalid response of the reader process: WHAT), expected an undamaged file".
Error damaged_response_error(const std::string& path, std::string_view what);

/// Replacements of the reader program and its limits, for tests. Zero and empty: the defaults.
struct ReaderSettings {
  std::string program;
  std::uint64_t cpu_s = 0;
  double wall_s = 0;
  std::uint64_t memory_bytes = 0;  ///< Memory limit of the reader; replaces the available memory, as if no limit was given by the user.
};
/// The settings in use, one object per process.
ReaderSettings& reader_settings();

/// CPU time limit for reading a .vdb file of this size, seconds.
std::uint64_t read_cpu_limit_s(std::uint64_t file_bytes);

/// Data files that readers have opened so far for requests with this path. Any thread.
std::set<FileId> files_opened_by_readers(const std::string& path);

/// Returns the metadata part of a response (units, primitive kinds, times): cached while the file is unchanged, otherwise read again;
/// nullopt when the file cannot be read. Any thread.
std::optional<ReadResponse> read_file_metadata(const std::string& path);

}  // namespace catena::field
