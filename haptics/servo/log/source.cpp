#include "haptics/servo/log/source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace catena::haptics::log {

namespace {

class File final : public Source {
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

class Memory final : public Source {
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

Result<std::unique_ptr<Source>> open_file(const std::string& path) {
  const auto cannot = [&](const char* why) { return Error{path + ": cannot read: " + why + "; a recording (.catlog) was expected"}; };
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return cannot(std::strerror(errno));
  struct stat about {};
  if (::fstat(descriptor, &about) != 0 || !S_ISREG(about.st_mode)) {
    ::close(descriptor);
    return cannot("it is no regular file");
  }
  return std::unique_ptr<Source>(std::make_unique<File>(descriptor, static_cast<std::uint64_t>(about.st_size)));
}

std::unique_ptr<Source> from_memory(std::string_view bytes) { return std::make_unique<Memory>(bytes); }

}  // namespace catena::haptics::log
