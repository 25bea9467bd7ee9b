// SPDX-License-Identifier: MIT
#include "engine/io/volume/vdb_stream.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>

#include "engine/base/helper_process.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/io/formats.h"

namespace catena::field {
namespace {

constexpr std::size_t kBuffer = 1 << 20;

Error cannot_write(const std::string& path, const std::string& reason, bool machine = false) {
  return Error{fmt::format("{}: cannot be written ({})", path, one_line(reason)), machine};
}

}  // namespace

VdbStreamWriter::VdbStreamWriter(std::string path, OutputFile file, HelperProcess writer, FileDescriptor line)
    : path_(std::move(path)), file_(std::move(file)), writer_(std::move(writer)), socket_(std::move(line)) {
  buffer_.reserve(kBuffer);
}

Result<VdbStreamWriter> VdbStreamWriter::open(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored))
    return Error{fmt::format("{}: the folder {} does not exist", path, folder.string())};
  if (fs::is_directory(path, ignored)) return Error{fmt::format("{}: this is a folder, expected the name of a file to write", path)};
  CATENA_TRY(OutputFile file, OutputFile::open(path));
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return cannot_write(path, describe_errno(errno), true);
  FileDescriptor own_end(ends[0]), writer_end(ends[1]);
  const int descriptors[] = {writer_end.get(), ::fileno(file.stream())};
  auto writer = HelperProcess::start(helper_path("catena-write"), descriptors);
  if (!writer) return cannot_write(path, writer.error().message, writer.error().system_failure);
  return VdbStreamWriter(path, std::move(file), std::move(*writer), std::move(own_end));
}

void VdbStreamWriter::write(const void* data, std::size_t bytes) {
  if (buffer_.size() + bytes > kBuffer) flush();
  buffer_.append(static_cast<const char*>(data), bytes);
}

void VdbStreamWriter::flush() {
  for (std::size_t at = 0; at < buffer_.size() && !has_failed_;) {
    const ssize_t n = ::send(socket_.get(), buffer_.data() + at, buffer_.size() - at, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    has_failed_ = n <= 0;
    at += n > 0 ? static_cast<std::size_t>(n) : 0;
  }
  buffer_.clear();
}

void VdbStreamWriter::begin_grid(StreamKind kind, const std::string& name, const Mapping& mapping, const float* background, bool merge) {
  StreamHeader head;
  head.kind = kind;
  head.name_bytes = static_cast<std::uint32_t>(name.size());
  head.prune = merge ? 1 : 0;
  value_count_ = kind == StreamKind::scalar ? 1 : kind == StreamKind::vector ? 3 : 0;
  value_bytes_ = value_count_ * sizeof(float);
  if (value_bytes_ > 0) std::memcpy(head.background, background, value_bytes_);
  for (int a = 0; a < 3; ++a)
    for (int c = 0; c < 3; ++c) head.world_from_index[a][c] = mapping.world_from_index_linear[a][c];
  for (int c = 0; c < 3; ++c) head.world_from_index[3][c] = mapping.origin[c];
  write(&head, sizeof head);
  write(name.data(), name.size());
}

void VdbStreamWriter::write_leaf(const nanovdb::Coord& origin, const nanovdb::Mask<3>& active, const void* values) {
  StreamRecord record;
  record.type = StreamRecord::leaf;
  for (int a = 0; a < 3; ++a) record.origin[a] = origin[a];
  write(&record, sizeof record);
  write(&active, sizeof active);
  if (value_bytes_ > 0) write(values, 512 * value_bytes_);
}

void VdbStreamWriter::write_tile(const nanovdb::Coord& origin, std::int32_t edge, const float* value, bool active) {
  StreamRecord record;
  record.type = edge == 8 ? StreamRecord::tile_8 : edge == 128 ? StreamRecord::tile_128 : StreamRecord::tile_4096;
  record.active = active ? 1 : 0;
  for (int a = 0; a < 3; ++a) record.origin[a] = origin[a];
  if (value != nullptr) std::memcpy(record.value, value, value_bytes_);  // a mask has no values
  write(&record, sizeof record);
}

void VdbStreamWriter::end_grid() {
  const StreamRecord record;
  write(&record, sizeof record);
}

Outcome VdbStreamWriter::finish() {
  flush();
  ::shutdown(socket_.get(), SHUT_WR);
  // the response
  std::string answer;
  char piece[512];
  constexpr std::size_t kMaxAnswerBytes = 2000;
  for (;;) {
    const ssize_t n = ::recv(socket_.get(), piece, sizeof piece, 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    if (answer.size() < kMaxAnswerBytes) answer.append(piece, static_cast<std::size_t>(n));
  }
  constexpr double kMaxWait_s = 60;  // the program has closed its end of the socket
  const ProcessExit end = writer_.wait(kMaxWait_s);
  const std::string limits = describe_resource_limits();
  if (!answer.empty()) {
    const bool machine = answer.front() == '1';
    return cannot_write(path_, answer.substr(1), machine);
  }
  // the data come from this process, so that the program can only crash if the system refuses a resource
  if (end.cause != ProcessExit::Cause::exited || end.code != 0)
    return cannot_write(path_,
                        fmt::format("the program catena-write failed ({}){}",
                                    end.cause == ProcessExit::Cause::exited ? fmt::format("code {}", end.code) : ::strsignal(end.code),
                                    limits.empty() ? "" : ": " + limits),
                        true);
  if (has_failed_) return cannot_write(path_, "the program catena-write ended too early", true);
  return file_.commit();
}

}  // namespace catena::field
