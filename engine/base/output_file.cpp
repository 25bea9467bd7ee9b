#include "engine/base/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace catena {

namespace fs = std::filesystem;

namespace {
Error cannot_write(const std::string& path, int code) { return Error{path + ": cannot write: " + std::strerror(code)}; }

bool written_directly(const std::string& path) {
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status);
}
}  // namespace

bool same_file(const std::string& a, const std::string& b) {
  std::error_code code;
  if (written_directly(a)) return false;
  if (fs::exists(a, code) && fs::exists(b, code)) return fs::equivalent(a, b, code);
  return fs::weakly_canonical(a, code) == fs::weakly_canonical(b, code);
}

Outcome check_output(const std::string& path, const std::vector<std::string>& inputs) {
  std::error_code code;
  if (path.empty()) return Error{"the output's name is empty: expected a file name"};
  if (fs::is_directory(path, code)) return Error{path + ": is a folder: expected a file name to write to"};
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  if (!fs::is_directory(folder, code)) return Error{path + ": the folder " + folder.string() + " does not exist"};
  for (const std::string& input : inputs) {
    if (same_file(path, input)) return Error{path + ": is also an input: expected another name for the output"};
  }
  return Done{};
}

OutputFile::OutputFile(std::string path, std::string temporary, std::FILE* file)
    : path_(std::move(path)), temporary_(std::move(temporary)), file_(file) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::move(other.temporary_)), file_(other.file_), error_(other.error_) {
  other.file_ = nullptr;
  other.temporary_.clear();
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<OutputFile> OutputFile::open(const std::string& name) {
  // through a link to the file that it names
  std::error_code code;
  std::string path = name;
  if (fs::is_symlink(name, code) && !written_directly(name)) {
    path = fs::weakly_canonical(name, code).string();
    if (code) return Error{name + ": cannot write: " + code.message()};
  }
  const std::string temporary = written_directly(path) ? std::string() : path + ".part" + std::to_string(::getpid());
  // what is to be removed is known before it is made: there may be no memory afterwards
  OutputFile output(path, temporary, nullptr);
  output.file_ = std::fopen((temporary.empty() ? path : temporary).c_str(), "wb");
  if (output.file_ == nullptr) {
    const int why = errno;
    output.temporary_.clear();
    return cannot_write(path, why);
  }
  return output;
}

void OutputFile::write(std::string_view text) {
  if (error_ == 0 && std::fwrite(text.data(), 1, text.size(), file_) != text.size()) error_ = errno != 0 ? errno : EIO;
}

void OutputFile::seek(std::uint64_t position) {
  if (error_ == 0 && ::fseeko(file_, static_cast<off_t>(position), SEEK_SET) != 0) error_ = errno;
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
  if (!temporary_.empty()) {
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) return cannot_write(path_, errno);
    temporary_.clear();
  }
  return Done{};
}

Outcome commit_all(const std::vector<OutputFile*>& files) {
  for (OutputFile* file : files) CATENA_CHECK(file->finish());
  for (OutputFile* file : files) CATENA_CHECK(file->commit());
  return Done{};
}

}  // namespace catena
