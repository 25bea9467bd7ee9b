/// How a recording is laid out, and the bytes of its payloads.
///
/// Payloads as bytes: numbers and strings appended, and read back with every length checked against what is there.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace catena::haptics::log {

/// Appends numbers and strings to bytes.
class ByteWriter {
 public:
  /// Appends a number, in this machine's order of bytes.
  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  /// Appends length and bytes.
  void put_string(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes_.append(text);
  }
  /// Appends bytes as they are.
  void put_bytes(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  /// All that was appended.
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

/// After the first read past the end everything reads as zero and `good` is false.
class ByteReader {
 public:
  /// Of bytes that outlive it.
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  /// The next number.
  template <class T>
  T get() {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    if (const char* from = read_bytes(sizeof value)) std::memcpy(&value, from, sizeof value);
    return value;
  }
  /// The next string.
  std::string get_string() {
    const auto size = get<std::uint32_t>();
    const char* from = read_bytes(size);
    return from != nullptr ? std::string(from, size) : std::string();
  }
  /// nullptr where fewer are left.
  const char* read_bytes(std::size_t size) {
    if (!good_ || size > bytes_.size() - at_) {
      good_ = false;
      return nullptr;
    }
    const char* from = bytes_.data() + at_;
    at_ += size;
    return from;
  }
  /// Whether nothing was read past the end.
  bool good() const { return good_; }
  bool at_end() const { return good_ && at_ == bytes_.size(); }  ///< all read, nothing left

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

/// The recording's format, version 2. A reader needs this header alone.
///
/// All numbers are in the byte order of the machine that wrote them (the mark says which); doubles are IEEE 754 bytes, exact.
///   string = u32 length, bytes      vec3 = 3 f64      hash = FNV-1a-64 (engine/base/hash.h)
///
/// FILE       preamble, then blocks until the end of the file. The first block is the header.
/// PREAMBLE   16 bytes: the magic 89 'C' 'A' 'T' 'L' 'O' 'G' 0A; u32 version; u32 0x01020304 (the mark of the byte order)
/// BLOCK      40 bytes, then the payload:
///              u32 0x4b4c4243 ("CBLK" where little-endian), u32 type, u64 sequence (0, 1, 2 ..), u64 length of the payload,
///              u64 hash of the payload, u64 hash of the 32 bytes before it
///
/// 1 HEADER   string scene path, string working folder (of relative paths), string scene text, u32 n and n strings NAME=FILE[:GRID]
///            (fields replaced on the command line), string device, string version of Catena, f64 nominal rate in Hz,
///            i64 start in ns since 1970 (UTC), and where somebody said what it was recorded for, or plug-ins were loaded: string about;
///            where plug-ins were loaded: u32 n, n times {string file name, u64 hash of the file, u32 m, m strings: types of links that it
///            gave}. A program from before there were plug-ins calls the header of such a log damaged.
/// 2 PROGRAM  runs from `first tick` on; of two with the same first tick the second took over before that tick.  u64 epoch, u64 first tick,
///            u8 known (0: nobody told the writer what follows; the rest is empty),
///            u8 text (0: the header's scene text, 1: its own), string scene text,
///            limits: f64 stiffness N/m, rotational stiffness N m/rad, force N, torque N m, slew N/s, ramp in s, ramp out s,
///                    damping N s/m, delay s, most added damping N s/m; i32 late ticks; u8 passivity   (haptics/chain/constraint.h;
///                    infinity: none)
///            coupling: f64 stiffness N/m, damping N s/m, max force N, ramp s, rotational stiffness N m/rad, rotational damping
///                    N m s/rad; u8 combination                                   (haptics/chain/program.h)
///            f64 metres per unit, vec3 origin, 9 f64 world from device axes, column by column,
///            u32 n, n times {string link name, u64 recipe}, u32 n, n strings: names of modes,
///            u32 n, n times {string widget name, u32 revision, its pose when the program was made: 2 vec3, orientation as 4 f64 w x y z,
///                    f64 value}                                                  (engine/widget/widget.h)
///            A link keeps its state over a change where name and recipe (not 0) are the same in both programs.
/// 3 TICKS    u64 epoch, u64 first tick, u32 count, u32 links, u32 widgets, then `count` records of ticks first, first + 1 ..
///            A record is kTickWords + links * kLinkWords + widgets * kWidgetWords words of 8 bytes (record.h lists them). It is stored as
///            a mask, one bit a word (word k: bit k % 8 of byte k / 8; (words + 7) / 8 bytes), then the words whose bit is 1. A word whose
///            bit is 0 is the same as in the record before it in this block; before the block's first record all words are 0.
/// 4 GAP      u64 first tick, u64 count: ticks that are not in the log, for the writer could not keep up
/// 5 END      u64 ticks in the log, u64 ticks lost, u64 last tick, u64 state_hash (haptics/chain/state_hash.h) of the ticks in the log.
///            A log without it was cut off.
/// 6 STATE    u64 tick, u64 layout, bytes of haptics/chain ChainState: a log that begins while the servo runs has one, before its first
///            ticks, which are those after `tick`. Only a program that keeps its state in the same way (layout) can run them again.
/// 7 POSES    of a session with a headset, anywhere after the header: u32 n, n times {u64 newest tick, i64 predicted ns on the runtime's
///            clock, u8 known: one bit each for head, left hand, right hand and gaze, from the lowest on; for each bit that is 1: vec3
///            metres of room, orientation as 4 f64 w x y z}. A program from before this block calls such a log damaged and reads its ticks.
///
/// A file cut at any byte holds every block that is complete. A block whose hashes do not fit is damaged: where its own 32 bytes
/// are good its length is, too; else the next block is found by its mark.
inline constexpr unsigned char kMagic[8] = {0x89, 'C', 'A', 'T', 'L', 'O', 'G', '\n'};
inline constexpr std::uint32_t kVersion = 2;                 ///< Of the format; another one is refused.
inline constexpr std::uint32_t kByteOrderMark = 0x01020304;  ///< As the writing machine has it.
inline constexpr std::uint64_t kPreambleBytes = 16;          ///< Before the first block.

/// What a block holds.
enum class BlockType : std::uint32_t { header = 1, program = 2, ticks = 3, gap = 4, end = 5, state = 6, poses = 7 };

/// The 40 bytes before each payload.
struct BlockHeader {
  std::uint32_t magic = kBlockMagic;  ///< begins every block
  std::uint32_t type = 0;             ///< a BlockType
  std::uint64_t sequence = 0;         ///< 0, 1, 2 ..
  std::uint64_t length = 0;           ///< bytes of the payload
  std::uint64_t payload_hash = 0;     ///< FNV-1a-64 of the payload
  std::uint64_t header_hash = 0;      ///< FNV-1a-64 of the 32 bytes before it

  static constexpr std::uint32_t kBlockMagic = 0x4b4c4243;  ///< "CBLK"
  static constexpr std::uint64_t kHashedBytes = 32;         ///< bytes before header_hash
};
static_assert(sizeof(BlockHeader) == 40);

inline constexpr std::uint64_t kMaxPayload = std::uint64_t{64} << 20;  ///< of any block; a longer one is damaged

inline constexpr int kTickWords = 24;    ///< words of 8 bytes of a tick itself
inline constexpr int kLinkWords = 20;    ///< and of each link
inline constexpr int kWidgetWords = 12;  ///< and of each widget

}  // namespace catena::haptics::log
