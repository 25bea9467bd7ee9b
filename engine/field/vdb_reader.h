/// Private to this room: the program catena-read is asked for what is in a .vdb file. It reads the file in a process of its own, shut in,
/// with limits on its time and memory, and writes grids into a file in memory that is sealed and mapped here, read-only, without a copy.
/// What it says is bounded, nothing more: it may have been taken over by the file.
#pragma once
#include "engine/field/nano_memory.h"
#include "engine/field/vdb_exchange.h"

namespace catena::field {

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
