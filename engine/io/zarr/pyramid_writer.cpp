// SPDX-License-Identifier: MIT
#include "engine/io/zarr/pyramid_writer.h"

#include <algorithm>
#include <new>
#include <thread>
#include <utility>

#include "engine/base/system_failure.h"
#include "engine/base/threads.h"
#include "engine/io/zarr/brick_values.h"

namespace catena::field {
namespace {

constexpr int kWriters = 2;
/// Work of writing a brick in a group, in units of that of visiting it for the levels above.
constexpr double kGroupWork = 3;
constexpr Index3 kFullBrick{kBrickEdge, kBrickEdge, kBrickEdge}, kHalfBrick{kBrickEdge / 2, kBrickEdge / 2, kBrickEdge / 2};

double count_of(const Index3& n) { return static_cast<double>(n.x) * n.y * n.z; }

Index3 smaller_of(const Index3& a, const Index3& b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }

Index3 first_voxel(const Index3& brick) { return {brick.x * kBrickEdge, brick.y * kBrickEdge, brick.z * kBrickEdge}; }

/// Returns the number of bricks of level 0 that a brick covers.
double covered_by(const BrickLevel& finest, int level, const Index3& brick) {
  const Index3 n = brick_counts(finest);
  const auto along = [&](int count, int at) {
    const std::int64_t first = std::int64_t{at} << level;
    return static_cast<double>(std::min<std::int64_t>(count - first, std::int64_t{1} << level));
  };
  return along(n.x, brick.x) * along(n.y, brick.y) * along(n.z, brick.z);
}

/// Calls body(x, y, z) for all indices of a box until one fails.
template <class Body>
Outcome for_indices(const Index3& lo, const Index3& hi, const Body& body) {
  for (int z = lo.z; z < hi.z; ++z)
    for (int y = lo.y; y < hi.y; ++y)
      for (int x = lo.x; x < hi.x; ++x) CATENA_CHECK(body(Index3{x, y, z}));
  return Done{};
}

}  // namespace

PyramidWriter::PyramidWriter(ZarrFolder& folder, const VoxelSource& source, const WriteProgress& progress)
    : folder_(folder),
      source_(source),
      progress_(progress),
      top_(static_cast<int>(folder.levels().size()) - 1),
      split_(std::max(0, top_ - 2)),
      is_in_groups_(!(source.bricks_at_once == Index3{1, 1, 1})) {
  all_work_ = count_of(brick_counts(folder.levels().front())) * (is_in_groups_ ? 1 + kGroupWork : 1);
}

Outcome PyramidWriter::write() {
  if (is_in_groups_) {
    const Index3 n = brick_counts(folder_.levels().front()), at_once = source_.bricks_at_once;
    std::vector<Index3> groups;
    for (int z = 0; z < n.z; z += at_once.z)
      for (int y = 0; y < n.y; y += at_once.y)
        for (int x = 0; x < n.x; x += at_once.x) groups.push_back({x, y, z});
    CATENA_CHECK(for_each(groups.size(), [&](std::size_t i, Scratch& scratch) { return write_group(groups[i], scratch); }));
  }
  const Index3 counts = brick_counts(folder_.levels()[static_cast<std::size_t>(split_)]);
  parts_.resize(static_cast<std::size_t>(count_of(counts)));
  CATENA_CHECK(for_each(parts_.size(), [&](std::size_t i, Scratch& scratch) -> Outcome {
    CATENA_TRY(const BrickState state, complete(split_, brick_at(counts, i), scratch));
    parts_[i] = {state, state == BrickState::empty ? std::vector<std::byte>() : scratch.halved[static_cast<std::size_t>(split_)]};
    return Done{};
  }));
  if (top_ == split_) return Done{};
  Scratch scratch = make_scratch();
  CATENA_CHECK(complete(top_, {0, 0, 0}, scratch));
  return Done{};
}

PyramidWriter::Scratch PyramidWriter::make_scratch() const {
  const auto levels = static_cast<std::size_t>(top_) + 1;
  Scratch scratch;
  scratch.bricks.assign(levels, std::vector<std::byte>(kBrickVoxels * source_.type.bytes));
  scratch.halved.assign(levels, std::vector<std::byte>(kHalvedVoxels * source_.type.bytes));
  return scratch;
}

/// Calls the body for 0 .. count - 1, each once, in two threads, until one fails.
Outcome PyramidWriter::for_each(std::size_t count, const std::function<Outcome(std::size_t, Scratch&)>& body) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  Outcome result = Done{};
  const auto fail = [&](const Error& error) {
    const std::scoped_lock lock(mutex);
    if (!has_failed_.exchange(true)) result = error;
  };
  const auto work = [&] {
    try {
      Scratch scratch = make_scratch();
      for (std::size_t i = next++; i < count && !has_failed_; i = next++)
        if (const Outcome done = body(i, scratch); !done) fail(done.error());
    } catch (const std::bad_alloc&) {
      fail({out_of_memory_message(), true});
    }
  };
  std::vector<std::thread> helpers;
  for (std::size_t i = 1; i < std::min<std::size_t>(kWriters, count); ++i)
    if (auto thread = start_thread("a writer", work)) helpers.push_back(std::move(*thread));
  work();
  for (std::thread& helper : helpers) helper.join();
  return result;
}

/// Returns whether a brick of level 0 is to be read from the source.
bool PyramidWriter::needs_reading(const Index3& brick) const {
  return folder_.state(0, brick) == BrickState::missing && !(source_.is_empty && source_.is_empty(brick));
}

/// Writes the bricks of level 0 from `first` on that are best read at once.
Outcome PyramidWriter::write_group(const Index3& first, Scratch& scratch) {
  const BrickLevel& level = folder_.levels().front();
  const Index3 at_once = source_.bricks_at_once, n = brick_counts(level);
  const Index3 end = smaller_of({first.x + at_once.x, first.y + at_once.y, first.z + at_once.z}, n);
  // the box around the bricks that are needed
  Index3 lo = end, hi = first;
  CATENA_CHECK(for_indices(first, end, [&](const Index3& brick) -> Outcome {
    if (!needs_reading(brick)) return Done{};
    lo = smaller_of(lo, brick);
    hi = {std::max(hi.x, brick.x + 1), std::max(hi.y, brick.y + 1), std::max(hi.z, brick.z + 1)};
    return Done{};
  }));
  if (lo.x < hi.x) {
    const Index3 box_lo = first_voxel(lo), voxel_end = smaller_of(first_voxel(hi), level.size);
    const Index3 box_size{voxel_end.x - box_lo.x, voxel_end.y - box_lo.y, voxel_end.z - box_lo.z};
    scratch.box.resize(static_cast<std::size_t>(count_of(box_size)) * source_.type.bytes);
    CATENA_CHECK(source_.read(box_lo, box_size, scratch.box));
    std::vector<std::byte>& values = scratch.bricks.front();
    const auto write = [&](const Index3& brick) -> Outcome {
      if (has_failed_ || !needs_reading(brick)) return Done{};
      std::ranges::copy(folder_.fill_brick(), values.begin());
      const Index3 from = first_voxel({brick.x - lo.x, brick.y - lo.y, brick.z - lo.z});
      copy_box(source_.type.bytes, scratch.box, box_size, from, values, kFullBrick, {0, 0, 0}, brick_size(level, brick));
      CATENA_CHECK(folder_.write(0, brick, values));
      return Done{};
    };
    CATENA_CHECK(for_indices(lo, hi, write));
  }
  report(kGroupWork * count_of({end.x - first.x, end.y - first.y, end.z - first.z}));
  return Done{};
}

/// Completes a brick and all finer ones that it covers. Its values at half the resolution are then in the buffer of its level, unless it is
/// empty.
Result<BrickState> PyramidWriter::complete(int level, const Index3& brick, Scratch& scratch) {
  const auto l = static_cast<std::size_t>(level);
  const Index3 size = brick_size(folder_.levels()[l], brick);
  BrickState state = folder_.state(level, brick);
  const bool was_complete = state != BrickState::missing;
  if (state == BrickState::stored) {
    CATENA_CHECK(folder_.read(level, brick, scratch.bricks[l]));
  } else if (state == BrickState::missing) {
    bool has_data = true;
    if (level > 0) {
      CATENA_TRY(has_data, combine(level, brick, scratch));
    } else if (needs_reading(brick)) {
      CATENA_CHECK(read_source(brick, scratch));
    } else {
      has_data = false;
    }
    state = BrickState::empty;
    if (has_data) {
      CATENA_TRY(state, folder_.write(level, brick, scratch.bricks[l]));
    }
  }
  if (state == BrickState::stored) halve_brick(source_.type, scratch.bricks[l], size, source_.units.is_label_map, scratch.halved[l]);
  if (level == 0 || was_complete) report(covered_by(folder_.levels().front(), level, brick));
  return state;
}

/// Sets a brick from the finer ones that it covers; false: all of them are empty.
Result<bool> PyramidWriter::combine(int level, const Index3& brick, Scratch& scratch) {
  const auto fine = static_cast<std::size_t>(level) - 1;
  const BrickLevel& finer = folder_.levels()[fine];
  std::vector<std::byte>& values = scratch.bricks[fine + 1];
  std::ranges::copy(folder_.fill_brick(), values.begin());
  bool has_data = false;
  const Index3 first{2 * brick.x, 2 * brick.y, 2 * brick.z};
  const Index3 end = smaller_of({first.x + 2, first.y + 2, first.z + 2}, brick_counts(finer));
  CATENA_CHECK(for_indices(first, end, [&](const Index3& child) -> Outcome {
    if (has_failed_) return Error{"another thread has failed"};
    const bool is_part = level - 1 == split_ && !parts_.empty() && parts_[number_in_split(child)].state != BrickState::missing;
    BrickState state = BrickState::empty;
    if (is_part) {
      state = parts_[number_in_split(child)].state;
    } else {
      CATENA_TRY(state, complete(level - 1, child, scratch));
    }
    if (state == BrickState::empty) return Done{};
    has_data = true;
    const Index3 size = brick_size(finer, child);
    const Index3 to{(child.x - first.x) * kHalfBrick.x, (child.y - first.y) * kHalfBrick.y, (child.z - first.z) * kHalfBrick.z};
    copy_box(source_.type.bytes, is_part ? parts_[number_in_split(child)].halved : scratch.halved[fine], kHalfBrick, {0, 0, 0}, values,
             kFullBrick, to, {(size.x + 1) / 2, (size.y + 1) / 2, (size.z + 1) / 2});
    return Done{};
  }));
  return has_data;
}

/// Reads a brick of level 0 from the source.
Outcome PyramidWriter::read_source(const Index3& brick, Scratch& scratch) {
  const Index3 size = brick_size(folder_.levels().front(), brick);
  std::vector<std::byte>& values = scratch.bricks.front();
  if (size == kFullBrick) return source_.read(first_voxel(brick), size, values);
  scratch.box.resize(static_cast<std::size_t>(count_of(size)) * source_.type.bytes);
  CATENA_CHECK(source_.read(first_voxel(brick), size, scratch.box));
  std::ranges::copy(folder_.fill_brick(), values.begin());
  copy_box(source_.type.bytes, scratch.box, size, {0, 0, 0}, values, kFullBrick, {0, 0, 0}, size);
  return Done{};
}

std::size_t PyramidWriter::number_in_split(const Index3& brick) const {
  return static_cast<std::size_t>(brick_number(brick_counts(folder_.levels()[static_cast<std::size_t>(split_)]), brick));
}

void PyramidWriter::report(double work) {
  if (!progress_) return;
  const std::scoped_lock lock(progress_mutex_);
  work_ += work;
  progress_(work_ / all_work_);
}

}  // namespace catena::field
