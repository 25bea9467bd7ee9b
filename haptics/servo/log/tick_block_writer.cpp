// SPDX-License-Identifier: MIT
#include "haptics/servo/log/tick_block_writer.h"

#include <algorithm>
#include <iterator>

#include "engine/base/result.h"
#include "haptics/servo/log/format.h"

namespace catena::haptics::log {

namespace {
constexpr std::size_t kFullBlock = std::size_t{64} << 10;
}

TickBlockWriter::TickBlockWriter(BlockFile file, ProgramLookup programs_of, BrickLookup bricks_of)
    : file_(std::move(file)), find_programs_(std::move(programs_of)), find_bricks_(std::move(bricks_of)) {}

void TickBlockWriter::add_gap(std::uint64_t next) {
  flush();
  const std::uint64_t missing = next - last_ - 1;
  lost_ += missing;
  file_.write(BlockType::gap, to_bytes(LogGap{last_ + 1, missing, LogGap::Cause::overrun}));
}

void TickBlockWriter::write_bricks(const Tick& tick) {
  flush();
  snapshot_ = tick.snapshot;
  std::vector<LogBrick> now = find_bricks_(paged_grids_, tick.snapshot);
  LogBricks change{tick.number, {}, {}};
  std::ranges::set_difference(bricks_, now, std::back_inserter(change.left));
  std::ranges::set_difference(now, bricks_, std::back_inserter(change.added));
  bricks_ = std::move(now);
  file_.write(BlockType::bricks, to_bytes(change));
}

void TickBlockWriter::begin(const Tick& tick) {
  const bool has_new_program = !has_program_ || tick.epoch != epoch_;
  if (has_new_program) {
    flush();
    for (LogProgram& program : find_programs_(tick.epoch)) {
      program.first_tick = tick.number;
      file_.write(BlockType::program, to_bytes(program));
      paged_grids_ = std::move(program.paged_grids);
    }
    epoch_ = tick.epoch;
    has_program_ = true;
  }
  if (tick.snapshot != snapshot_ || (has_new_program && !paged_grids_.empty())) write_bricks(tick);
  if (count_ == 0) {
    first_ = tick;
    previous_words_.fill(0);
  }
}

void TickBlockWriter::add(const Tick& tick, std::span<const std::uint64_t> words) {
  CATENA_ASSERT(tick.number > last_ && tick.layout.is_valid());  // one log covers one run of the servo
  if (tick.number != last_ + 1) add_gap(tick.number);
  if (count_ > 0 && !(tick.layout == first_.layout)) flush();
  begin(tick);
  last_ = tick.number;
  compress_record(words, previous_words_, records_);
  unpack_tick(previous_words_, tick.layout, unpacked_);  // previous_words_ is this record from here on
  hash_.add(unpacked_.output);
  ++count_;
  if (records_.size() >= kFullBlock) flush();
}

void TickBlockWriter::begin_after(const ChainState& state) {
  CATENA_ASSERT(last_ == 0);
  file_.write(BlockType::state, to_bytes(state));
  last_ = last_written_ = state.ticks;
}

void TickBlockWriter::flush() {
  if (count_ == 0) return;
  ByteWriter payload;
  payload.put(first_.epoch);
  payload.put(first_.number);
  payload.put(count_);
  payload.put(static_cast<std::uint32_t>(first_.layout.links));
  payload.put(static_cast<std::uint32_t>(first_.layout.widgets));
  payload.put_bytes(records_.data(), records_.size());
  if (file_.write(BlockType::ticks, payload.bytes())) {
    ticks_ += count_;
    last_written_ = last_;
  }
  records_.clear();
  count_ = 0;
}

void TickBlockWriter::end(std::uint64_t newest_tick) {
  flush();
  if (newest_tick > last_) add_gap(newest_tick + 1);
  file_.write(BlockType::end, to_bytes(LogEnd{ticks_, lost_, last_written_, hash_.value()}));
  file_.sync();
  file_.close();
}

}  // namespace catena::haptics::log
