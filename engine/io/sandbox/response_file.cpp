// SPDX-License-Identifier: MIT
#include "engine/io/sandbox/response_file.h"

#include <sys/mman.h>
#include <unistd.h>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>
#include <vector>

#include "engine/base/memory_limit.h"
#include "engine/base/threads.h"

namespace catena::sandbox {
namespace {

constexpr std::uint64_t kMaxRequest = 1 << 20;

std::uint64_t aligned(std::uint64_t n) { return (n + field::kBufferAlignment - 1) / field::kBufferAlignment * field::kBufferAlignment; }

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

int noted_file = -1;

void on_no_memory() {
  ResponseFile(noted_file).report(field::ReaderState::no_memory);
  throw std::bad_alloc();
}

/// Reports an exception that cannot be caught, as in a thread that a library started.
[[noreturn]] void on_terminate_of_reader() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::exception& error) {
    ResponseFile(noted_file).report(error);
  } catch (...) {
  }
  std::abort();
}

}  // namespace

void ResponseFile::report(field::ReaderState state) const noexcept {
  [[maybe_unused]] const auto written = ::pwrite(fd_, &state, sizeof state, offsetof(field::MessageHeader, state));
}

void ResponseFile::report(const std::exception& thrown) const noexcept {
  if (is_thread_start_failure(thrown))
    report(thread_start_errno() == ENOMEM ? field::ReaderState::no_stack : field::ReaderState::no_thread);
}

void report_early_failures() noexcept {
  std::uint64_t magic = 0;
  if (::pread(kResponseFd, &magic, sizeof magic, offsetof(field::MessageHeader, magic)) != static_cast<ssize_t>(sizeof magic) ||
      magic != field::kProtocolMagic)
    return;
  noted_file = kResponseFd;
  std::set_new_handler(on_no_memory);
  std::set_terminate(on_terminate_of_reader);
}

Result<field::ReadRequest> ResponseFile::read_request() {
  field::MessageHeader head;
  if (::pread(fd_, &head, sizeof head, 0) != static_cast<ssize_t>(sizeof head) || head.magic != field::kProtocolMagic ||
      head.version != field::kProtocolVersion || head.from_reader != 0 || head.bytes > kMaxRequest)
    return Error{"the request is missing"};
  std::vector<std::byte> text(head.bytes);
  if (::pread(fd_, text.data(), text.size(), static_cast<off_t>(head.offset)) != static_cast<ssize_t>(text.size()))
    return Error{"the request is missing"};
  noted_file = fd_;
  report(field::ReaderState::reading);
  ::signal(SIGXFSZ, SIG_IGN);  // a file that cannot grow then fails as a response that cannot be written
  std::set_new_handler(on_no_memory);
  std::set_terminate(on_terminate_of_reader);
  auto request = field::decode_request(text);
  if (request) set_memory_limit(request->memory_bytes, head.limit_is_address_space != 0);
  return request;
}

field::NanoMemory ResponseFile::allocate(std::size_t bytes, field::BufferRange& piece) {
  piece = {end_, bytes};
  end_ = aligned(end_ + bytes);
  if (::ftruncate(fd_, static_cast<off_t>(end_)) != 0) {
    report(field::ReaderState::out_of_space);
    throw std::bad_alloc();
  }
  void* start = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, static_cast<off_t>(piece.offset));
  if (start == MAP_FAILED) on_no_memory();
  return field::NanoMemory::from_mapping(start, bytes, false);
}

bool ResponseFile::finish(const field::ReadResponse& reply) {
  const std::string text = encode(reply);
  field::MessageHeader head;
  head.from_reader = 1;
  head.offset = end_;
  head.bytes = text.size();
  field::MessageHeader old_head;
  if (::pread(fd_, &old_head, sizeof old_head, 0) == static_cast<ssize_t>(sizeof old_head)) head.state = old_head.state;
  if (head.state == field::ReaderState::reading && memory_refusal_count() > 0) head.state = field::ReaderState::refused_memory;
  const bool written = write_at(fd_, head.offset, text.data(), text.size()) && write_at(fd_, 0, &head, sizeof head);
  if (!written) report(field::ReaderState::out_of_space);
  return written;
}

}  // namespace catena::sandbox
