/// The file in memory through which catena asks and is answered (engine/field/reader_exchange.h), from the reader's side.
#pragma once
#include <exception>

#include "engine/field/nano_build.h"
#include "engine/field/reader_exchange.h"

namespace catena::reader {

/// A reader finds the file as this descriptor.
inline constexpr int kAnswer = 3;

/// As AnswerFile::request() does it, for what happens before main() (early.h).
void note_early_failures() noexcept;

class AnswerFile {
 public:
  explicit AnswerFile(int fd) : fd_(fd) {}

  /// An error is a phrase. From here on a failed allocation, and a thread that could not be started and that nothing handles, are noted in
  /// the head. One AnswerFile a process.
  Result<field::ReadRequest> request();
  /// Says in the head what has happened.
  void note(field::ReaderState state) const noexcept;
  /// The same of an exception that says that a thread could not be started, TBB's and ITK's among them.
  void note(const std::exception& thrown) const noexcept;
  /// Zeroed memory that is a part of the file; throws std::bad_alloc. `piece` is where.
  field::NanoMemory allocate(std::size_t bytes, field::Piece& piece);
  /// The reply, and the head that says where it is. False where there is no room.
  bool finish(const field::ReadReply& reply);

 private:
  int fd_;
  std::uint64_t end_ = field::kPieceAlignment;  ///< of what is taken; the head, and the request, are in the first page
};

}  // namespace catena::reader
