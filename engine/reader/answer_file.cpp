#include "engine/reader/answer_file.h"

#include <sys/mman.h>
#include <unistd.h>
#include <new>
#include <vector>

namespace catena::reader {
namespace {

constexpr std::uint64_t kLongestRequest = 1 << 20;

std::uint64_t aligned(std::uint64_t n) { return (n + field::kPieceAlignment - 1) / field::kPieceAlignment * field::kPieceAlignment; }

bool write_at(int fd, std::uint64_t at, const void* data, std::size_t bytes) {
  const char* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t n = ::pwrite(fd, from, bytes, static_cast<off_t>(at));
    if (n <= 0) return false;
    from += n;
    at += static_cast<std::uint64_t>(n);
    bytes -= static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

Result<field::ReadRequest> AnswerFile::request() const {
  field::ExchangeHead head;
  if (::pread(fd_, &head, sizeof head, 0) != static_cast<ssize_t>(sizeof head) || head.magic != field::kExchangeMagic ||
      head.version != field::kExchangeVersion || head.from_reader != 0 || head.bytes > kLongestRequest)
    return Error{"there is no request"};
  std::vector<std::byte> text(head.bytes);
  if (::pread(fd_, text.data(), text.size(), static_cast<off_t>(head.offset)) != static_cast<ssize_t>(text.size()))
    return Error{"there is no request"};
  return field::decode_request(text);
}

field::NanoMemory AnswerFile::allocate(std::size_t bytes, field::Piece& piece) {
  piece = {end_, bytes};
  end_ = aligned(end_ + bytes);
  if (::ftruncate(fd_, static_cast<off_t>(end_)) != 0) throw std::bad_alloc();
  void* start = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, static_cast<off_t>(piece.offset));
  if (start == MAP_FAILED) throw std::bad_alloc();
  return field::NanoMemory::mapped(start, bytes, false);
}

bool AnswerFile::finish(const field::ReadReply& reply) {
  const std::string text = encode(reply);
  field::ExchangeHead head;
  head.from_reader = 1;
  head.offset = end_;
  head.bytes = text.size();
  return write_at(fd_, head.offset, text.data(), text.size()) && write_at(fd_, 0, &head, sizeof head);
}

}  // namespace catena::reader
