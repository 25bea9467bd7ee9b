// SPDX-License-Identifier: MIT
/// File format of a recording, and the serialization of its payloads: numbers and strings are appended to bytes, and read back with every
/// length checked against the bytes that remain.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace catena::haptics::log {

/// Serializer: appends numbers and strings to bytes.
class ByteWriter {
 public:
  /// Appends a number in the byte order of this machine.
  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  /// Appends a string: its length (u32), then its bytes.
  void put_string(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes_.append(text);
  }
  /// Appends bytes unchanged.
  void put_bytes(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  /// Returns all bytes that were appended.
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

/// Deserializer of numbers and strings. After the first read past the end all reads return zero or empty, and is_ok() is false.
class ByteReader {
 public:
  /// Creates a reader of bytes, which must outlive it.
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  /// Returns the next number.
  template <class T>
  T get() {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    if (const char* from = read_bytes(sizeof value)) std::memcpy(&value, from, sizeof value);
    return value;
  }
  /// Returns the next string.
  std::string get_string() {
    const auto size = get<std::uint32_t>();
    const char* from = read_bytes(size);
    return from != nullptr ? std::string(from, size) : std::string();
  }
  /// Returns a pointer to the next `size` bytes; null if fewer are left.
  const char* read_bytes(std::size_t size) {
    if (!is_ok_ || size > bytes_.size() - at_) {
      is_ok_ = false;
      return nullptr;
    }
    const char* from = bytes_.data() + at_;
    at_ += size;
    return from;
  }
  /// Returns whether no read went past the end.
  bool is_ok() const { return is_ok_; }
  /// Returns whether exactly all bytes have been read.
  bool at_end() const { return is_ok_ && at_ == bytes_.size(); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool is_ok_ = true;
};

// Format of a recording, version 2. This description is sufficient to write a reader.
//
// All numbers are in the byte order of the machine that wrote them (given by the byte order mark); doubles are exact IEEE 754 bytes.
//   string = u32 length, bytes      vec3 = 3 f64      hash = FNV-1a-64 (engine/base/hash.h)
//
// FILE       preamble, then blocks until the end of the file. The first block is the header.
// PREAMBLE   16 bytes: the magic 89 'C' 'A' 'T' 'L' 'O' 'G' 0A; u32 version; u32 0x01020304 (the byte order mark)
// BLOCK      40 bytes, then the payload:
//              u32 0x4b4c4243 ("CBLK" where little-endian), u32 type, u64 sequence (0, 1, 2 ..), u64 length of the payload,
//              u64 hash of the payload, u64 hash of the 32 bytes before it
//
// 1 HEADER   string scene path, string working folder (of relative paths), string scene text, u32 n and n strings NAME=FILE[:GRID]
//            (fields replaced on the command line), string device, string version of Catena, f64 nominal rate in Hz,
//            i64 start in ns since 1970 (UTC); if the purpose of the recording is given or plug-ins were loaded: string about (the
//            purpose); if plug-ins were loaded: u32 n, n times {string file name, u64 hash of the file, u32 m, m strings: constraint types
//            that it added}. Versions of Catena without plug-in support report the header of a log with plug-ins as damaged.
// 2 PROGRAM  runs from `first tick` on; of two with the same first tick the second one took over before that tick.  u64 epoch, u64 first
//            tick, u8 known (0: the program is unknown to the writer; the rest is empty),
//            u8 text (0: the header's scene text, 1: its own), string scene text,
//            limits: f64 stiffness N/m, rotational stiffness N m/rad, force N, torque N m, slew N/s, ramp in s, ramp out s,
//                    damping N s/m, delay s, max added damping N s/m; i32 max late ticks; u8 passivity control
//                    (haptics/chain/constraint.h; infinity: none)
//            coupling: f64 stiffness N/m, damping N s/m, max force N, ramp s, rotational stiffness N m/rad, rotational damping
//                    N m s/rad; u8 method (CouplingMethod)                       (haptics/chain/program.h)
//            f64 meters per unit, vec3 origin, 9 f64 world from device axes, column by column,
//            u32 n, n times {string link name, u64 spec hash}, u32 n, n strings: names of modes,
//            u32 n, n times {string widget name, u32 revision, its pose when the program was built: 2 vec3, orientation as 4 f64 w x y z,
//                    f64 value}                                                  (engine/widget/widget.h)
//            A link keeps its state over a change of program if name and spec hash (not 0) are the same in both.
// 3 TICKS    u64 epoch, u64 first tick, u32 count, u32 links, u32 widgets, then `count` records of ticks first, first + 1 ..
//            A record is kTickWords + links * kLinkWords + widgets * kWidgetWords words of 8 bytes (record.h lists them). It is stored as
//            a mask, one bit per word (word k: bit k % 8 of byte k / 8; (words + 7) / 8 bytes), then the words whose bit is 1. A word
//            whose bit is 0 equals that of the preceding record in this block; before the block's first record all words are 0.
// 4 GAP      u64 first tick, u64 count: ticks that are not in the log because the writer could not keep up
// 5 END      u64 ticks in the log, u64 ticks lost, u64 last tick, u64 state_hash (haptics/chain/state_hash.h) of the ticks in the log.
//            A log without this block is truncated.
// 6 STATE    u64 tick, u64 layout, bytes of haptics/chain ChainState: a log that begins while the servo runs has one, before its first
//            ticks, which are those after `tick`. Only a build of Catena with the same state layout can replay them.
// 7 POSES    poses of a session with a headset, anywhere after the header: u32 n, n times {u64 newest tick, i64 predicted ns on the
//            runtime's clock, u8 known: one bit each for head, left hand, right hand and gaze, from the lowest on; for each bit that is 1:
//            vec3 in meters of the stage space, orientation as 4 f64 w x y z}. Versions of Catena without this block report such a log as
//            damaged and read its ticks.
//
// 8 BRICKS   bricks of the program's paged grids that are in memory from `first tick` on, as a change of the list of the block before it
//            (at first empty): u64 first tick, u32 n and n bricks that leave, u32 n and n that arrive; brick = u32 index of the grid in the
//            program, u64 number of the brick (engine/field/bricks/paged_grid.h). Lists are sorted. Versions of Catena without paged grids
//            report such a log as damaged.
//
// A file truncated at any byte still contains every complete block. A block whose hashes do not match is damaged: if the hash of its first
// 32 bytes matches, its length is valid; else the next block is found by its magic number.

/// Magic number at the start of the file: 89 'C' 'A' 'T' 'L' 'O' 'G' 0A.
inline constexpr unsigned char kMagic[8] = {0x89, 'C', 'A', 'T', 'L', 'O', 'G', '\n'};
inline constexpr std::uint32_t kVersion = 2;                 ///< version of the format; other versions are rejected
inline constexpr std::uint32_t kByteOrderMark = 0x01020304;  ///< written in the byte order of the machine
inline constexpr std::uint64_t kPreambleBytes = 16;          ///< size of the preamble

/// Type of a block.
enum class BlockType : std::uint32_t { header = 1, program = 2, ticks = 3, gap = 4, end = 5, state = 6, poses = 7, bricks = 8 };

/// Header of a block, the 40 bytes before each payload.
struct BlockHeader {
  std::uint32_t magic = kBlockMagic;  ///< magic number at the start of every block
  std::uint32_t type = 0;             ///< BlockType of the block
  std::uint64_t sequence = 0;         ///< sequence number of the block: 0, 1, 2 ..
  std::uint64_t length = 0;           ///< size of the payload in bytes
  std::uint64_t payload_hash = 0;     ///< FNV-1a-64 hash of the payload
  std::uint64_t header_hash = 0;      ///< FNV-1a-64 hash of the preceding 32 bytes

  static constexpr std::uint32_t kBlockMagic = 0x4b4c4243;  ///< "CBLK"
  static constexpr std::uint64_t kHashedBytes = 32;         ///< number of bytes that header_hash covers
};
static_assert(sizeof(BlockHeader) == 40);

/// Maximum size of a block's payload in bytes; a block with a longer one counts as damaged.
inline constexpr std::uint64_t kMaxPayload = std::uint64_t{64} << 20;

inline constexpr int kTickWords = 24;    ///< number of 8-byte words of a record for the tick itself
inline constexpr int kLinkWords = 20;    ///< number of words for each link
inline constexpr int kWidgetWords = 12;  ///< number of words for each widget

}  // namespace catena::haptics::log
