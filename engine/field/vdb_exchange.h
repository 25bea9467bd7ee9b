/// Private to this room and to engine/vdb: what catena and its reader of .vdb files, the program catena-read, tell each other. Both see one
/// file in memory:
///   catena writes        the head (where the request is), the request
///   catena-read writes   buffers (each at a multiple of kPieceAlignment), the reply, and last the head (where the reply is)
/// What is decoded is held to its bounds, but nothing in it is believed: see check_nano and load_vdb.cpp.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/field/load.h"

namespace catena::field {

inline constexpr std::uint64_t kExchangeMagic = 0x31615644'6e746143;  // "CatnDVa1"
inline constexpr std::uint32_t kExchangeVersion = 1;
inline constexpr std::uint64_t kPieceAlignment = 4096;

struct ExchangeHead {
  std::uint64_t magic = kExchangeMagic;
  std::uint32_t version = kExchangeVersion;
  std::uint32_t from_reader = 0;  ///< 0: a request follows; 1: a reply
  std::uint64_t offset = 0, bytes = 0;
};

enum class ReadMode : std::uint8_t { load, describe, units };

struct ReadRequest {
  ReadMode mode = ReadMode::load;
  LoadRequest what;  ///< without the layout of raw files
  std::uint64_t memory_bytes = 0;
  std::uint64_t cpu_s = 0;
};

struct Piece {
  std::uint64_t offset = 0, bytes = 0;
};

/// What the reader could shut itself into.
struct Confinement {
  std::uint32_t landlock_version = 0;  ///< 0: this kernel has none
  bool seccomp = false;
};

/// Text metadata of a grid that may name units, and whether it says that it is a level set.
struct GridWords {
  std::string name, unit, unit_length;
  bool level_set = false;
};

struct ReadReply {
  std::string error;  ///< not empty: a sentence, and nothing else
  // load
  std::string name;
  bool is_vector = false, masked = false;
  Mapping mapping;
  Piece values, voxels, cells;
  // describe
  std::vector<GridInfo> grids;
  // always
  std::string units, unit_length;  ///< of the file
  std::vector<GridWords> words;
  Confinement confinement;
};

std::string encode(const ReadRequest& request);
std::string encode(const ReadReply& reply);
/// An error is a phrase.
Result<ReadRequest> decode_request(std::span<const std::byte> bytes);
Result<ReadReply> decode_reply(std::span<const std::byte> bytes);

}  // namespace catena::field
