// SPDX-License-Identifier: MIT
#include "haptics/servo/log/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>

#include "haptics/servo/log/format.h"

namespace catena::haptics::log {

Result<LogReader> LogReader::open(const std::string& path) {
  CATENA_TRY(std::unique_ptr<ByteSource> source, open_file_source(path));
  return open(std::move(source), path);
}

Result<LogReader> LogReader::open(std::unique_ptr<ByteSource> source, const std::string& name) {
  unsigned char preamble[kPreambleBytes];
  std::uint32_t version = 0, order = 0;
  if (source->size() < sizeof preamble || !source->read(0, preamble, sizeof preamble) || std::memcmp(preamble, kMagic, sizeof kMagic) != 0)
    return Error{name + ": this is not a recording of Catena, or is truncated; a .catlog file was expected"};
  std::memcpy(&version, preamble + 8, sizeof version);
  std::memcpy(&order, preamble + 12, sizeof order);
  if (order != kByteOrderMark)
    return Error{name + ": the recording was made on a machine with another byte order, expected the byte order of this machine"};
  if (version != kVersion) return Error{fmt::format("{}: the recording has version {}, expected version {}", name, version, kVersion)};
  LogReader reader{BlockReader(std::move(source))};
  const BlockReader::ReadResult found = reader.blocks_.next();
  if (found == BlockReader::ReadResult::block && reader.blocks_.type() == BlockType::header && reader.blocks_.sequence() == 0) {
    if (auto header = parse_header(reader.blocks_.payload())) {
      reader.header_ = std::move(*header);
      return reader;
    }
  }
  return Error{name + (found == BlockReader::ReadResult::truncated || found == BlockReader::ReadResult::end
                           ? ": the recording is truncated inside the header and contains no tick"
                           : ": the header of the recording is damaged, expected a valid header")};
}

bool LogReader::mark_damaged() {
  damaged_ = true;
  return false;
}

LogEvent LogReader::report_gap_before(std::uint64_t next) {
  gap_ = {last_tick_ + 1, next - last_tick_ - 1, LogGap::Cause::damaged};
  damaged_ = true;
  last_tick_ = next - 1;
  return LogEvent::gap;
}

LogEvent LogReader::next() {
  while (!finished_) {
    if (records_left_ > 0) return next_record();
    if (!reprocess_block_) {
      switch (blocks_.next()) {
        case BlockReader::ReadResult::end:
        case BlockReader::ReadResult::truncated:
          finished_ = true;
          continue;
        case BlockReader::ReadResult::damaged:
          mark_damaged();
          continue;
        case BlockReader::ReadResult::block:
          break;
      }
      if (blocks_.sequence() < next_sequence_) {
        mark_damaged();  // a duplicate block
        continue;
      }
      if (blocks_.sequence() > next_sequence_) mark_damaged();
      next_sequence_ = blocks_.sequence() + 1;
    }
    reprocess_block_ = false;
    if (const auto event = read_block()) return *event;
  }
  return LogEvent::done;
}

std::optional<LogEvent> LogReader::read_block() {
  switch (blocks_.type()) {
    case BlockType::program:
      return read_program();
    case BlockType::ticks:
      return read_ticks();
    case BlockType::state:
      return read_state();
    case BlockType::gap:
      return read_gap();
    case BlockType::end:
      return read_end();
    case BlockType::poses:
      return read_poses();
    case BlockType::bricks:
      return read_bricks();
    case BlockType::header:
      break;
  }
  mark_damaged();
  return std::nullopt;
}

std::optional<LogEvent> LogReader::read_program() {
  auto program = parse_program(blocks_.payload());
  if (!program || program->first_tick <= last_tick_) {
    mark_damaged();
    return std::nullopt;
  }
  program_ = std::move(*program);
  has_program_ = program_.is_known;
  if (!has_program_) return std::nullopt;  // without a program the number of links of a tick is unknown
  return LogEvent::program;
}

std::optional<LogEvent> LogReader::read_ticks() {
  ByteReader in(blocks_.payload());
  const auto epoch = in.get<std::uint64_t>(), first = in.get<std::uint64_t>();
  const auto count = in.get<std::uint32_t>(), links = in.get<std::uint32_t>(), widgets = in.get<std::uint32_t>();
  const bool sane = in.is_ok() && count > 0 && links <= kMaxLinks && widgets <= kMaxWidgets && first > last_tick_ &&
                    count <= blocks_.payload().size() && first <= ~std::uint64_t{0} - count;
  constexpr std::size_t kHead = 28;
  const RecordLayout shape{static_cast<int>(links & 0xff), static_cast<int>(widgets & 0xff)};
  // validate the whole block before any of it is reported
  RecordWords words{};
  LogTick tick;
  bool good = sane;
  std::string_view rest = sane ? blocks_.payload().substr(kHead) : std::string_view();
  for (std::uint32_t i = 0; i < count && good; ++i) {
    const std::size_t used = decompress_record(rest, record_word_count(shape), words);
    good = used > 0 && unpack_tick(words, shape, tick);
    rest.remove_prefix(used);
  }
  if (!good || !rest.empty()) {
    mark_damaged();
    return std::nullopt;
  }
  if (first > last_tick_ + 1) {
    reprocess_block_ = true;
    return report_gap_before(first);
  }
  if (!has_program_ || program_.epoch != epoch || program_.links.size() != links || program_.widgets.size() != widgets) {
    // the program's block is damaged, or the writer did not get the program
    if (has_program_ || program_.is_known) mark_damaged();
    program_ = {};
    program_.epoch = epoch;
    program_.first_tick = first;
    program_.is_known = false;
    for (std::uint32_t i = 0; i < links; ++i) program_.links.push_back({fmt::format("link_{}", i + 1), 0});
    for (std::uint32_t i = 0; i < widgets; ++i) program_.widgets.push_back({fmt::format("widget_{}", i + 1), 0, {}, 0});
    has_program_ = true;
    reprocess_block_ = true;
    return LogEvent::program;
  }
  records_ = blocks_.payload().substr(kHead);
  records_left_ = count;
  layout_ = shape;
  record_words_.fill(0);
  tick_ = {};
  tick_.output.program_epoch = epoch;
  return std::nullopt;
}

LogEvent LogReader::next_record() {
  const std::size_t used = decompress_record(records_, record_word_count(layout_), record_words_);
  records_.remove_prefix(used);
  --records_left_;
  unpack_tick(record_words_, layout_, tick_);
  tick_.output.tick = ++last_tick_;
  return LogEvent::tick;
}

std::optional<LogEvent> LogReader::read_state() {
  auto state = parse_state(blocks_.payload());
  if (!state || last_tick_ != 0) {
    mark_damaged();
    return std::nullopt;
  }
  state_ = std::move(*state);
  last_tick_ = state_.tick;
  return LogEvent::state;
}

std::optional<LogEvent> LogReader::read_gap() {
  const auto gap = parse_gap(blocks_.payload());
  if (!gap || gap->first_tick <= last_tick_ || gap->ticks > ~std::uint64_t{0} - gap->first_tick) {
    mark_damaged();
    return std::nullopt;
  }
  if (gap->first_tick > last_tick_ + 1) {
    reprocess_block_ = true;
    return report_gap_before(gap->first_tick);
  }
  gap_ = *gap;
  last_tick_ += gap->ticks;
  return LogEvent::gap;
}

std::optional<LogEvent> LogReader::read_poses() {
  auto poses = parse_poses(blocks_.payload());
  if (!poses) {
    mark_damaged();
    return std::nullopt;
  }
  poses_ = std::move(*poses);
  return LogEvent::poses;
}

std::optional<LogEvent> LogReader::read_bricks() {
  const auto change = parse_bricks(blocks_.payload());
  if (!change || !has_program_ || change->first_tick <= last_tick_) {
    mark_damaged();
    return std::nullopt;
  }
  std::vector<LogBrick> rest, now;
  std::ranges::set_difference(bricks_, change->left, std::back_inserter(rest));
  std::ranges::set_union(rest, change->added, std::back_inserter(now));
  bricks_ = std::move(now);
  return LogEvent::bricks;
}

std::optional<LogEvent> LogReader::read_end() {
  const auto end = parse_end(blocks_.payload());
  if (!end || end->last_tick == ~std::uint64_t{0}) {
    mark_damaged();
    return std::nullopt;
  }
  if (end->last_tick > last_tick_) {
    reprocess_block_ = true;
    return report_gap_before(end->last_tick + 1);
  }
  end_ = *end;
  if (blocks_.next() != BlockReader::ReadResult::end) mark_damaged();
  finished_ = true;
  return std::nullopt;
}

std::string LogReader::end_summary() const {
  std::string text = end_       ? fmt::format("ends cleanly with tick {}", last_tick_)
                     : damaged_ ? fmt::format("unreadable after tick {}", last_tick_)
                                : fmt::format("truncated after tick {}", last_tick_);
  if (damaged_) text += "; the log is damaged";
  return text;
}

}  // namespace catena::haptics::log
