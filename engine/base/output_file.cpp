// SPDX-License-Identifier: MIT
#include "engine/base/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "engine/base/result.h"
#include "engine/base/system_failure.h"

namespace catena {

namespace fs = std::filesystem;

namespace {

constexpr int kMaxSymlinks = 40;

/// Identity of the file that a name leads to: (device, inode, "") of an existing file, else the folder and the name of the new file.
using Identity = std::tuple<dev_t, ino_t, std::string>;

/// Returns the identity of a name; nullopt for a device, a pipe or an empty name.
std::optional<Identity> identity_of(const std::string& name) {
  if (name.empty()) return std::nullopt;
  struct stat about {};
  if (::stat(name.c_str(), &about) == 0) {
    if (!S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode)) return std::nullopt;
    return Identity{about.st_dev, about.st_ino, {}};
  }
  // a dangling symbolic link stands for the path that it names
  std::error_code code;
  fs::path path = fs::absolute(name, code);
  for (int k = 0; k < kMaxSymlinks && fs::is_symlink(path, code); ++k) {
    const fs::path to = fs::read_symlink(path, code);
    path = to.is_absolute() ? to : path.parent_path() / to;
  }
  const fs::path folder = path.parent_path();
  if (::stat(folder.c_str(), &about) == 0) return Identity{about.st_dev, about.st_ino, "/" + path.filename().string()};
  return Identity{0, 0, fs::weakly_canonical(path, code).string()};
}

Outcome check_target(const std::string& path) {
  std::error_code code;
  if (fs::is_directory(path, code)) return Error{path + ": is a folder: expected a file name to write to"};
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  if (!fs::is_directory(folder, code)) return Error{path + ": the folder " + folder.string() + " does not exist"};
  return Done{};
}

}  // namespace

bool is_same_file(const std::string& a, const std::string& b) {
  const auto first = identity_of(a);
  return first && first == identity_of(b);
}

bool is_path_within(const std::string& path, const std::string& folder) {
  std::error_code code;
  const fs::path inner = fs::weakly_canonical(fs::absolute(path, code), code),
                 outer = fs::weakly_canonical(fs::absolute(folder, code), code);
  const auto [end, ignored] = std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
  return !code && end == outer.end() && inner != outer;
}

Outcome check_outputs(const std::vector<PlannedOutput>& outputs, const std::vector<std::string>& inputs) {
  std::map<Identity, const std::string*> read;
  for (const std::string& input : inputs)
    if (const auto identity = identity_of(input)) read.emplace(*identity, &input);
  std::map<Identity, const PlannedOutput*> written;
  for (const PlannedOutput& output : outputs) {
    if (output.path.empty()) continue;
    CATENA_CHECK(check_target(output.path));
    const auto identity = identity_of(output.path);
    if (!identity) continue;
    if (read.contains(*identity)) return Error{output.path + ": is also an input: expected another name for the output"};
    const auto [at, inserted] = written.emplace(*identity, &output);
    if (!inserted)
      return Error{output.path + ": " + at->second->option + " and " + output.option + " name one file: expected " +
                   (at->second->option == output.option ? "one a frame" : "two")};
  }
  return Done{};
}

Outcome check_output(const std::string& path, const std::vector<std::string>& inputs) {
  if (path.empty()) return Error{"the output's name is empty: expected a file name"};
  return check_outputs({{"", path}}, inputs);
}

namespace fs = std::filesystem;

namespace {
Error cannot_write(const std::string& path, int code) { return system_error(path + ": cannot write", code); }

/// Opens a pipe, a socket or a device for writing without blocking; a pipe without a reader is an Error.
Result<int> open_directly(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_TRUNC | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0 && errno == ENXIO) return Error{path + ": nothing reads from this pipe or socket: expected a file, or a reader first"};
  if (descriptor < 0) return cannot_write(path, errno);
  // writes block: the reader may be slower than the writer
  static_cast<void>(::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK));
  return descriptor;
}

}  // namespace

bool is_written_directly(const std::string& path) {
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status);
}

OutputFile::OutputFile(std::string path, std::optional<TemporaryFile> part, std::FILE* file)
    : path_(std::move(path)), temporary_(std::move(part)), file_(file) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::move(other.temporary_)),
      file_(std::exchange(other.file_, nullptr)),
      error_(other.error_) {
  other.temporary_.reset();
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
}

Result<OutputFile> OutputFile::open(const std::string& name) {
  if (is_written_directly(name)) {
    CATENA_TRY(const int descriptor, open_directly(name));
    std::FILE* const file = ::fdopen(descriptor, "wb");
    if (file == nullptr) return cannot_write(name, errno);
    return OutputFile(name, std::nullopt, file);
  }
  // a symbolic link is resolved: its target is replaced
  std::error_code code;
  std::string path = name;
  if (fs::is_symlink(name, code)) {
    path = fs::weakly_canonical(name, code).string();
    if (code) return cannot_write(name, code.value());
  }
  CATENA_TRY(TemporaryFile part, TemporaryFile::create(path));
  // the stream gets a duplicate descriptor: the temporary file's own keeps the lock until the end
  const int stream_descriptor = ::fcntl(part.descriptor(), F_DUPFD_CLOEXEC, 0);
  std::FILE* const file = stream_descriptor < 0 ? nullptr : ::fdopen(stream_descriptor, "wb");
  if (file == nullptr) {
    const int error_number = errno;
    if (stream_descriptor >= 0) ::close(stream_descriptor);
    return cannot_write(path, error_number);
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
  if (error_ != 0 || !temporary_) return;
  if (std::fflush(file_) != 0 || ::fsync(temporary_->descriptor()) != 0) error_ = errno;
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
  return temporary_ ? temporary_->commit() : Outcome(Done{});
}

Outcome commit_all(const std::vector<OutputFile*>& files) {
  for (OutputFile* file : files) CATENA_CHECK(file->finish());
  for (OutputFile* file : files) CATENA_CHECK(file->commit());
  return Done{};
}

}  // namespace catena
