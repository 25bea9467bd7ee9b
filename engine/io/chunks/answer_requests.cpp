// SPDX-License-Identifier: MIT
#include "engine/io/chunks/answer_requests.h"
#include "engine/base/memory_limit.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <vector>

#include "engine/base/text.h"
#include "engine/field/bricks/brick_source.h"
#include "engine/field/number_type.h"
#include "engine/io/chunks/open_store.h"
#include "engine/io/sandbox/sandbox.h"

namespace catena::chunks {
namespace {

namespace fs = std::filesystem;
using field::StoreAction;
using field::StoreAnswer;
using field::StoreRequest;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::uint64_t kSlower = 20;  // slowdown caused by the sanitizers
#else
constexpr std::uint64_t kSlower = 1;
#endif

/// Allows this much more CPU time, for one request.
void allow_cpu_time(std::uint64_t seconds) {
  timespec used{};
  rlimit limit{};
  if (::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used) != 0 || ::getrlimit(RLIMIT_CPU, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(static_cast<rlim_t>(used.tv_sec) + 1 + seconds * kSlower, limit.rlim_max);
  ::setrlimit(RLIMIT_CPU, &limit);
}

class Answers {
 public:
  explicit Answers(std::span<std::byte> memory) : memory_(memory) {}

  /// Opens the store and enters the sandbox, in this order: the folder that may be read is that of the store.
  Result<std::uint64_t> open(const StoreRequest& request, const std::string& path) {
    if (store_ != nullptr) return Error{path + ": a store is open already"};
    std::error_code code;
    const fs::path full = fs::canonical(path, code);
    if (code) return Error{path + ": cannot be opened (" + code.message() + ")"};
    const bool is_folder = fs::is_directory(full, code);
    const fs::path folder = is_folder ? full : full.parent_path();
    bool root_changed = false;
    constexpr std::uint64_t kMaxCpuS = 10'000'000;
    sandbox::ProcessLimits limits{request.memory_bytes, request.cpu_s * kSlower, kMaxCpuS, true, folder.string()};
    limits.ends_with_starter = false;
    if (const auto confined = sandbox::enter_sandbox(limits, &root_changed); !confined)
      return Error{path + ": cannot be read safely: " + confined.error().message, true};
    const fs::path seen = root_changed ? fs::path("/") : folder;
    CATENA_TRY(store_, open_store({path, (is_folder ? seen : seen / full.filename()).string()}, request.layout));
    const std::string text = encode(store_->description());
    if (text.size() > memory_.size()) return Error{path + ": its description is too large"};
    std::memcpy(memory_.data(), text.data(), text.size());
    return std::uint64_t{text.size()};
  }

  Result<std::uint64_t> read(const StoreRequest& request) {
    CATENA_TRY(const field::StoreGrid* grid, find(request));
    const field::Index3& size = grid->levels[static_cast<std::size_t>(request.level)].size;
    const int lo[3] = {request.box.lo.x, request.box.lo.y, request.box.lo.z};
    const int voxels[3] = {request.box.size.x, request.box.size.y, request.box.size.z}, all[3] = {size.x, size.y, size.z};
    for (int a = 0; a < 3; ++a)
      if (lo[a] < 0 || voxels[a] < 1 || voxels[a] > all[a] || lo[a] > all[a] - voxels[a])
        return Error{"the request is outside of the grid"};
    const double bytes = request.box.voxels() * static_cast<double>(field::find_number_type(grid->type)->bytes);
    if (bytes > static_cast<double>(memory_.size())) return Error{"the request is too large"};
    const auto count = static_cast<std::size_t>(bytes);
    CATENA_CHECK(store_->read(request, memory_.first(count)));
    return std::uint64_t{count};
  }

  Result<std::uint64_t> list(const StoreRequest& request) {
    CATENA_TRY(const field::StoreGrid* grid, find(request));
    const field::StoreLevel& level = grid->levels[static_cast<std::size_t>(request.level)];
    const field::Index3 n = field::brick_counts({level.size, level.mapping});
    const double bricks = static_cast<double>(n.x) * n.y * n.z;
    if (bricks > static_cast<double>(memory_.size())) return Error{"the request is too large"};
    const std::span<std::byte> out = memory_.first(static_cast<std::size_t>(bricks));
    std::ranges::fill(out, std::byte{0});
    CATENA_CHECK(store_->list(request, {reinterpret_cast<std::uint8_t*>(out.data()), out.size()}));
    return std::uint64_t{out.size()};
  }

 private:
  Result<const field::StoreGrid*> find(const StoreRequest& request) const {
    if (store_ == nullptr) return Error{"no store is open"};
    const auto& grids = store_->description().grids;
    if (request.grid < 0 || static_cast<std::size_t>(request.grid) >= grids.size()) return Error{"there is no such grid"};
    const field::StoreGrid& grid = grids[static_cast<std::size_t>(request.grid)];
    if (request.level < 0 || static_cast<std::size_t>(request.level) >= grid.levels.size()) return Error{"there is no such level"};
    if (request.step < 0) return Error{"there is no such time step"};
    return &grid;
  }

  std::span<std::byte> memory_;
  std::unique_ptr<OpenStore> store_;
};

Result<std::uint64_t> answer(Answers& answers, const StoreRequest& request, const std::string& path) {
  try {
    switch (request.action) {
      case StoreAction::open:
        return answers.open(request, path);
      case StoreAction::read:
        return answers.read(request);
      case StoreAction::list:
        return answers.list(request);
    }
    return Error{"the request is unknown"};
  } catch (const std::bad_alloc&) {
    return Error{"there is not enough memory to decode the data, or they are damaged"};
  } catch (const std::exception& e) {
    return Error{std::string("the data are damaged (") + e.what() + ")"};
  }
}

}  // namespace

int answer_requests() {
  retain_freed_memory();  // each request allocates and frees chunks
  void* start = ::mmap(nullptr, field::kStoreMemoryBytes, PROT_READ | PROT_WRITE, MAP_SHARED, field::kStoreMemoryFd, 0);
  if (start == MAP_FAILED) return 2;
  Answers answers({static_cast<std::byte*>(start), field::kStoreMemoryBytes});
  std::vector<char> packet(field::kMaxStorePacket);
  for (bool is_first = true;; is_first = false) {
    const ssize_t got = ::recv(field::kStoreSocketFd, packet.data(), packet.size(), 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return got < 0 && is_first ? 2 : 0;
    StoreRequest request;
    if (static_cast<std::size_t>(got) < sizeof request) return 2;
    std::memcpy(&request, packet.data(), sizeof request);
    if (request.version != field::kStoreProtocolVersion || request.path_bytes != static_cast<std::size_t>(got) - sizeof request) return 2;
    if (!is_first) allow_cpu_time(request.cpu_s);
    const auto result = answer(answers, request, std::string(packet.data() + sizeof request, request.path_bytes));
    StoreAnswer head;
    std::string message;
    if (result) {
      head.bytes = *result;
    } else {
      head.failed = 1;
      head.system_failure = result.error().system_failure ? 1 : 0;
      message = truncate_utf8(one_line(result.error().message), field::kMaxStoreMessage);
    }
    message.insert(0, reinterpret_cast<const char*>(&head), sizeof head);
    if (::send(field::kStoreSocketFd, message.data(), message.size(), MSG_NOSIGNAL) < 0) return 0;
  }
}

}  // namespace catena::chunks
