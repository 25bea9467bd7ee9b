// SPDX-License-Identifier: MIT
/// The shared memory file for request and response (engine/io/protocol.h), from the reader's side.
#pragma once
#include <exception>

#include "engine/field/nanovdb/nano_builder.h"
#include "engine/io/protocol.h"

namespace catena::sandbox {

/// File descriptor of the shared memory file in a reader.
inline constexpr int kResponseFd = 3;

/// Reports failures that occur before main() (preinit.h), in the same way as after ResponseFile::read_request().
void report_early_failures() noexcept;

/// Reads the request, allocates buffers and writes the response. One object per process.
class ResponseFile {
 public:
  explicit ResponseFile(int fd) : fd_(fd) {}

  /// Reads the request and applies its memory limit. Afterwards failed allocations, and unhandled failures to start a thread, are recorded
  /// in the header. Returns an Error with a message fragment.
  Result<field::ReadRequest> read_request();
  /// Records a state in the header.
  void report(field::ReaderState state) const noexcept;
  /// Records an exception in the header if it means that a thread could not be started, including those of TBB and ITK.
  void report(const std::exception& thrown) const noexcept;
  /// Allocates zeroed memory in the shared file; `piece` receives its range. Throws std::bad_alloc.
  field::NanoMemory allocate(std::size_t bytes, field::BufferRange& piece);
  /// Writes the response, and the header with its offset. Returns false when the file cannot grow.
  bool finish(const field::ReadResponse& reply);

 private:
  int fd_;
  std::uint64_t end_ = field::kBufferAlignment;  ///< End of the allocated part; header and request are in the first page.
};

}  // namespace catena::sandbox
