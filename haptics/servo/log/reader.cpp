#include "haptics/servo/log/reader.h"

#include <fmt/format.h>

#include <cstring>

#include "haptics/servo/log/format.h"

namespace catena::haptics::log {

Result<LogReader> LogReader::open(const std::string& path) {
  CATENA_TRY(std::unique_ptr<Source> source, open_file(path));
  return open(std::move(source), path);
}

Result<LogReader> LogReader::open(std::unique_ptr<Source> source, const std::string& name) {
  unsigned char preamble[kPreambleBytes];
  std::uint32_t version = 0, order = 0;
  if (source->size() < sizeof preamble || !source->read(0, preamble, sizeof preamble) || std::memcmp(preamble, kMagic, sizeof kMagic) != 0)
    return Error{name + ": is no recording of Catena, or was cut off within its first bytes; a .catlog file was expected"};
  std::memcpy(&version, preamble + 8, sizeof version);
  std::memcpy(&order, preamble + 12, sizeof order);
  if (order != kByteOrder) return Error{name + ": was recorded on a machine of another byte order; expected one like this"};
  if (version != kVersion)
    return Error{fmt::format("{}: is a recording of version {}; this program reads version {}", name, version, kVersion)};
  LogReader reader{BlockReader(std::move(source))};
  const BlockReader::Found found = reader.blocks_.next();
  if (found == BlockReader::Found::block && reader.blocks_.type() == BlockType::header && reader.blocks_.sequence() == 0) {
    if (auto header = header_from(reader.blocks_.payload())) {
      reader.header_ = std::move(*header);
      return reader;
    }
  }
  return Error{name + (found == BlockReader::Found::cut_off || found == BlockReader::Found::end
                           ? ": was cut off before its header was complete; it holds no tick"
                           : ": its header is damaged; expected it as it was written")};
}

bool LogReader::damage() {
  damaged_ = true;
  return false;
}

LogEvent LogReader::lost_before(std::uint64_t next) {
  gap_ = {last_ + 1, next - last_ - 1, LogGap::Why::damaged};
  damaged_ = true;
  last_ = next - 1;
  return LogEvent::gap;
}

LogEvent LogReader::next() {
  while (!finished_) {
    if (left_ > 0) return next_record();
    if (!again_) {
      switch (blocks_.next()) {
        case BlockReader::Found::end:
        case BlockReader::Found::cut_off:
          finished_ = true;
          continue;
        case BlockReader::Found::damaged:
          damage();
          continue;
        case BlockReader::Found::block:
          break;
      }
      if (blocks_.sequence() < next_sequence_) {
        damage();  // a block for the second time
        continue;
      }
      if (blocks_.sequence() > next_sequence_) damage();
      next_sequence_ = blocks_.sequence() + 1;
    }
    again_ = false;
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
    case BlockType::header:
      break;
  }
  damage();
  return std::nullopt;
}

std::optional<LogEvent> LogReader::read_program() {
  auto program = program_from(blocks_.payload());
  if (!program || program->first_tick <= last_) {
    damage();
    return std::nullopt;
  }
  program_ = std::move(*program);
  has_program_ = program_.known;
  if (!has_program_) return std::nullopt;  // its ticks say how many links it has
  return LogEvent::program;
}

std::optional<LogEvent> LogReader::read_ticks() {
  ByteReader in(blocks_.payload());
  const auto epoch = in.get<std::uint64_t>(), first = in.get<std::uint64_t>();
  const auto count = in.get<std::uint32_t>(), links = in.get<std::uint32_t>(), widgets = in.get<std::uint32_t>();
  const bool sane = in.good() && count > 0 && links <= kMaxLinks && widgets <= exchange::kMaxWidgets && first > last_ &&
                    count <= blocks_.payload().size() && first <= ~std::uint64_t{0} - count;
  constexpr std::size_t kHead = 28;
  const Shape shape{static_cast<int>(links & 0xff), static_cast<int>(widgets & 0xff)};
  // all of it is looked at before any of it is told
  Words words{};
  LogTick tick;
  bool good = sane;
  std::string_view rest = sane ? blocks_.payload().substr(kHead) : std::string_view();
  for (std::uint32_t i = 0; i < count && good; ++i) {
    const std::size_t used = unsqueeze(rest, words_of(shape), words);
    good = used > 0 && unpack(words, shape, tick);
    rest.remove_prefix(used);
  }
  if (!good || !rest.empty()) {
    damage();
    return std::nullopt;
  }
  if (first > last_ + 1) {
    again_ = true;
    return lost_before(first);
  }
  if (!has_program_ || program_.epoch != epoch || program_.links.size() != links || program_.widgets.size() != widgets) {
    // its block is damaged, or nobody told the writer
    if (has_program_ || program_.known) damage();
    program_ = {};
    program_.epoch = epoch;
    program_.first_tick = first;
    program_.known = false;
    for (std::uint32_t i = 0; i < links; ++i) program_.links.push_back({fmt::format("link_{}", i + 1), 0});
    for (std::uint32_t i = 0; i < widgets; ++i) program_.widgets.push_back({fmt::format("widget_{}", i + 1), 0, {}, 0});
    has_program_ = true;
    again_ = true;
    return LogEvent::program;
  }
  records_ = blocks_.payload().substr(kHead);
  left_ = count;
  shape_ = shape;
  words_.fill(0);
  tick_ = {};
  tick_.output.program_epoch = epoch;
  return std::nullopt;
}

LogEvent LogReader::next_record() {
  const std::size_t used = unsqueeze(records_, words_of(shape_), words_);
  records_.remove_prefix(used);
  --left_;
  unpack(words_, shape_, tick_);
  tick_.output.tick = ++last_;
  return LogEvent::tick;
}

std::optional<LogEvent> LogReader::read_state() {
  auto state = state_from(blocks_.payload());
  if (!state || last_ != 0) {
    damage();
    return std::nullopt;
  }
  state_ = std::move(*state);
  last_ = state_.tick;
  return LogEvent::state;
}

std::optional<LogEvent> LogReader::read_gap() {
  const auto gap = gap_from(blocks_.payload());
  if (!gap || gap->first_tick <= last_ || gap->ticks > ~std::uint64_t{0} - gap->first_tick) {
    damage();
    return std::nullopt;
  }
  if (gap->first_tick > last_ + 1) {
    again_ = true;
    return lost_before(gap->first_tick);
  }
  gap_ = *gap;
  last_ += gap->ticks;
  return LogEvent::gap;
}

std::optional<LogEvent> LogReader::read_poses() {
  auto poses = poses_from(blocks_.payload());
  if (!poses) {
    damage();
    return std::nullopt;
  }
  poses_ = std::move(*poses);
  return LogEvent::poses;
}

std::optional<LogEvent> LogReader::read_end() {
  const auto end = end_from(blocks_.payload());
  if (!end || end->last_tick == ~std::uint64_t{0}) {
    damage();
    return std::nullopt;
  }
  if (end->last_tick > last_) {
    again_ = true;
    return lost_before(end->last_tick + 1);
  }
  end_ = *end;
  if (blocks_.next() != BlockReader::Found::end) damage();
  finished_ = true;
  return std::nullopt;
}

std::string LogReader::ending() const {
  std::string text = end_       ? fmt::format("ends cleanly with tick {}", last_)
                     : damaged_ ? fmt::format("nothing can be read after tick {}", last_)
                                : fmt::format("cut off after tick {}", last_);
  if (damaged_) text += "; the log is damaged";
  return text;
}

}  // namespace catena::haptics::log
