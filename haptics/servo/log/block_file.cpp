// SPDX-License-Identifier: MIT
#include "haptics/servo/log/block_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstring>

#include "engine/base/hash.h"
#include "engine/base/input_files.h"
#include "engine/base/system_failure.h"

namespace catena::haptics::log {

namespace {

class File final : public ByteSource {
 public:
  File(int descriptor, std::uint64_t size) : descriptor_(descriptor), size_(size) {}
  ~File() override { ::close(descriptor_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  std::uint64_t size() const override { return size_; }
  bool read(std::uint64_t offset, void* to, std::size_t bytes) override {
    auto* at = static_cast<char*>(to);
    while (bytes > 0) {
      const ssize_t got = ::pread(descriptor_, at, bytes, static_cast<off_t>(offset));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      at += got;
      offset += static_cast<std::uint64_t>(got);
      bytes -= static_cast<std::size_t>(got);
    }
    return true;
  }

 private:
  int descriptor_;
  std::uint64_t size_;
};

class Memory final : public ByteSource {
 public:
  explicit Memory(std::string_view bytes) : bytes_(bytes) {}
  std::uint64_t size() const override { return bytes_.size(); }
  bool read(std::uint64_t offset, void* to, std::size_t bytes) override {
    if (offset > bytes_.size() || bytes > bytes_.size() - offset) return false;
    std::memcpy(to, bytes_.data() + offset, bytes);
    return true;
  }

 private:
  std::string_view bytes_;
};

}  // namespace

Result<std::unique_ptr<ByteSource>> open_file_source(const std::string& path) {
  const auto cannot = [&](const std::string& why, int code = 0) {
    return Error{path + ": cannot read: " + why + "; a recording (.catlog) was expected", is_system_failure(code)};
  };
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    const int why = errno;
    return cannot(describe_errno(why), why);
  }
  struct stat about {};
  if (::fstat(descriptor, &about) != 0 || !S_ISREG(about.st_mode)) {
    ::close(descriptor);
    return cannot("not a regular file");
  }
  return std::unique_ptr<ByteSource>(std::make_unique<File>(descriptor, static_cast<std::uint64_t>(about.st_size)));
}

std::unique_ptr<ByteSource> make_memory_source(std::string_view bytes) { return std::make_unique<Memory>(bytes); }

namespace {

bool is_regular(int descriptor) {
  struct stat about {};
  return fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode);
}

Error cannot_write(const std::string& path, int code) { return system_error(path + ": cannot write", code); }

}  // namespace

Result<BlockFile> BlockFile::create(const std::string& path) {
  CATENA_CHECK(check_not_input(path));
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_NONBLOCK | O_NOCTTY | O_CLOEXEC, 0666);
  if (descriptor < 0 && errno == ENXIO)
    return Error{path + ": no program reads from this pipe or socket, expected a file, or a pipe with a reader"};
  if (descriptor < 0) return cannot_write(path, errno);
  static_cast<void>(::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK));
  BlockFile file(path, descriptor);
  if (is_regular(descriptor)) {
    // two recordings to one file would overwrite each other
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      return Error{path + ": another program is recording to this file, expected another name"};
    if (::ftruncate(descriptor, 0) != 0) return cannot_write(path, errno);
  }
  unsigned char preamble[kPreambleBytes];
  std::memcpy(preamble, kMagic, 8);
  std::memcpy(preamble + 8, &kVersion, 4);
  std::memcpy(preamble + 12, &kByteOrderMark, 4);
  if (!file.write_all(preamble, sizeof preamble)) {
    file.discard();
    return file.error();
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
  BlockHeader head;
  head.type = static_cast<std::uint32_t>(type);
  head.sequence = sequence_++;
  head.length = payload.size();
  head.payload_hash = hash_bytes(payload.data(), payload.size());
  head.header_hash = hash_bytes(&head, BlockHeader::kHashedBytes);
  buffer_.assign(reinterpret_cast<const char*>(&head), sizeof head);
  buffer_.append(payload);
  return write_all(buffer_.data(), buffer_.size());
}

bool BlockFile::sync() {
  // pipes and terminals cannot be synced
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

Error BlockFile::error() const { return error_ == 0 ? Error{} : cannot_write(path_, error_); }

namespace {

constexpr std::uint64_t kHeadBytes = sizeof(BlockHeader);
constexpr std::size_t kWindow = std::size_t{64} << 10;

bool is_head(const char* bytes, BlockHeader& head) {
  std::memcpy(&head, bytes, sizeof head);
  return head.magic == BlockHeader::kBlockMagic && head.header_hash == hash_bytes(bytes, BlockHeader::kHashedBytes) &&
         head.length <= kMaxPayload;
}

}  // namespace

bool BlockReader::read_header(std::uint64_t at, BlockHeader& head) {
  char bytes[kHeadBytes];
  return source_->read(at, bytes, kHeadBytes) && is_head(bytes, head);
}

// Advances to the next position at which the 32 header bytes of a block are valid.
bool BlockReader::find_next_header() {
  std::string window;
  BlockHeader head;
  for (std::uint64_t from = at_ + 1; from + kHeadBytes <= source_->size();) {
    window.resize(std::min<std::uint64_t>(kWindow, source_->size() - from));
    if (!source_->read(from, window.data(), window.size())) return false;
    const std::size_t places = window.size() - kHeadBytes + 1;
    for (std::size_t k = 0; k < places; ++k) {
      if (!is_head(window.data() + k, head)) continue;
      at_ = from + k;
      return true;
    }
    from += places;
  }
  return false;
}

BlockReader::ReadResult BlockReader::next() {
  const std::uint64_t size = source_->size();
  if (at_ >= size) return ReadResult::end;
  if (size - at_ < kHeadBytes) return ReadResult::truncated;
  if (!read_header(at_, header_)) {
    if (find_next_header()) return ReadResult::damaged;
    return ReadResult::truncated;
  }
  if (header_.length > size - at_ - kHeadBytes) return ReadResult::truncated;
  payload_.resize(header_.length);
  const bool good = source_->read(at_ + kHeadBytes, payload_.data(), payload_.size()) &&
                    hash_bytes(payload_.data(), payload_.size()) == header_.payload_hash;
  at_ += kHeadBytes + header_.length;
  return good ? ReadResult::block : ReadResult::damaged;
}

}  // namespace catena::haptics::log
