// SPDX-License-Identifier: MIT
#include "engine/io/stores/store.h"

#include <unistd.h>

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstring>
#include <list>
#include <utility>

#include "engine/base/input_files.h"
#include "engine/base/text.h"
#include "engine/field/bricks/brick_source.h"
#include "engine/io/formats.h"

namespace catena::field {
namespace {

/// State of the files that describe a store: an open store is used again while it is the same.
std::string state_of(const std::string& path) {
  std::string state;
  for (const char* name : {"", "/.zattrs", "/.zarray", "/.zgroup"}) {
    struct stat about {};
    if (::stat((path + name).c_str(), &about) == 0)
      state += fmt::format("{}:{}:{}:{};", about.st_dev, about.st_ino, about.st_size, modified_ns(about));
  }
  return state;
}

}  // namespace

Store::Store(StoreProcess first, std::string path, const ArrayLayout& layout)
    : path_(std::move(path)), layout_(layout), description_(first.description()), identity_(encode(description_)) {
  idle_.push_back(std::move(first));
}

Result<std::shared_ptr<Store>> Store::open(const std::string& path, bool is_input, const ArrayLayout& layout) {
  CATENA_TRY(StoreProcess first, StoreProcess::start(path, layout));
  if (is_input) register_inputs(first.description().opened_files);
  return std::shared_ptr<Store>(new Store(std::move(first), path, layout));
}

/// Takes an idle reader; empty: a new one is to be started.
Result<std::vector<StoreProcess>> Store::take_reader() {
  std::unique_lock lock(mutex_);
  returned_.wait(lock, [&] { return !idle_.empty() || readers_ < kReaders; });
  std::vector<StoreProcess> taken;
  if (idle_.empty()) {
    ++readers_;
    return taken;
  }
  taken.push_back(std::move(idle_.back()));
  idle_.pop_back();
  return taken;
}

void Store::give_back(std::vector<StoreProcess> reader) {
  const std::scoped_lock lock(mutex_);
  if (reader.empty() || reader.front().has_ended())
    --readers_;
  else
    idle_.push_back(std::move(reader.front()));
  returned_.notify_one();
}

Outcome Store::ask(const StoreRequest& request, std::span<std::byte> out) {
  CATENA_TRY(std::vector<StoreProcess> reader, take_reader());
  Outcome result = Done{};
  constexpr int kTries = 2;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    if (reader.empty()) {
      auto started = StoreProcess::start(path_, layout_);
      if (!started) {
        result = started.error();
        break;
      }
      if (encode(started->description()) != identity_) {
        result = Error{path_ + ": the store has changed since it was opened, expected the same contents"};
        break;
      }
      reader.push_back(std::move(*started));
    }
    const auto answer = reader.front().ask(request, out.size());
    if (answer) {
      std::memcpy(out.data(), answer->data(), out.size());
      result = Done{};
      break;
    }
    result = answer.error();
    if (!reader.front().has_ended()) break;
    reader.clear();
  }
  give_back(std::move(reader));
  return result;
}

Outcome Store::read(int grid, int level, int step, const StoreBox& box, std::span<std::byte> values) {
  // a chunk that is not there has the fill value, a store that is not there has none
  if (::access(path_.c_str(), F_OK) != 0) return Error{path_ + ": has been removed while it was in use", true};
  StoreRequest request;
  request.action = StoreAction::read;
  request.grid = grid;
  request.level = level;
  request.step = step;
  request.box = box;
  return ask(request, values);
}

Result<std::vector<std::uint8_t>> Store::list(int grid, int level, int step) {
  const StoreLevel& at = description_.grids[static_cast<std::size_t>(grid)].levels[static_cast<std::size_t>(level)];
  const Index3 n = brick_counts({at.size, at.mapping});
  const double bricks = static_cast<double>(n.x) * n.y * n.z;
  if (bricks > static_cast<double>(kStoreMemoryBytes))
    return Error{fmt::format("{}: level {} has {:.0f} bricks, more than can be listed", path_, level, bricks)};
  StoreRequest request;
  request.action = StoreAction::list;
  request.grid = grid;
  request.level = level;
  request.step = step;
  std::vector<std::uint8_t> present(static_cast<std::size_t>(bricks));
  CATENA_CHECK(ask(request, {reinterpret_cast<std::byte*>(present.data()), present.size()}));
  return present;
}

Result<std::shared_ptr<Store>> find_store(const std::string& path, const ArrayLayout& layout) {
  struct Opened {
    std::string path, state;
    std::shared_ptr<Store> store;
  };
  static std::mutex mutex;
  static std::list<Opened> opened;  // the last used first
  constexpr std::size_t kMaxOpen = 4;
  const std::scoped_lock lock(mutex);
  const std::string state = state_of(path);
  const auto found = std::ranges::find_if(opened, [&](const Opened& o) { return o.path == path && o.store->layout() == layout; });
  if (found != opened.end() && found->state == state) {
    opened.splice(opened.begin(), opened, found);
    return opened.front().store;
  }
  if (found != opened.end()) opened.erase(found);
  CATENA_TRY(std::shared_ptr<Store> store, Store::open(path, /*is_input=*/true, layout));
  opened.push_front({path, state, store});
  if (opened.size() > kMaxOpen) opened.pop_back();
  return store;
}

Result<std::shared_ptr<Store>> find_store(const LoadRequest& request) {
  ArrayLayout layout;
  if (request.raw || io::is_numpy_file(request.path)) {
    const Vec3 spacing = request.raw ? request.raw->spacing : request.spacing, origin = request.raw ? request.raw->origin : request.origin;
    for (int a = 0; a < 3; ++a) layout.spacing[a] = spacing[a], layout.origin[a] = origin[a];
    layout.axes_xyz = request.axes_xyz ? 1 : 0;
  }
  if (request.raw) {
    layout.is_raw = 1;
    layout.shape = request.raw->shape;
    request.raw->type.copy(layout.type, ArrayLayout::kMaxType - 1);
  }
  return find_store(request.path, layout);
}

Result<int> find_grid(const Store& store, const std::string& name) {
  const std::vector<StoreGrid>& grids = store.description().grids;
  if (name.empty() && grids.size() == 1) return 0;
  std::vector<std::string_view> names;
  names.reserve(grids.size());
  for (const StoreGrid& grid : grids) names.push_back(grid.name);
  if (name.empty())
    return Error{
        one_line(fmt::format("{}: the store has several grids, expected the name of one of: {}", store.path(), join_words(names)))};
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    return Error{one_line(fmt::format("{}: there is no grid {}, the store has: {}", store.path(), in_quotes(name), join_words(names)))};
  return static_cast<int>(found - names.begin());
}

Result<int> find_step(const Store& store, int grid, int step) {
  const int steps = store.description().grids[static_cast<std::size_t>(grid)].steps;
  const int times = std::max(1, static_cast<int>(store.description().times.size()));
  if (step >= std::max(times, steps))
    return Error{fmt::format("{}: there is no time step {}, the last one is {}", store.path(), step, times - 1)};
  return std::min(step, steps - 1);
}

}  // namespace catena::field
