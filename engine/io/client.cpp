// SPDX-License-Identifier: MIT
#include "engine/io/client.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "engine/base/helper_process.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/io/formats.h"
#include "engine/io/volume/data_files.h"

namespace catena::field {
namespace {

bool write_at(int fd, std::uint64_t at, const void* data, std::size_t bytes) {
  const char* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t n = ::pwrite(fd, from, bytes, static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    from += n;
    at += static_cast<std::uint64_t>(n);
    bytes -= static_cast<std::size_t>(n);
  }
  return true;
}

Result<FileDescriptor> file_with_request(const ReadRequest& request) {
  const std::string text = encode(request);
  FileDescriptor file(::memfd_create("catena-read", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!file && is_too_many_open_files(errno))
    return Error{request.load_request.path + ": cannot be read: " + descriptor_limit_message(), true};
  MessageHeader head;
  head.offset = sizeof head;
  head.bytes = text.size();
  head.limit_is_address_space = memory_limit_is_address_space() ? 1 : 0;
  if (!file || !write_at(file.get(), 0, &head, sizeof head) || !write_at(file.get(), head.offset, text.data(), text.size()))
    return Error{fmt::format("{}: no memory to read it into ({})", request.load_request.path, describe_errno(errno)), true};
  return file;
}

bool is_folder(const std::string& path) {
  std::error_code code;
  return std::filesystem::is_directory(path, code);
}

bool is_vdb(const std::string& path) { return has_extension(path, ".vdb"); }

const char* wanted(const std::string& path) { return is_vdb(path) ? "expected a sound .vdb file" : "expected a sound file"; }

/// Size on which the limits of a file that names others, or of a folder, are based: all regular files of the folder, up to a maximum number
/// of entries.
std::uint64_t bytes_about(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMostEntries = 100'000;
  std::error_code code;
  fs::path folder(path);
  if (!fs::is_directory(folder, code)) folder = folder.parent_path();
  if (folder.empty()) folder = ".";
  std::uint64_t bytes = 0;
  int entries = 0;
  for (fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, code), end; !code && at != end;
       at.increment(code)) {
    if (++entries > kMostEntries) break;
    std::error_code ignored;
    if (at->is_regular_file(ignored)) bytes += at->file_size(ignored);
  }
  return bytes;
}

/// CPU time limit of a reader, in seconds. Resampling can cost more than the size of the file suggests.
std::uint64_t time_for(const std::string& path, std::uint64_t bytes) {
  constexpr std::uint64_t kLeast = 120, kBytesPerSecond = 1'000'000, kMost = 7200;
  if (is_vdb(path)) return read_cpu_limit_s(bytes);
  return std::min(kMost, kLeast + std::max(bytes, bytes_about(path)) / kBytesPerSecond);
}

Result<std::string> program_for(const std::string& path) {
  if (!reader_settings().program.empty()) return reader_settings().program;
  if (is_vdb(path) || has_extension(path, ".npy")) return helper_path("catena-read");
  std::string program = helper_path("catena-read-vtk");
  if (!std::filesystem::exists(program))
    return Error{path + ": cannot be read: " + program +
                     ", the part of Catena that reads it, is missing: expected the package catena, or a build with the packages "
                     "libvtk9-dev and libinsighttoolkit5-dev",
                 true};
  return program;
}

std::string how_it_ended(const ProcessExit& end) {
  return end.cause == ProcessExit::Cause::killed ? ::strsignal(end.code) : fmt::format("code {}", end.code);
}

ReaderState state_of(const FileDescriptor& file) {
  MessageHeader head;
  const bool read = ::pread(file.get(), &head, sizeof head, 0) == static_cast<ssize_t>(sizeof head);
  return read ? head.state : ReaderState::not_started;
}

/// Message if the system is the reason why a reader did not respond; empty if it is not. If a resource limit is set in the shell, a refused
/// allocation is attributed to it; without one, the request came from the file.
std::string machines_part(ReaderState state, const ProcessExit& end) {
  const std::string limits = describe_resource_limits();
  switch (state) {
    case ReaderState::not_started:
      return fmt::format("its reader could not be started ({}){}", how_it_ended(end),
                         resource_limit(RLIMIT_AS)                 ? ": a library is missing, or: " + describe_errno(ENOMEM)
                         : end.cause == ProcessExit::Cause::exited ? ": a library is missing"
                                                                   : "");
    case ReaderState::no_thread:
      return "its reader: no other thread can be started: " + describe_errno(EAGAIN);
    case ReaderState::no_stack:
      return "its reader: no memory for another thread: " +
             (resource_limit(RLIMIT_AS) ? describe_errno(ENOMEM) : std::string("--memory MB allows more"));
    case ReaderState::no_memory:
      return resource_limit(RLIMIT_AS) ? "there is not enough memory to read it: " + describe_errno(ENOMEM) : "";
    case ReaderState::no_room:
      return limits.empty() ? "" : "there is no room to read it into: " + limits;
    case ReaderState::refused_memory:
    case ReaderState::reading:
      break;
  }
  // a failed allocation in a C library leaves no reader state
  const bool broke = end.cause == ProcessExit::Cause::killed && (end.code == SIGABRT || end.code == SIGSEGV || end.code == SIGBUS);
  return broke && resource_limit(RLIMIT_AS)
             ? fmt::format("its reader broke down ({}): it had too little memory, or the file is damaged; {}", how_it_ended(end), limits)
             : "";
}

/// The error for a reader that did not respond.
Error end_of(const ReadRequest& request, const ProcessExit& end, ReaderState state) {
  const std::string& path = request.load_request.path;
  const auto own_time = resource_limit(RLIMIT_CPU);
  if (end.cause == ProcessExit::Cause::killed && end.code == SIGXCPU && own_time && *own_time < request.cpu_s)
    return Error{
        fmt::format("{}: reading it took more than the {} s of processor time that this process may take (ulimit -t)", path, *own_time),
        true};
  const bool out_of_time = end.cause == ProcessExit::Cause::timed_out || (end.cause == ProcessExit::Cause::killed && end.code == SIGXCPU);
  if (out_of_time)
    return Error{
        fmt::format("{}: reading it took more than {:.0f} s of processor time, which is too long for its size: the file is damaged, {}",
                    path, std::max(1.0, std::floor(end.cpu_s)), wanted(path))};
  if (end.cause == ProcessExit::Cause::killed && (end.code == SIGINT || end.code == SIGTERM || end.code == SIGHUP))
    return Error{fmt::format("{}: reading it was interrupted, expected it to end by itself", path), true};
  if (const std::string why = machines_part(state, end); !why.empty()) return Error{path + ": " + why, true};
  if (end.cause == ProcessExit::Cause::killed && end.code == SIGKILL)
    return Error{fmt::format("{}: its reader was killed (by hand, or as memory ran out), expected it to end by itself", path), true};
  if (end.cause == ProcessExit::Cause::killed)
    return Error{fmt::format("{}: the file is damaged (its reader broke down: {}), {}", path, ::strsignal(end.code), wanted(path))};
  return Error{fmt::format("{}: the file is damaged (its reader gave up with code {}), {}", path, end.code, wanted(path))};
}

/// Seals the shared memory file. While a writable mapping is still being torn down the system reports "busy": retries for at most a second.
bool seal(const FileDescriptor& file) {
  constexpr int kTries = 100;
  for (int tries = 0; tries < kTries; ++tries) {
    if (::fcntl(file.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL) == 0) return true;
    if (errno != EBUSY) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

/// Seals and maps the response. The reader has ended, and a sealed file can no longer be changed.
Result<MappedResponse> take_answer(const std::string& path, const FileDescriptor& file) {
  struct stat status {};
  if (!seal(file) || ::fstat(file.get(), &status) != 0) return damaged_response_error(path, "the memory cannot be sealed");
  const auto bytes = static_cast<std::uint64_t>(status.st_size);
  MessageHeader head;
  if (bytes < sizeof head) return damaged_response_error(path, "the head is missing");
  void* start = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file.get(), 0);
  if (start == MAP_FAILED) return Error{fmt::format("{}: no memory to map it ({})", path, describe_errno(errno)), true};
  MappedResponse answer;
  answer.memory = NanoMemory::from_mapping(start, bytes, true);
  std::memcpy(&head, start, sizeof head);
  if (head.magic != kProtocolMagic || head.version != kProtocolVersion || head.from_reader != 1 || head.offset > bytes ||
      head.bytes > bytes - head.offset)
    return damaged_response_error(path, "the head is not one");
  auto reply = decode_response({answer.memory.data() + head.offset, head.bytes});
  if (!reply) return damaged_response_error(path, reply.error().message);
  answer.response = std::move(*reply);
  return answer;
}

// ---- cached metadata of files, valid while the file is unchanged ----

struct Known {
  std::filesystem::file_time_type at;
  std::uintmax_t bytes = 0;
  ReadResponse words;
};
std::mutex known_mutex;
std::map<std::string, Known> known_words;

/// Reads time and size of the file. For an OpenFOAM case they change with its time folders.
bool look_at(const std::string& path, Known& file) {
  std::error_code code;
  file.at = std::filesystem::last_write_time(path, code);
  if (const std::filesystem::path folder = openfoam_case_folder(path); !code && !folder.empty()) {
    for (const auto& one : {folder, folder / "processor0"}) {
      std::error_code ignored;
      const auto changed = std::filesystem::last_write_time(one, ignored);
      if (!ignored) file.at = std::max(file.at, changed);
    }
  }
  if (!code && !is_folder(path)) file.bytes = std::filesystem::file_size(path, code);
  return !code;
}

void keep_words(const std::string& path, const Known& before, const ReadResponse& reply) {
  Known entry = before;
  entry.words.units = reply.units;
  entry.words.unit_length = reply.unit_length;
  entry.words.is_patient_space = reply.is_patient_space;
  entry.words.grid_metadata = reply.grid_metadata;
  entry.words.primitives = reply.primitives;
  entry.words.times = reply.times;
  const std::scoped_lock lock(known_mutex);
  constexpr std::size_t kMost = 256;
  if (known_words.size() >= kMost) known_words.clear();
  known_words[path] = std::move(entry);
}

// ---- files that the readers opened, by requested path ----

std::map<std::string, std::set<FileId>> opened_for;

void keep_opened(const std::string& path, const std::vector<FileId>& files) {
  register_inputs(files);
  const std::scoped_lock lock(known_mutex);
  opened_for[path].insert(files.begin(), files.end());
}

}  // namespace

Error damaged_response_error(const std::string& path, std::string_view what) {
  return Error{fmt::format("{}: the file is damaged (of what its reader made of it, {}), {}", path, what, wanted(path))};
}

ReaderSettings& reader_settings() {
  static ReaderSettings settings;
  return settings;
}

std::uint64_t read_cpu_limit_s(std::uint64_t file_bytes) {
  constexpr std::uint64_t kLeast = 10, kBytesPerSecond = 2'000'000;
  return kLeast + file_bytes / kBytesPerSecond;
}

static ReadProgress while_reading;
void set_read_progress(ReadProgress called) { while_reading = std::move(called); }

Result<MappedResponse> run_reader(ReadMode mode, const LoadRequest& what) {
  std::uint64_t size = 0;
  // an OpenFOAM case is the folder: the .foam file in it is only a marker, usually empty
  const bool names_folder = has_extension(what.path, ".foam") && std::filesystem::is_regular_file(what.path);
  if (!is_folder(what.path) && !names_folder) {
    CATENA_TRY(size, readable_file_size(what.path));
  }
  CATENA_TRY(const std::string program, program_for(what.path));
  const ReaderSettings& settings = reader_settings();
  ReadRequest request{mode, what, settings.memory_bytes > 0 ? settings.memory_bytes : available_memory(), memory_limit().value_or(0),
                      settings.cpu_s > 0 ? settings.cpu_s : time_for(what.path, size)};
  Known before;
  const bool can_keep = look_at(what.path, before);
  // run the reader
  CATENA_TRY(FileDescriptor file, file_with_request(request));
  const int given[] = {file.get()};
  auto reader = HelperProcess::start(program, given);
  if (!reader) return Error{what.path + ": cannot be read: " + reader.error().message, reader.error().system_failure};
  // a sleeping reader uses no CPU time: disks may be slow, but the wait is limited
  constexpr double kLeastWait = 60, kWaits = 10;
  const double wall_s = settings.wall_s > 0 ? settings.wall_s : std::max(kLeastWait, kWaits * static_cast<double>(request.cpu_s));
  const ProcessExit end = reader->wait(wall_s, [&](double seconds) {
    if (while_reading) while_reading(what.path, seconds, false);
  });
  if (while_reading) while_reading(what.path, 0, true);
  if (end.cause != ProcessExit::Cause::exited || end.code != 0) return end_of(request, end, state_of(file));
  // take the response
  CATENA_TRY(MappedResponse answer, take_answer(what.path, file));
  keep_opened(what.path, answer.response.opened_files);
  constexpr std::size_t kLongestError = 2000;
  if (!answer.response.error.empty()) {
    const ReaderState state = state_of(file);
    const std::string why = machines_part(state, end);
    if (!why.empty()) return Error{what.path + ": " + why, true};
    return Error{one_line(answer.response.error.substr(0, kLongestError)),
                 state == ReaderState::refused_memory && memory_limit_is_address_space()};
  }
  if (can_keep) keep_words(what.path, before, answer.response);
  return answer;
}

Result<std::vector<GridInfo>> describe_with_reader(const std::string& path, int step) {
  LoadRequest request;
  request.path = path;
  request.step = step;
  CATENA_TRY(MappedResponse answer, run_reader(ReadMode::describe, request));
  for (const GridInfo& grid : answer.response.grids) {
    if (!grid.mapping.is_invertible()) return damaged_response_error(path, "a transform cannot be inverted");
    if (grid.size.x < 0 || grid.size.y < 0 || grid.size.z < 0) return damaged_response_error(path, "a size is negative");
  }
  return std::move(answer.response.grids);
}

std::set<FileId> files_opened_by_readers(const std::string& path) {
  const std::scoped_lock lock(known_mutex);
  return opened_for[path];
}

std::optional<ReadResponse> read_file_metadata(const std::string& path) {
  Known now;
  if (!look_at(path, now)) return std::nullopt;
  {
    const std::scoped_lock lock(known_mutex);
    const auto found = known_words.find(path);
    if (found != known_words.end() && found->second.at == now.at && found->second.bytes == now.bytes) return found->second.words;
  }
  LoadRequest request;
  request.path = path;
  auto answer = run_reader(ReadMode::metadata, request);
  if (!answer) return std::nullopt;
  return std::move(answer->response);
}

}  // namespace catena::field
