/// One tick of the log as words of 8 bytes: what it had as input, what came out, what the servo measured.
///   0      t_s of the probe                    1-3   probe position, world units
///   4-7    probe orientation w x y z           8     bytes: u32 buttons, u8 condition, u8 forces_on, u8 force_state, i8 mode
///   9      t_s that the tick reports           10-12 force on the hand, N
///   13-15  force that the chain asks for       16-18 torque, N m
///   19     energy_j      20  dissipated_j      21    u64 missed deadlines since the start
///   22     f32 period_us, f32 compute_us       23    f32 device_us, u32 0
/// and for every link, from word 24 + 20 i on:
///   0-2    proxy          3-5  force share     6 residual   7 weight   8 stiffness   9 gap
///   10-13  orientation w x y z                 14-16 torque share      17 accounted_j   18 leaving
///   19     bytes: i32 evaluations, u8 status, u8 active, u8 left, u8 reason (0 in recordings of before there were reasons)
/// and for every widget, behind the links, 12 words:
///   0-2    points[0]      3-5  points[1]       6-9   orientation w x y z                  10  value
///   11     bytes: u32 revision, u8 mode, i8 handle, u8 held, u8 0
/// Names and units: engine/base/haptic_state.h, haptics/chain/tick.h. Timings are single precision; all else is exact.
/// `pack` runs on the haptic thread: no allocation, lock or throw.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "haptics/chain/tick.h"
#include "haptics/servo/log/format.h"

namespace catena::haptics::log {

inline constexpr int kMaxRecordWords =
    kTickWords + kLinkWords * kMaxLinks + kWidgetWords * kMaxWidgets;  ///< RecordWords of the longest record.
/// A record, in its first words.
using RecordWords = std::array<std::uint64_t, kMaxRecordWords>;

/// What a record holds beside the tick's own.
struct RecordLayout {
  int links = 0, widgets = 0;  ///< how many of each
  bool operator==(const RecordLayout&) const = default;
  /// Whether a record can have so many.
  bool is_valid() const { return links >= 0 && links <= kMaxLinks && widgets >= 0 && widgets <= kMaxWidgets; }
};
/// RecordWords of a record of this shape.
inline constexpr int record_word_count(const RecordLayout& shape) {
  return kTickWords + kLinkWords * shape.links + kWidgetWords * shape.widgets;
}
/// The shape of a state's record.
inline RecordLayout record_layout(const HapticState& state) { return {state.link_count, state.widget_count}; }

/// One tick of a log.
struct LogTick {
  ProbeSample input;   ///< what the tick was given: time, pose, buttons, condition
  HapticState output;  ///< what the tick answered, and what the servo measured
};

/// The number of words written; `words` has room for kMaxRecordWords.
int pack_tick(const ProbeSample& input, const HapticState& output, std::uint64_t* words) noexcept;

/// False where a word is none that a tick can write (a status without a name, say); `tick` is then half filled.
/// The caller sets output.tick and program_epoch: they stand in the block.
bool unpack_tick(const RecordWords& words, const RecordLayout& shape, LogTick& tick) noexcept;

/// Where two records of the same shape differ in what the tick did (timings do not count): "force_x recorded 1, replayed 2".
/// Empty where they are equal to the bit.
std::string first_difference(const RecordWords& recorded, const RecordWords& replayed, const std::vector<std::string>& link_names,
                             const std::vector<std::string>& widget_names = {});

/// A record as the block stores it: mask and changed words against `before`, which becomes `words`.
void compress_record(std::span<const std::uint64_t> words, RecordWords& before, std::string& out);
/// Reads one record of `count` words at the front of `bytes` into `words` (which hold the record before); the bytes it took, 0 where
/// `bytes` end too soon or the mask names words that are not there.
std::size_t decompress_record(std::string_view bytes, int count, RecordWords& words) noexcept;

}  // namespace catena::haptics::log
