#include "engine/base/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "engine/base/too_many_files.h"

namespace catena {

namespace fs = std::filesystem;

namespace {
Error cannot_write(const std::string& path, int code) {
  return Error{path + ": cannot write: " + std::strerror(code), too_many_files(code)};
}

bool written_directly(const std::string& path) {
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status);
}
}  // namespace

OutputFile::OutputFile(std::string path, std::optional<PartFile> part, std::FILE* file)
    : path_(std::move(path)), part_(std::move(part)), file_(file) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)), part_(std::move(other.part_)), file_(std::exchange(other.file_, nullptr)), error_(other.error_) {
  other.part_.reset();
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
}

Result<OutputFile> OutputFile::open(const std::string& name) {
  if (written_directly(name)) {
    std::FILE* const file = std::fopen(name.c_str(), "wbe");
    if (file == nullptr) return cannot_write(name, errno);
    return OutputFile(name, std::nullopt, file);
  }
  // through a link to the file that it names
  std::error_code code;
  std::string path = name;
  if (fs::is_symlink(name, code)) {
    path = fs::weakly_canonical(name, code).string();
    if (code) return Error{name + ": cannot write: " + code.message()};
  }
  CATENA_TRY(PartFile part, PartFile::create(path));
  // the stream has a descriptor of its own: the part's keeps the lock until the end
  const int own = ::fcntl(part.descriptor(), F_DUPFD_CLOEXEC, 0);
  std::FILE* const file = own < 0 ? nullptr : ::fdopen(own, "wb");
  if (file == nullptr) {
    const int why = errno;
    if (own >= 0) ::close(own);
    return cannot_write(path, why);
  }
  return OutputFile(path, std::move(part), file);
}

void OutputFile::write(std::string_view text) {
  if (error_ == 0 && std::fwrite(text.data(), 1, text.size(), file_) != text.size()) error_ = errno != 0 ? errno : EIO;
}

void OutputFile::seek(std::uint64_t position) {
  if (error_ == 0 && ::fseeko(file_, static_cast<off_t>(position), SEEK_SET) != 0) error_ = errno;
}

void OutputFile::sync() {
  if (error_ != 0 || !part_) return;
  if (std::fflush(file_) != 0 || ::fsync(part_->descriptor()) != 0) error_ = errno;
}

Outcome OutputFile::finish() {
  if (file_ != nullptr) {
    if (std::fflush(file_) != 0 && error_ == 0) error_ = errno;
    if (std::ferror(file_) != 0 && error_ == 0) error_ = EIO;
    if (std::fclose(file_) != 0 && error_ == 0) error_ = errno;
    file_ = nullptr;
  }
  if (error_ != 0) return cannot_write(path_, error_);
  return Done{};
}

Outcome OutputFile::commit() {
  CATENA_CHECK(finish());
  return part_ ? part_->commit() : Outcome(Done{});
}

Outcome commit_all(const std::vector<OutputFile*>& files) {
  for (OutputFile* file : files) CATENA_CHECK(file->finish());
  for (OutputFile* file : files) CATENA_CHECK(file->commit());
  return Done{};
}

}  // namespace catena
