// SPDX-License-Identifier: MIT
/// One reader process of a store, and the connection to it. Used by one thread at a time.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "engine/base/helper_process.h"
#include "engine/io/stores/store_protocol.h"

namespace catena::field {

/// A running reader. The destructor ends it.
class StoreProcess {
 public:
  /// Starts a reader and opens the store; the description is that of the reader, validated. The Error is a complete message.
  static Result<StoreProcess> start(const std::string& path, const ArrayLayout& layout);
  StoreProcess(StoreProcess&& other) noexcept;
  StoreProcess& operator=(StoreProcess&&) = delete;
  ~StoreProcess();

  /// Returns the description of the store.
  const StoreDescription& description() const { return description_; }
  /// Sends a request and waits for the answer, whose contents in the shared memory must have `bytes` bytes. Returns these bytes, which are
  /// valid until the next request and untrusted.
  Result<std::span<const std::byte>> ask(const StoreRequest& request, std::uint64_t bytes);
  /// Returns whether the reader has ended or was ended, by a crash, a limit or a wrong answer; another one may succeed.
  bool has_ended() const { return !process_; }

 private:
  StoreProcess(std::string path, HelperProcess process, FileDescriptor socket, std::span<const std::byte> memory)
      : path_(std::move(path)), process_(std::move(process)), socket_(std::move(socket)), memory_(memory) {}
  Result<std::uint64_t> exchange(const StoreRequest& request, const std::string& text);
  Error end(const StoreRequest& request, bool has_timed_out);

  std::string path_;
  std::optional<HelperProcess> process_;
  FileDescriptor socket_;
  std::span<const std::byte> memory_;
  StoreDescription description_;
};

}  // namespace catena::field
