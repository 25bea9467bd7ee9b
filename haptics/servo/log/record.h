// SPDX-License-Identifier: MIT
/// Record of one tick in a log: input, result and timings of the servo, as 64-bit words.
///   0      t_s of the probe                    1-3   probe position, world units
///   4-7    probe orientation w x y z           8     bytes: u32 buttons, u8 condition, u8 forces_on, u8 force_state, i8 mode
///   9      t_s that the tick reports           10-12 commanded force, N
///   13-15  chain force, N                      16-18 torque, N m
///   19     energy_j      20  dissipated_j      21    u64 missed deadlines since the start
///   22     f32 period_us, f32 compute_us       23    f32 device_us, u32 0
/// and for every link, from word 24 + 20 i on:
///   0-2    proxy          3-5  force share     6 residual   7 weight   8 stiffness   9 gap
///   10-13  orientation w x y z                 14-16 torque share      17 accounted_j   18 release_ratio
///   19     bytes: i32 evaluations, u8 status, u8 active, u8 released, u8 sample_status (0 in recordings of versions without it)
/// and for every widget, after the links, 12 words:
///   0-2    points[0]      3-5  points[1]       6-9   orientation w x y z                  10  value
///   11     bytes: u32 revision, u8 mode, i8 handle, u8 active_planes, u8 0
/// Names and units: engine/base/haptic_state.h, haptics/chain/tick.h. Timings are single precision; all other numbers are exact.
/// HapticState::omitted_work_j and LinkReport::curve are not recorded.
/// `pack_tick` runs on the haptic thread: no allocation, lock or throw.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "haptics/chain/tick.h"
#include "haptics/servo/log/format.h"

namespace catena::haptics::log {

/// Number of words of the longest record.
inline constexpr int kMaxRecordWords = kTickWords + kLinkWords * kMaxLinks + kWidgetWords * kMaxWidgets;
/// Words of a record; a shorter record uses the first ones.
using RecordWords = std::array<std::uint64_t, kMaxRecordWords>;

/// Layout of a record: numbers of links and widgets.
struct RecordLayout {
  int links = 0, widgets = 0;  ///< number of links, number of widgets
  bool operator==(const RecordLayout&) const = default;
  /// Returns whether the numbers are within their limits.
  bool is_valid() const { return links >= 0 && links <= kMaxLinks && widgets >= 0 && widgets <= kMaxWidgets; }
};
/// Returns the number of words of a record of this layout.
inline constexpr int record_word_count(const RecordLayout& shape) {
  return kTickWords + kLinkWords * shape.links + kWidgetWords * shape.widgets;
}
/// Returns the layout of the record of a state.
inline RecordLayout record_layout(const HapticState& state) { return {state.link_count, state.widget_count}; }

/// Tick of a log.
struct LogTick {
  ProbeSample input;   ///< input of the tick: time, pose, buttons, condition
  HapticState output;  ///< result of the tick, and timings of the servo
};

/// Writes the record of a tick to `words`, which has space for kMaxRecordWords. Returns the number of words written.
CATENA_EXPORT int pack_tick(const ProbeSample& input, const HapticState& output, std::uint64_t* words) noexcept;

/// Converts a record to a tick. Returns false if a word has a value that no tick can write, such as an unknown status; `tick` is then
/// partly set. The caller sets output.tick and program_epoch, which are stored in the block.
CATENA_EXPORT bool unpack_tick(const RecordWords& words, const RecordLayout& shape, LogTick& tick) noexcept;

/// Returns the first difference between two records of the same layout in the input or result of the tick (timings are ignored), such as
/// "force_x recorded 1, replayed 2"; empty if they are bit-identical.
CATENA_EXPORT std::string first_difference(const RecordWords& recorded, const RecordWords& replayed,
                                           const std::vector<std::string>& link_names, const std::vector<std::string>& widget_names = {});

/// Appends a record to `out` as a block stores it: the mask, then the words that differ from `before`. Copies `words` to `before`.
CATENA_EXPORT void compress_record(std::span<const std::uint64_t> words, RecordWords& before, std::string& out);
/// Reads one record of `count` words from the start of `bytes` into `words`, which hold the preceding record. Returns the number of bytes
/// read; 0 if `bytes` is too short or the mask refers to words beyond `count`.
CATENA_EXPORT std::size_t decompress_record(std::string_view bytes, int count, RecordWords& words) noexcept;

}  // namespace catena::haptics::log
