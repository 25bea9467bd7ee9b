#include "haptics/servo/log/tick_blocks.h"

#include <algorithm>

#include "engine/base/result.h"
#include "haptics/servo/log/format.h"

namespace catena::haptics::log {

namespace {
constexpr std::size_t kFullBlock = std::size_t{64} << 10;
}

TickBlocks::TickBlocks(BlockFile file, Programs programs_of) : file_(std::move(file)), programs_of_(std::move(programs_of)) {}

void TickBlocks::add_gap(std::uint64_t next) {
  flush();
  const std::uint64_t missing = next - last_ - 1;
  lost_ += missing;
  file_.write(BlockType::gap, to_bytes(LogGap{last_ + 1, missing, LogGap::Why::not_kept_up}));
}

void TickBlocks::begin(const Tick& tick) {
  if (!has_program_ || tick.epoch != epoch_) {
    flush();
    for (LogProgram& program : programs_of_(tick.epoch)) {
      program.first_tick = tick.number;
      file_.write(BlockType::program, to_bytes(program));
    }
    epoch_ = tick.epoch;
    has_program_ = true;
  }
  if (count_ == 0) {
    first_ = tick;
    before_.fill(0);
  }
}

void TickBlocks::add(const Tick& tick, std::span<const std::uint64_t> words) {
  CATENA_ASSERT(tick.number > last_ && tick.shape.legal());  // one log, one run of the servo
  if (tick.number != last_ + 1) add_gap(tick.number);
  if (count_ > 0 && !(tick.shape == first_.shape)) flush();
  begin(tick);
  last_ = tick.number;
  squeeze(words, before_, records_);
  unpack(before_, tick.shape, unpacked_);  // before_ is this record now
  hash_.add(unpacked_.output);
  ++count_;
  if (records_.size() >= kFullBlock) flush();
}

void TickBlocks::begin_after(const ChainState& state) {
  CATENA_ASSERT(last_ == 0);
  file_.write(BlockType::state, to_bytes(state));
  last_ = last_written_ = state.ticks;
}

void TickBlocks::flush() {
  if (count_ == 0) return;
  ByteWriter payload;
  payload.put(first_.epoch);
  payload.put(first_.number);
  payload.put(count_);
  payload.put(static_cast<std::uint32_t>(first_.shape.links));
  payload.put(static_cast<std::uint32_t>(first_.shape.widgets));
  payload.put_bytes(records_.data(), records_.size());
  if (file_.write(BlockType::ticks, payload.bytes())) {
    ticks_ += count_;
    last_written_ = last_;
  }
  records_.clear();
  count_ = 0;
}

void TickBlocks::end(std::uint64_t newest_tick) {
  flush();
  if (newest_tick > last_) add_gap(newest_tick + 1);
  file_.write(BlockType::end, to_bytes(LogEnd{ticks_, lost_, last_written_, hash_.value()}));
  file_.sync();
  file_.close();
}

}  // namespace catena::haptics::log
