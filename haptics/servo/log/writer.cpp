// SPDX-License-Identifier: MIT
#include "haptics/servo/log/writer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "engine/base/clock.h"
#include "engine/base/console.h"
#include "engine/base/output_file.h"
#include "engine/base/threads.h"
#include "engine/field/bricks/brick_snapshot.h"
#include "haptics/servo/log/tick_block_writer.h"

namespace catena::haptics::log {

namespace {

// Message of the ring: tick, epoch, numbers of links (8 bits), widgets (8 bits) and snapshot of bricks, then the record.
constexpr std::size_t kMessageHead = 3;
using Message = std::array<std::uint64_t, kMessageHead + kMaxRecordWords>;

}  // namespace

struct LogWriter::Impl {
  Impl(BlockFile file, const std::string& name, const LogOptions& chosen)
      : path(name),
        options(chosen),
        ring(chosen.ring_bytes),
        blocks(
            std::move(file), [this](std::uint64_t e) { return programs_of(e); },
            [this](const std::vector<std::uint64_t>& grids, std::uint64_t snapshot) { return bricks_of(grids, snapshot); }) {}

  std::string path;
  LogOptions options;
  SpscRing ring;

  // haptic thread
  Message message{};
  ChainState start;        ///< state before the first tick, if it differs from the servo's initial state; announced by the first message
  bool has_start = false;  ///< true until the writer's thread has read it
  std::atomic<std::uint64_t> newest_tick{0}, ring_lost{0}, ticks_before{0};

  // frame thread -> writer's thread
  std::mutex mutex;
  std::condition_variable wake;
  std::map<std::uint64_t, LogProgram> programs;
  std::optional<std::uint64_t> first_epoch;  ///< set until the first tick
  bool has_first = false, stop = false;
  std::vector<LogPoses> poses;
  std::map<std::uint64_t, std::vector<field::BrickId>> snapshots;  ///< bricks of the snapshots that ticks may still use, by number

  // writer's thread
  TickBlockWriter blocks;
  std::atomic<std::uint64_t> ticks{0}, bytes{0};
  std::atomic<bool> failed{false};
  std::thread thread;

  std::vector<LogProgram> programs_of(std::uint64_t epoch);
  std::vector<LogBrick> bricks_of(const std::vector<std::uint64_t>& grids, std::uint64_t snapshot);
  void drain();
  void publish();
  void loop();
};

std::vector<LogProgram> LogWriter::Impl::programs_of(std::uint64_t epoch) {
  const std::lock_guard lock(mutex);
  std::vector<LogProgram> found;
  // the program may change before the first tick
  if (first_epoch && *first_epoch != epoch) found.push_back(programs.at(*first_epoch));
  first_epoch.reset();
  const auto wanted = programs.find(epoch);
  if (wanted == programs.end()) {
    found.emplace_back().epoch = epoch;
    found.back().is_known = false;
    return found;
  }
  found.push_back(std::move(wanted->second));
  programs.erase(programs.begin(), std::next(wanted));  // older programs are no longer needed
  return found;
}

std::vector<LogBrick> LogWriter::Impl::bricks_of(const std::vector<std::uint64_t>& grids, std::uint64_t snapshot) {
  const std::lock_guard lock(mutex);
  std::vector<LogBrick> bricks;
  const auto found = snapshots.find(snapshot);
  if (found == snapshots.end()) return bricks;
  for (const field::BrickId& id : found->second)
    if (const auto grid = std::ranges::find(grids, id.grid); grid != grids.end())
      bricks.push_back({static_cast<std::uint32_t>(grid - grids.begin()), id.number});
  std::ranges::sort(bricks);
  snapshots.erase(snapshots.begin(), found);  // older snapshots are no longer needed
  return bricks;
}

void LogWriter::Impl::drain() {
  Message taken;
  while (ring.available() >= kMessageHead) {
    ring.pop({taken.data(), kMessageHead});
    if (std::exchange(has_start, false)) blocks.begin_after(start);
    const TickBlockWriter::Tick tick{
        taken[0], taken[1], {static_cast<int>(taken[2] & 0xff), static_cast<int>(taken[2] >> 8 & 0xff)}, taken[2] >> 16};
    const std::span<std::uint64_t> words(taken.data() + kMessageHead, static_cast<std::size_t>(record_word_count(tick.layout)));
    ring.pop(words);
    if (!blocks.file().failed()) blocks.add(tick, words);
  }
  blocks.flush();
  std::vector<LogPoses> said;
  {
    const std::lock_guard lock(mutex);
    said.swap(poses);
  }
  if (!said.empty() && !blocks.file().failed()) blocks.file().write(BlockType::poses, to_bytes(said));
}

void LogWriter::Impl::publish() {
  ticks.store(blocks.ticks(), std::memory_order_relaxed);
  bytes.store(blocks.file().bytes(), std::memory_order_relaxed);
  failed.store(blocks.file().failed(), std::memory_order_release);
}

void LogWriter::Impl::loop() {
  const auto pause = std::chrono::duration<double>(options.flush_s);
  std::int64_t synced = now_ns();
  for (bool last = false; !last;) {
    {
      std::unique_lock lock(mutex);
      last = wake.wait_for(lock, pause, [this] { return stop; });
    }
    drain();
    if (last) {
      blocks.end(newest_tick.load(std::memory_order_acquire));
    } else if (static_cast<double>(now_ns() - synced) > 1e9 * options.sync_s) {
      blocks.file().sync();
      synced = now_ns();
    }
    publish();
  }
}

Result<std::unique_ptr<LogWriter>> LogWriter::open(const std::string& path, LogHeader header, const std::vector<std::string>& inputs,
                                                   const LogOptions& options) {
  CATENA_CHECK(check_output(path, inputs));
  if (header.scene_text.size() > kMaxPayload / 2)
    return Error{path + ": the text of the scene is too long to record, expected at most 32 MiB"};
  std::error_code ignored;
  if (header.working_folder.empty()) header.working_folder = std::filesystem::current_path(ignored).string();
  if (header.started_unix_ns == 0)
    header.started_unix_ns =
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
  CATENA_TRY(BlockFile file, BlockFile::create(path));
  if (!file.write(BlockType::header, to_bytes(header)) || !file.sync()) {
    file.discard();
    return file.error();
  }
  auto parts = std::make_unique<Impl>(std::move(file), path, options);
  auto thread = start_thread("the recording", [p = parts.get()] { p->loop(); });
  if (!thread) {
    parts->blocks.file().discard();
    return thread.error();
  }
  parts->thread = std::move(*thread);
  return std::unique_ptr<LogWriter>(new LogWriter(std::move(parts)));
}

LogWriter::LogWriter(std::unique_ptr<Impl> parts) : impl_(std::move(parts)) {}

LogWriter::~LogWriter() {
  if (const Outcome done = finish(); !done) print_line(done.error().message);
}

void LogWriter::add_program(const HapticProgram& program, std::optional<std::string> scene_text) {
  LogProgram facts = to_log_program(program, std::move(scene_text));
  const std::lock_guard lock(impl_->mutex);
  if (!std::exchange(impl_->has_first, true)) impl_->first_epoch = program.epoch;
  impl_->programs.insert_or_assign(program.epoch, std::move(facts));
}

bool LogWriter::add_poses(const LogPoses& poses) {
  Impl& p = *impl_;
  const std::lock_guard lock(p.mutex);
  if (p.stop || p.failed.load(std::memory_order_acquire) || p.poses.size() >= kMaxPendingPoses) return false;
  p.poses.push_back(poses);
  return true;
}

void LogWriter::begin(const ChainState& state) noexcept {
  Impl& p = *impl_;
  if (state.ticks == 0 || p.newest_tick.load(std::memory_order_relaxed) != 0) return;
  p.start = state;
  p.has_start = true;
  p.ticks_before.store(state.ticks, std::memory_order_relaxed);
  p.newest_tick.store(state.ticks, std::memory_order_release);
}

void LogWriter::put(const ProbeSample& input, const HapticState& output) noexcept {
  Impl& p = *impl_;
  p.message[0] = output.tick;
  p.message[1] = output.program_epoch;
  p.message[2] =
      static_cast<std::uint64_t>(output.link_count) | static_cast<std::uint64_t>(output.widget_count) << 8 | output.brick_snapshot << 16;
  const int count = pack_tick(input, output, p.message.data() + kMessageHead);
  if (!p.ring.try_push({p.message.data(), kMessageHead + static_cast<std::size_t>(count)}))
    p.ring_lost.store(p.ring_lost.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  p.newest_tick.store(output.tick, std::memory_order_release);
}

void LogWriter::add_bricks(const field::BrickSnapshot& bricks) {
  std::vector<field::BrickId> ids;
  for (const field::StoredBrick& brick : bricks.bricks()) ids.push_back(brick.id);
  const std::lock_guard lock(impl_->mutex);
  impl_->snapshots.insert_or_assign(bricks.number(), std::move(ids));
}

LogStatus LogWriter::status() const {
  const Impl& p = *impl_;
  LogStatus now;
  now.failed = p.failed.load(std::memory_order_acquire);
  now.ticks = p.ticks.load(std::memory_order_relaxed);
  now.bytes = p.bytes.load(std::memory_order_relaxed);
  const auto put = p.newest_tick.load(std::memory_order_relaxed) - p.ticks_before.load(std::memory_order_relaxed);
  now.lost = now.failed ? put - std::min(put, now.ticks) : p.ring_lost.load(std::memory_order_relaxed);
  return now;
}

Outcome LogWriter::finish() {
  Impl& p = *impl_;
  if (!p.thread.joinable()) return Done{};
  {
    const std::lock_guard lock(p.mutex);
    p.stop = true;
  }
  p.wake.notify_one();
  p.thread.join();
  if (!p.blocks.file().failed()) return Done{};
  Error error = p.blocks.file().error();
  error.message +=
      fmt::format("; the recording ends with tick {} of {}", p.blocks.last_tick(), p.newest_tick.load(std::memory_order_relaxed));
  return error;
}

}  // namespace catena::haptics::log
