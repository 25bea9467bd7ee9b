/// The file in memory through which catena asks and is answered (engine/field/reader_exchange.h), from the reader's side.
#pragma once
#include "engine/field/nano_build.h"
#include "engine/field/reader_exchange.h"

namespace catena::reader {

class AnswerFile {
 public:
  explicit AnswerFile(int fd) : fd_(fd) {}

  /// An error is a phrase.
  Result<field::ReadRequest> request() const;
  /// Zeroed memory that is a part of the file; throws std::bad_alloc. `piece` is where.
  field::NanoMemory allocate(std::size_t bytes, field::Piece& piece);
  /// The reply, and the head that says where it is. False where there is no room.
  bool finish(const field::ReadReply& reply);

 private:
  int fd_;
  std::uint64_t end_ = field::kPieceAlignment;  ///< of what is taken; the head, and the request, are in the first page
};

}  // namespace catena::reader
