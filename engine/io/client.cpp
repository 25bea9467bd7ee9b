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
    return Error{fmt::format("{}: there is not enough memory to read the file ({})", request.load_request.path, describe_errno(errno)),
                 true};
  return file;
}

bool is_folder(const std::string& path) {
  std::error_code code;
  return std::filesystem::is_directory(path, code);
}

bool is_vdb(const std::string& path) { return has_extension(path, ".vdb"); }

const char* expected_file(const std::string& path) {
  return is_vdb(path) ? "expected an undamaged .vdb file" : "expected an undamaged file";
}

/// Returns the size on which the limits of a file that names others, or of a folder, are based: all regular files of the folder, up to a
/// maximum number of entries.
std::uint64_t limiting_bytes(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMaxFolderEntries = 100'000;
  std::error_code code;
  fs::path folder(path);
  if (!fs::is_directory(folder, code)) folder = folder.parent_path();
  if (folder.empty()) folder = ".";
  std::uint64_t bytes = 0;
  int entries = 0;
  for (fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, code), end; !code && at != end;
       at.increment(code)) {
    if (++entries > kMaxFolderEntries) break;
    std::error_code ignored;
    if (at->is_regular_file(ignored)) bytes += at->file_size(ignored);
  }
  return bytes;
}

/// Returns the CPU time limit of a reader, in seconds. Resampling can cost more than the size of the file suggests.
std::uint64_t cpu_limit_for(const std::string& path, std::uint64_t bytes) {
  constexpr std::uint64_t kMinCpuS = 120, kBytesPerSecond = 1'000'000, kMaxCpuS = 7200;
  if (is_vdb(path)) return read_cpu_limit_s(bytes);
  return std::min(kMaxCpuS, kMinCpuS + std::max(bytes, limiting_bytes(path)) / kBytesPerSecond);
}

Result<std::string> program_for(const std::string& path) {
  if (!reader_settings().program.empty()) return reader_settings().program;
  if (is_vdb(path) || has_extension(path, ".npy")) return helper_path("catena-read");
  std::string program = helper_path("catena-read-vtk");
  if (!std::filesystem::exists(program))
    return Error{path + ": cannot be read: " + program +
                     ", the program that reads this format, is missing: expected the package catena, or a build with the packages "
                     "libvtk9-dev and libinsighttoolkit5-dev",
                 true};
  return program;
}

std::string describe_end(const ProcessExit& end) {
  return end.cause == ProcessExit::Cause::killed ? ::strsignal(end.code) : fmt::format("code {}", end.code);
}

ReaderState state_of(const FileDescriptor& file) {
  MessageHeader head;
  const bool read = ::pread(file.get(), &head, sizeof head, 0) == static_cast<ssize_t>(sizeof head);
  return read ? head.state : ReaderState::not_started;
}

/// Returns a message if a reader did not respond because of the system; empty if the system is not the reason. A refused allocation is
/// attributed to a resource limit of the shell if there is one, otherwise to the file.
std::string system_cause(ReaderState state, const ProcessExit& end) {
  const std::string limits = describe_resource_limits();
  switch (state) {
    case ReaderState::not_started:
      return fmt::format("the reader process could not be started ({}){}", describe_end(end),
                         resource_limit(RLIMIT_AS)                 ? ": a library is missing, or " + describe_errno(ENOMEM)
                         : end.cause == ProcessExit::Cause::exited ? ": a library is missing"
                                                                   : "");
    case ReaderState::no_thread:
      return "the reader process: no other thread can be started: " + describe_errno(EAGAIN);
    case ReaderState::no_stack:
      return "the reader process: there is no memory for another thread: " +
             (resource_limit(RLIMIT_AS) ? describe_errno(ENOMEM) : std::string("--memory MB allows more"));
    case ReaderState::no_memory:
      return resource_limit(RLIMIT_AS) ? "there is not enough memory to read the file: " + describe_errno(ENOMEM) : "";
    case ReaderState::out_of_space:
      return limits.empty() ? "" : "the shared memory for reading the file cannot grow: " + limits;
    case ReaderState::refused_memory:
    case ReaderState::reading:
      break;
  }
  // a failed allocation in a C library leaves no reader state
  const bool crashed = end.cause == ProcessExit::Cause::killed && (end.code == SIGABRT || end.code == SIGSEGV || end.code == SIGBUS);
  return crashed && resource_limit(RLIMIT_AS)
             ? fmt::format("the reader process crashed ({}): it had too little memory, or the file is damaged; {}", describe_end(end),
                           limits)
             : "";
}

/// Returns the Error for a reader that did not respond.
Error end_of(const ReadRequest& request, const ProcessExit& end, ReaderState state) {
  const std::string& path = request.load_request.path;
  const auto own_time = resource_limit(RLIMIT_CPU);
  if (end.cause == ProcessExit::Cause::killed && end.code == SIGXCPU && own_time && *own_time < request.cpu_s)
    return Error{
        fmt::format("{}: reading the file took more than the {} s of processor time that the shell allows (ulimit -t)", path, *own_time),
        true};
  const bool out_of_time = end.cause == ProcessExit::Cause::timed_out || (end.cause == ProcessExit::Cause::killed && end.code == SIGXCPU);
  if (out_of_time)
    return Error{
        fmt::format("{}: reading the file took more than {:.0f} s of processor time, too long for the file's size: the file is damaged, {}",
                    path, std::max(1.0, std::floor(end.cpu_s)), expected_file(path))};
  if (end.cause == ProcessExit::Cause::killed && (end.code == SIGINT || end.code == SIGTERM || end.code == SIGHUP))
    return Error{fmt::format("{}: the reader process was interrupted, expected it to finish", path), true};
  if (const std::string cause = system_cause(state, end); !cause.empty()) return Error{path + ": " + cause, true};
  if (end.cause == ProcessExit::Cause::killed && end.code == SIGKILL)
    return Error{fmt::format("{}: the reader process was killed (by a user, or because memory ran out), expected it to finish", path),
                 true};
  if (end.cause == ProcessExit::Cause::killed)
    return Error{
        fmt::format("{}: the file is damaged (the reader process crashed: {}), {}", path, ::strsignal(end.code), expected_file(path))};
  return Error{fmt::format("{}: the file is damaged (the reader process ended with code {}), {}", path, end.code, expected_file(path))};
}

/// Seals the shared memory file. The system reports "busy" while it removes a writable mapping: retries for at most a second.
bool seal(const FileDescriptor& file) {
  constexpr int kTries = 100;
  for (int attempt = 0; attempt < kTries; ++attempt) {
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
  if (bytes < sizeof head) return damaged_response_error(path, "the header is missing");
  void* start = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file.get(), 0);
  if (start == MAP_FAILED)
    return Error{fmt::format("{}: there is not enough memory to map the data ({})", path, describe_errno(errno)), true};
  MappedResponse mapped;
  mapped.memory = NanoMemory::from_mapping(start, bytes, true);
  std::memcpy(&head, start, sizeof head);
  if (head.magic != kProtocolMagic || head.version != kProtocolVersion || head.from_reader != 1 || head.offset > bytes ||
      head.bytes > bytes - head.offset)
    return damaged_response_error(path, "the header is invalid");
  auto reply = decode_response({mapped.memory.data() + head.offset, head.bytes});
  if (!reply) return damaged_response_error(path, reply.error().message);
  mapped.response = std::move(*reply);
  return mapped;
}

// ---- cached metadata of files, valid while the file is unchanged ----

struct Known {
  std::filesystem::file_time_type at;
  std::uintmax_t bytes = 0;
  ReadResponse words;
};
std::mutex known_mutex;
std::map<std::string, Known> metadata_cache;

/// Reads time and size of the file. For an OpenFOAM case they change with its time folders.
bool read_file_state(const std::string& path, Known& file) {
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

void cache_metadata(const std::string& path, const Known& file_state, const ReadResponse& reply) {
  Known entry = file_state;
  entry.words.units = reply.units;
  entry.words.unit_length = reply.unit_length;
  entry.words.is_patient_space = reply.is_patient_space;
  entry.words.grid_metadata = reply.grid_metadata;
  entry.words.primitives = reply.primitives;
  entry.words.times = reply.times;
  const std::scoped_lock lock(known_mutex);
  constexpr std::size_t kMaxEntries = 256;
  if (metadata_cache.size() >= kMaxEntries) metadata_cache.clear();
  metadata_cache[path] = std::move(entry);
}

// ---- files that the readers opened, by requested path ----

std::map<std::string, std::set<FileId>> opened_by_path;

void record_opened_files(const std::string& path, const std::vector<FileId>& files) {
  register_inputs(files);
  const std::scoped_lock lock(known_mutex);
  opened_by_path[path].insert(files.begin(), files.end());
}

}  // namespace

Error damaged_response_error(const std::string& path, std::string_view what) {
  return Error{fmt::format("{}: the file is damaged (invalid response of the reader process: {}), {}", path, what, expected_file(path))};
}

ReaderSettings& reader_settings() {
  static ReaderSettings settings;
  return settings;
}

std::uint64_t read_cpu_limit_s(std::uint64_t file_bytes) {
  constexpr std::uint64_t kMinCpuS = 10, kBytesPerSecond = 2'000'000;
  return kMinCpuS + file_bytes / kBytesPerSecond;
}

static ReadProgress while_reading;
void set_read_progress(ReadProgress callback) { while_reading = std::move(callback); }

Result<MappedResponse> run_reader(ReadMode mode, const LoadRequest& what) {
  std::uint64_t size = 0;
  // the .foam file in the folder of an OpenFOAM case is only a marker, usually empty
  const bool names_folder = has_extension(what.path, ".foam") && std::filesystem::is_regular_file(what.path);
  if (!is_folder(what.path) && !names_folder) {
    CATENA_TRY(size, readable_file_size(what.path));
  }
  CATENA_TRY(const std::string program, program_for(what.path));
  const ReaderSettings& settings = reader_settings();
  ReadRequest request{mode, what, settings.memory_bytes > 0 ? settings.memory_bytes : available_memory(), memory_limit().value_or(0),
                      settings.cpu_s > 0 ? settings.cpu_s : cpu_limit_for(what.path, size)};
  Known file_state;
  const bool can_keep = read_file_state(what.path, file_state);
  // run the reader
  CATENA_TRY(FileDescriptor file, file_with_request(request));
  const int descriptors[] = {file.get()};
  auto reader = HelperProcess::start(program, descriptors);
  if (!reader) return Error{what.path + ": cannot be read: " + reader.error().message, reader.error().system_failure};
  // a reader that waits for a slow disk uses no CPU time: the wall time is limited, too
  constexpr double kMinWait = 60, kWaits = 10;
  const double wall_s = settings.wall_s > 0 ? settings.wall_s : std::max(kMinWait, kWaits * static_cast<double>(request.cpu_s));
  const ProcessExit end = reader->wait(wall_s, [&](double seconds) {
    if (while_reading) while_reading(what.path, seconds, false);
  });
  if (while_reading) while_reading(what.path, 0, true);
  if (end.cause != ProcessExit::Cause::exited || end.code != 0) return end_of(request, end, state_of(file));
  // take the response
  CATENA_TRY(MappedResponse mapped, take_answer(what.path, file));
  record_opened_files(what.path, mapped.response.opened_files);
  constexpr std::size_t kMaxError = 2000;
  if (!mapped.response.error.empty()) {
    const ReaderState state = state_of(file);
    const std::string cause = system_cause(state, end);
    if (!cause.empty()) return Error{what.path + ": " + cause, true};
    return Error{one_line(mapped.response.error.substr(0, kMaxError)),
                 state == ReaderState::refused_memory && memory_limit_is_address_space()};
  }
  if (can_keep) cache_metadata(what.path, file_state, mapped.response);
  return mapped;
}

Result<std::vector<GridInfo>> describe_with_reader(const std::string& path, int step) {
  LoadRequest request;
  request.path = path;
  request.step = step;
  CATENA_TRY(MappedResponse mapped, run_reader(ReadMode::describe, request));
  for (const GridInfo& grid : mapped.response.grids) {
    if (!grid.mapping.is_invertible()) return damaged_response_error(path, "a transform cannot be inverted");
    if (grid.size.x < 0 || grid.size.y < 0 || grid.size.z < 0) return damaged_response_error(path, "a size is negative");
  }
  return std::move(mapped.response.grids);
}

std::set<FileId> files_opened_by_readers(const std::string& path) {
  const std::scoped_lock lock(known_mutex);
  return opened_by_path[path];
}

std::optional<ReadResponse> read_file_metadata(const std::string& path) {
  Known now;
  if (!read_file_state(path, now)) return std::nullopt;
  {
    const std::scoped_lock lock(known_mutex);
    const auto found = metadata_cache.find(path);
    if (found != metadata_cache.end() && found->second.at == now.at && found->second.bytes == now.bytes) return found->second.words;
  }
  LoadRequest request;
  request.path = path;
  auto mapped = run_reader(ReadMode::metadata, request);
  if (!mapped) return std::nullopt;
  return std::move(mapped->response);
}

}  // namespace catena::field
