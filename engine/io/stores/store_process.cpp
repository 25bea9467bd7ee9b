// SPDX-License-Identifier: MIT
#include "engine/io/stores/store_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/memory_limit.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/io/client.h"
#include "engine/io/volume/volume_reader.h"

namespace catena::field {
namespace {

/// Limits of one request: a chunk has at most 512 MB.
constexpr std::uint64_t kRequestCpuS = 30;
constexpr double kRequestWallS = 120;
constexpr std::uint64_t kMaxReaderBytes = std::uint64_t{2} << 30;

Result<std::string> reader_program(const std::string& path) {
  if (!reader_settings().program.empty()) return reader_settings().program;
  std::string program = helper_path("catena-read-chunks");
  if (!std::filesystem::exists(program))
    return Error{path + ": cannot be read: " + program +
                     ", the program that reads this format, is missing: expected the package catena, or a build with the packages "
                     "libblosc-dev, liblz4-dev, libzstd-dev, libdeflate-dev, libtiff-dev, libhdf5-dev and libexpat1-dev",
                 true};
  return program;
}

/// Shared memory of a fixed size, which the reader cannot change.
Result<FileDescriptor> make_memory(const std::string& path) {
  FileDescriptor memory(::memfd_create("catena-read-chunks", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!memory && is_too_many_open_files(errno)) return Error{path + ": cannot be read: " + descriptor_limit_message(), true};
  if (!memory || ::ftruncate(memory.get(), static_cast<off_t>(kStoreMemoryBytes)) != 0 ||
      ::fcntl(memory.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
    return Error{fmt::format("{}: there is not enough memory to read the store ({})", path, describe_errno(errno)), true};
  return memory;
}

}  // namespace

StoreProcess::StoreProcess(StoreProcess&& other) noexcept
    : path_(std::move(other.path_)),
      process_(std::move(other.process_)),
      socket_(std::move(other.socket_)),
      memory_(std::exchange(other.memory_, {})),
      description_(std::move(other.description_)) {
  other.process_.reset();
}

StoreProcess::~StoreProcess() {
  if (!memory_.empty()) ::munmap(const_cast<std::byte*>(memory_.data()), memory_.size());
}

Result<StoreProcess> StoreProcess::start(const std::string& path, const ArrayLayout& layout) {
  std::error_code code;
  if (!std::filesystem::is_directory(path, code)) CATENA_CHECK(readable_file_size(path));
  CATENA_TRY(const std::string program, reader_program(path));
  CATENA_TRY(FileDescriptor memory, make_memory(path));
  int ends[2] = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
    return Error{fmt::format("{}: cannot be read: no connection to the reader ({})", path, describe_errno(errno)), true};
  FileDescriptor own(ends[0]), other(ends[1]);
  void* start = ::mmap(nullptr, kStoreMemoryBytes, PROT_READ, MAP_SHARED, memory.get(), 0);
  if (start == MAP_FAILED)
    return Error{fmt::format("{}: there is not enough memory to read the store ({})", path, describe_errno(errno)), true};
  const std::span<const std::byte> mapped(static_cast<const std::byte*>(start), kStoreMemoryBytes);
  const int descriptors[] = {memory.get(), other.get()};
  auto process = HelperProcess::start(program, descriptors);
  if (!process) {
    ::munmap(start, kStoreMemoryBytes);
    return Error{path + ": cannot be read: " + process.error().message, process.error().system_failure};
  }
  other.close();
  StoreProcess reader(path, std::move(*process), std::move(own), mapped);
  StoreRequest request;
  request.layout = layout;
  const ReaderSettings& settings = reader_settings();
  request.memory_bytes = settings.memory_bytes > 0 ? settings.memory_bytes : std::min(kMaxReaderBytes, available_memory());
  CATENA_TRY(const std::uint64_t bytes, reader.exchange(request, path));
  // a copy: the reader can change the shared memory at any time
  const std::vector<std::byte> text(mapped.begin(), mapped.begin() + static_cast<std::ptrdiff_t>(bytes));
  auto description = decode_store(text);
  if (!description) return damaged_response_error(path, description.error().message);
  reader.description_ = std::move(*description);
  return reader;
}

Result<std::span<const std::byte>> StoreProcess::ask(const StoreRequest& request, std::uint64_t bytes) {
  CATENA_TRY(const std::uint64_t got, exchange(request, {}));
  if (got == bytes) return memory_.first(bytes);
  process_.reset();
  return damaged_response_error(path_, "the size is wrong");
}

Result<std::uint64_t> StoreProcess::exchange(const StoreRequest& what, const std::string& text) {
  StoreRequest request = what;
  const ReaderSettings& settings = reader_settings();
  request.cpu_s = settings.cpu_s > 0 ? settings.cpu_s : kRequestCpuS;
  request.path_bytes = static_cast<std::uint32_t>(text.size());
  std::string packet(reinterpret_cast<const char*>(&request), sizeof request);
  packet += text;
  if (packet.size() > kMaxStorePacket) return Error{path_ + ": the path is too long"};
  if (::send(socket_.get(), packet.data(), packet.size(), MSG_NOSIGNAL) < 0) return end(request, false);
  std::vector<char> answer(kMaxStorePacket);
  const double wall_s = settings.wall_s > 0 ? settings.wall_s : kRequestWallS;
  const std::int64_t until = now_ns() + static_cast<std::int64_t>(1e9 * wall_s);
  for (;;) {
    pollfd poller{socket_.get(), POLLIN, 0};
    const std::int64_t left_ms = (until - now_ns()) / 1'000'000;
    const int ready = left_ms <= 0 ? 0 : ::poll(&poller, 1, static_cast<int>(std::min<std::int64_t>(left_ms + 1, 1'000'000)));
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) return end(request, true);
    break;
  }
  const ssize_t got = ::recv(socket_.get(), answer.data(), answer.size(), 0);
  StoreAnswer head;
  if (got < static_cast<ssize_t>(sizeof head)) return end(request, false);
  std::memcpy(&head, answer.data(), sizeof head);
  if (head.version != kStoreProtocolVersion || head.bytes > kStoreMemoryBytes) {
    process_.reset();
    return damaged_response_error(path_, "the header is invalid");
  }
  if (head.failed == 0) return head.bytes;
  std::string message(answer.data() + sizeof head, static_cast<std::size_t>(got) - sizeof head);
  message = one_line(message.substr(0, kMaxStoreMessage));
  if (!message.starts_with(path_)) message.insert(0, path_ + ": ");
  return Error{message, head.system_failure != 0};
}

/// Ends the reader; returns the Error for its end.
Error StoreProcess::end(const StoreRequest& request, bool has_timed_out) {
  constexpr double kPatienceS = 5;
  const ProcessExit exit = process_->wait(has_timed_out ? 0 : kPatienceS);
  process_.reset();
  if (has_timed_out || exit.cause == ProcessExit::Cause::timed_out || (exit.cause == ProcessExit::Cause::killed && exit.code == SIGXCPU))
    return Error{fmt::format("{}: the reader process did not answer in time: the data are damaged, or the disk does not answer", path_)};
  if (exit.cause == ProcessExit::Cause::killed && (exit.code == SIGKILL || exit.code == SIGINT || exit.code == SIGTERM))
    return Error{fmt::format("{}: the reader process was killed (by a user, or because memory ran out), expected it to finish", path_),
                 true};
  if (exit.cause == ProcessExit::Cause::killed)
    return Error{fmt::format("{}: the data are damaged (the reader process crashed: {}), expected an undamaged store", path_,
                             ::strsignal(exit.code))};
  if (request.action == StoreAction::open && exit.code != 0)
    return Error{fmt::format("{}: the reader process could not be started (code {}): a library is missing", path_, exit.code), true};
  return Error{fmt::format("{}: the reader process ended with code {}, expected an answer", path_, exit.code)};
}

}  // namespace catena::field
