/// The file in memory through which catena asks and is answered (engine/io/protocol.h), from the reader's side.
#pragma once
#include <exception>

#include "engine/field/nanovdb/nano_builder.h"
#include "engine/io/protocol.h"

namespace catena::sandbox {

/// A reader finds the file as this descriptor.
inline constexpr int kResponseFd = 3;

/// As ResponseFile::request() does it, for what happens before main() (early.h).
void report_early_failures() noexcept;

class ResponseFile {
 public:
  explicit ResponseFile(int fd) : fd_(fd) {}

  /// An error is a phrase. From here on a failed allocation, and a thread that could not be started and that nothing handles, are noted in
  /// the head. One ResponseFile a process.
  Result<field::ReadRequest> read_request();
  /// Says in the head what has happened.
  void report(field::ReaderState state) const noexcept;
  /// The same of an exception that says that a thread could not be started, TBB's and ITK's among them.
  void report(const std::exception& thrown) const noexcept;
  /// Zeroed memory that is a part of the file; throws std::bad_alloc. `piece` is where.
  field::NanoMemory allocate(std::size_t bytes, field::BufferRange& piece);
  /// The reply, and the head that says where it is. False where there is no room.
  bool finish(const field::ReadResponse& reply);

 private:
  int fd_;
  std::uint64_t end_ = field::kBufferAlignment;  ///< of what is taken; the head, and the request, are in the first page
};

}  // namespace catena::sandbox
