#include "haptics/servo/log/block_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "engine/base/hash.h"

namespace catena::haptics::log {

namespace {

bool is_regular(int descriptor) {
  struct stat about {};
  return fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode);
}

std::string cannot_write(const std::string& path, int code) { return path + ": cannot write: " + std::strerror(code); }

}  // namespace

Result<BlockFile> BlockFile::create(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) return Error{cannot_write(path, errno)};
  BlockFile file(path, descriptor);
  if (is_regular(descriptor)) {
    // two recordings into one file would destroy each other
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      return Error{path + ": another program is recording into this file: expected another name"};
    if (::ftruncate(descriptor, 0) != 0) return Error{cannot_write(path, errno)};
  }
  unsigned char preamble[kPreambleBytes];
  std::memcpy(preamble, kMagic, 8);
  std::memcpy(preamble + 8, &kVersion, 4);
  std::memcpy(preamble + 12, &kByteOrder, 4);
  if (!file.write_all(preamble, sizeof preamble)) {
    file.discard();
    return Error{file.error()};
  }
  return file;
}

BlockFile::BlockFile(BlockFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(other.descriptor_),
      error_(other.error_),
      sequence_(other.sequence_),
      bytes_(other.bytes_) {
  other.descriptor_ = -1;
}

BlockFile::~BlockFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool BlockFile::write_all(const void* data, std::size_t size) {
  const auto* at = static_cast<const char*>(data);
  while (size > 0 && error_ == 0) {
    const ssize_t written = ::write(descriptor_, at, size);
    if (written < 0) {
      if (errno != EINTR) error_ = errno;
      continue;
    }
    at += written;
    size -= static_cast<std::size_t>(written);
    bytes_ += static_cast<std::uint64_t>(written);
  }
  return error_ == 0;
}

bool BlockFile::write(BlockType type, std::string_view payload) {
  if (error_ != 0) return false;
  if (payload.size() > kMaxPayload) {
    error_ = EFBIG;
    return false;
  }
  BlockHead head;
  head.type = static_cast<std::uint32_t>(type);
  head.sequence = sequence_++;
  head.length = payload.size();
  head.payload_hash = hash_of(payload.data(), payload.size());
  head.head_hash = hash_of(&head, BlockHead::kHashed);
  buffer_.assign(reinterpret_cast<const char*>(&head), sizeof head);
  buffer_.append(payload);
  return write_all(buffer_.data(), buffer_.size());
}

bool BlockFile::sync() {
  // pipes and terminals know no sync
  if (error_ == 0 && ::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) error_ = errno;
  return error_ == 0;
}

bool BlockFile::close() {
  if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_ == 0) error_ = errno;
  descriptor_ = -1;
  return error_ == 0;
}

void BlockFile::discard() {
  if (descriptor_ < 0) return;
  if (is_regular(descriptor_)) ::unlink(path_.c_str());
  ::close(descriptor_);
  descriptor_ = -1;
}

std::string BlockFile::error() const { return error_ == 0 ? std::string() : cannot_write(path_, error_); }

}  // namespace catena::haptics::log
