// SPDX-License-Identifier: MIT
/// Protocol between catena and the reader process of stores, catena-read-chunks: OME-Zarr and Zarr, HDF5, TIFF, arrays. Private to this
/// module and to engine/io/chunks. The process lives as long as the store is open and answers one request at a time:
///   catena sends        a StoreRequest, followed by the path when a store is opened, as one packet of the socket
///   the reader writes   the description, or the voxels of a box, to the start of the shared memory
///   the reader sends    a StoreAnswer, followed by a message when it failed
/// The shared memory has a fixed, sealed size. Contents are untrusted: catena copies them before it checks them.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/base/input_files.h"
#include "engine/field/cell.h"
#include "engine/field/mapping.h"
#include "engine/io/volume/load_field.h"

namespace catena::field {

inline constexpr std::uint32_t kStoreProtocolVersion = 2;
/// Descriptors in the reader: shared memory, socket.
inline constexpr int kStoreMemoryFd = 3, kStoreSocketFd = 4;
/// Size of the shared memory, and so the largest box of one request, bytes.
inline constexpr std::uint64_t kStoreMemoryBytes = std::uint64_t{32} << 20;
/// Largest packets: a request with its path, an answer with its message.
inline constexpr std::size_t kMaxStorePacket = 8192, kMaxStoreMessage = 2000;
/// Most voxels along an axis.
inline constexpr std::int64_t kMaxStoreAxis = 1 << 24;

/// A box of voxels of a level.
struct StoreBox {
  Index3 lo{0, 0, 0}, size{0, 0, 0};
  /// Returns the number of voxels.
  double voxels() const { return static_cast<double>(size.x) * size.y * size.z; }
};

/// Kind of request. open: the description. read: the voxels of a box. list: one byte per brick of a level, 0: nothing is stored for it.
enum class StoreAction : std::uint32_t { open, read, list };

/// What the file of an array does not state itself: of a .raw file everything, of a .npy file the position. Plain bytes.
struct ArrayLayout {
  static constexpr std::size_t kMaxType = 16;
  std::int32_t is_raw = 0;        ///< 1: a .raw file.
  std::int32_t axes_xyz = 0;      ///< 1: the first index of a .npy file is x, not z.
  Index3 shape{0, 0, 0};          ///< Voxels of a .raw file, x fastest.
  char type[kMaxType] = {};       ///< Number type of a .raw file (engine/field/number_type.h), little-endian.
  double spacing[3] = {1, 1, 1};  ///< World units per voxel.
  double origin[3] = {0, 0, 0};   ///< World position of voxel (0, 0, 0).
  bool operator==(const ArrayLayout&) const = default;
};

/// A request, plain bytes.
struct StoreRequest {
  std::uint32_t version = kStoreProtocolVersion;
  StoreAction action = StoreAction::open;
  std::uint32_t path_bytes = 0;      ///< Only for open: length of the path that follows.
  std::int32_t grid = 0, level = 0;  ///< Indices in the description.
  std::int32_t step = 0;             ///< Time step.
  StoreBox box;                      ///< For read.
  std::uint64_t memory_bytes = 0;    ///< Only for open: memory limit of the reader.
  std::uint64_t cpu_s = 0;           ///< CPU time that this request may take, seconds.
  ArrayLayout layout;                ///< Only for open.
};

/// An answer, plain bytes.
struct StoreAnswer {
  std::uint32_t version = kStoreProtocolVersion;
  std::uint32_t failed = 0;          ///< 1: a message follows.
  std::uint32_t system_failure = 0;  ///< 1: the system, not the store, is at fault.
  std::uint64_t bytes = 0;           ///< Bytes written to the shared memory.
};

/// A resolution level of a grid in a store.
struct StoreLevel {
  Index3 size{0, 0, 0};   ///< Voxels along x, y, z.
  Index3 chunk{0, 0, 0};  ///< Voxels of a chunk: what is stored and decoded together.
  Mapping mapping;        ///< World from index.
};

/// A scalar grid in a store: one channel, one label image, or one array.
struct StoreGrid {
  std::string name;
  std::string type;           ///< Number type (engine/field/number_type.h).
  std::string length_unit;    ///< Empty: not specified.
  std::string value_unit;     ///< Empty: not specified.
  bool is_label_map = false;  ///< Integers that stand for labels.
  bool has_window = false;    ///< The file states a range to display, `window`.
  double window[2] = {0, 0};
  std::int32_t color = -1;  ///< 0xRRGGBB; -1: not specified.
  double fill_value = 0;    ///< Value of voxels for which nothing is stored.
  std::int32_t steps = 1;   ///< Time steps.
  std::vector<StoreLevel> levels;
};

/// Contents of a store.
struct StoreDescription {
  std::vector<StoreGrid> grids;
  std::vector<double> times;         ///< Times of the steps; empty: one step.
  std::string time_unit;             ///< Empty: not specified.
  std::vector<std::string> notes;    ///< What is left out or unusual: sentences without a final period.
  std::vector<FileId> opened_files;  ///< Files that were read for the description.
  std::int64_t newest_mtime_ns = 0;  ///< Latest modification time of these files.
};

/// Encodes a description.
std::string encode(const StoreDescription& store);
/// Decodes and validates a description: types, sizes, transforms, counts. Returns an Error with a message fragment.
Result<StoreDescription> decode_store(std::span<const std::byte> bytes);

}  // namespace catena::field
