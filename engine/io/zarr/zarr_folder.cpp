// SPDX-License-Identifier: MIT
#include "engine/io/zarr/zarr_folder.h"

#include <blosc.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "engine/base/output_file.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/field/bricks/brick_range.h"
#include "engine/io/zarr/brick_values.h"
#include "engine/io/zarr/write_zarr.h"
#include "engine/io/zarr/zarr_metadata.h"

namespace catena::field {
namespace {

namespace fs = std::filesystem;

Error store_error(const std::string& path, int code) {
  return {fmt::format("{}: cannot write: {}", one_line(path), describe_errno(code)), true};
}

Outcome write_store_text(const std::string& path, const std::string& text) {
  auto out = OutputFile::open(path);
  if (!out) return Error{out.error().message, true};
  out->write(text);
  if (const Outcome done = out->commit(); !done) return Error{done.error().message, true};
  return Done{};
}

constexpr std::string_view kIdentityStart = "catena OME-Zarr 2\n";

std::string read_identity(const std::string& folder) {
  std::ifstream in(folder + "/identity", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns whether a folder has nothing of a store: it is new, or the program ended while it was created or removed.
bool has_no_store(const std::string& folder) {
  std::error_code code;
  const bool is_own = read_identity(folder).starts_with(kIdentityStart);
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    const std::string name = at->path().filename().string();
    const bool is_temporary = name.starts_with("identity.part") && std::isdigit(static_cast<unsigned char>(name.c_str()[13])) != 0;
    if (!is_temporary && !(is_own && (name == "identity" || name == "log"))) return false;
  }
  return !code;
}

Outcome write_metadata(const std::string& store, const VoxelSource& source, const std::vector<BrickLevel>& levels,
                       const BrickRange& range) {
  std::error_code code;
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const std::string folder = fmt::format("{}/{}", store, level);
    fs::create_directories(folder, code);
    if (code) return store_error(folder, code.value());
    CATENA_CHECK(write_store_text(folder + "/.zarray", zarray_text(source, levels[level])));
  }
  CATENA_CHECK(write_store_text(store + "/.zgroup", "{\"zarr_format\": 2}\n"));
  return write_store_text(store + "/.zattrs", zattrs_text(source, levels, range));
}

}  // namespace

Outcome check_new_store(const std::string& path) {
  std::error_code code;
  const fs::file_status status = fs::symlink_status(path, code);
  if (!fs::status_known(status)) return Error{one_line(path) + ": cannot be written: " + code.message(), true};
  if (status.type() != fs::file_type::not_found)
    return Error{one_line(path) + ": something with this name exists, expected a new name: a store is never overwritten"};
  return check_output(path, {});
}

ZarrFolder::ZarrFolder(std::string path, FolderLock lock, BrickLog log, std::vector<BrickLevel> levels, NumberType type, double fill)
    : path_(std::move(path)),
      part_(path_ + ".part"),
      store_path_(part_ + "/store"),
      lock_(std::move(lock)),
      log_(std::move(log)),
      levels_(std::move(levels)),
      type_(type),
      fill_(kBrickVoxels * type.bytes) {
  field::fill_brick(type_, fill, fill_);
}

Result<std::unique_ptr<ZarrFolder>> ZarrFolder::open(const std::string& path, const VoxelSource& source, std::vector<BrickLevel> levels) {
  CATENA_CHECK(check_new_store(path));
  const std::string part = path + ".part", store = part + "/store";
  std::error_code code;
  if (const fs::file_status found = fs::symlink_status(part, code);
      fs::status_known(found) && found.type() != fs::file_type::not_found && found.type() != fs::file_type::directory)
    return Error{one_line(part) + ": is not a folder, expected a free name: the store is built there"};
  if (!fs::create_directory(part, code) && code) return store_error(part, code.value());
  auto lock = FolderLock::acquire(part);
  if (!lock) return lock.error();
  // all that the bytes of the store depend on
  std::string identity = fmt::format("{}{}", kIdentityStart, source.identity);
  for (const BrickLevel& level : levels) identity += zarray_text(source, level);
  identity += zattrs_text(source, levels, {true, true, 0, 0});
  if (has_no_store(part)) {
    fs::remove(part + "/log", code);
    CATENA_CHECK(write_store_text(part + "/identity", identity));
  } else {
    if (read_identity(part) != identity || source.identity.empty())
      return Error{one_line(part) +
                   ": an unfinished store of another input, or with other options, is in the way; finish it with the "
                   "command that began it, or remove this folder"};
  }
  CATENA_TRY(BrickLog log, BrickLog::open(part + "/log", levels));
  CATENA_CHECK(write_metadata(store, source, levels, {true, true, 0, 0}));
  return std::unique_ptr<ZarrFolder>(
      new ZarrFolder(path, std::move(*lock), std::move(log), std::move(levels), source.type, stored_fill_value(source)));
}

std::string ZarrFolder::chunk_path(int level, const Index3& brick) const {
  return fmt::format("{}/{}/{}/{}/{}", store_path_, level, brick.z, brick.y, brick.x);
}

Outcome ZarrFolder::write_chunk(int level, const Index3& brick, std::span<const std::byte> values) const {
  const std::string path = chunk_path(level, brick), temporary = path + ".part";
  thread_local std::vector<char> packed;
  packed.resize(values.size() + BLOSC_MAX_OVERHEAD);
  constexpr int kCompressionLevel = 5;
  const int bytes = ::blosc_compress_ctx(kCompressionLevel, BLOSC_SHUFFLE, type_.bytes, values.size(), values.data(), packed.data(),
                                         packed.size(), BLOSC_LZ4_COMPNAME, 0, 1);
  if (bytes <= 0) return Error{one_line(path) + ": the values cannot be compressed", true};
  std::FILE* file = std::fopen(temporary.c_str(), "wbe");
  if (file == nullptr && errno == ENOENT) {
    std::error_code code;
    fs::create_directories(fs::path(path).parent_path(), code);
    if (code) return store_error(path, code.value());
    file = std::fopen(temporary.c_str(), "wbe");
  }
  if (file == nullptr) return store_error(path, errno);
  const auto count = static_cast<std::size_t>(bytes);
  int cause = std::fwrite(packed.data(), 1, count, file) == count ? 0 : errno;
  if (std::fclose(file) != 0 && cause == 0) cause = errno;
  if (cause == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) cause = errno;
  if (cause == 0) return Done{};
  std::remove(temporary.c_str());
  return store_error(path, cause);
}

Result<BrickState> ZarrFolder::write(int level, const Index3& brick, std::span<const std::byte> values) {
  const BrickState state = is_same_brick(values, fill_) ? BrickState::empty : BrickState::stored;
  const Index3 size = brick_size(levels_[static_cast<std::size_t>(level)], brick), edge{kBrickEdge, kBrickEdge, kBrickEdge};
  const BrickRange range = find_range(type_, values, size, edge);
  if (state == BrickState::stored) CATENA_CHECK(write_chunk(level, brick, values));
  CATENA_CHECK(log_.record(level, brick, state, range, brick_checksum(type_.bytes, values, size, edge)));
  return state;
}

Outcome ZarrFolder::read(int level, const Index3& brick, std::span<std::byte> values) {
  {
    const std::scoped_lock lock(mutex_);
    if (!reader_) {
      CATENA_TRY(reader_, Store::open(store_path_, /*is_input=*/false));
    }
  }
  if (const std::string chunk = chunk_path(level, brick); ::access(chunk.c_str(), R_OK) != 0)
    return Error{one_line(chunk) + ": this chunk of the unfinished store is missing; the folder " + one_line(part_) + " can be removed"};
  const Index3 size = brick_size(levels_[static_cast<std::size_t>(level)], brick), edge{kBrickEdge, kBrickEdge, kBrickEdge};
  const StoreBox box{{brick.x * kBrickEdge, brick.y * kBrickEdge, brick.z * kBrickEdge}, size};
  if (size == edge) {
    CATENA_CHECK(reader_->read(0, level, 0, box, values));
  } else {
    std::vector<std::byte> inner(static_cast<std::size_t>(box.voxels()) * type_.bytes);
    CATENA_CHECK(reader_->read(0, level, 0, box, inner));
    copy_box(type_.bytes, inner, size, {0, 0, 0}, values, edge, {0, 0, 0}, size);
  }
  if (brick_checksum(type_.bytes, values, size, edge) == log_.checksum(level, brick)) return Done{};
  return Error{one_line(chunk_path(level, brick)) + ": this chunk of the unfinished store is damaged; the folder " + one_line(part_) +
               " can be removed"};
}

Result<BrickIndex> ZarrFolder::read_index(const VoxelSource& source) const { return log_.read_index(stored_fill_value(source)); }

Outcome ZarrFolder::commit(const VoxelSource& source) {
  reader_.reset();
  CATENA_CHECK(write_store_text(store_path_ + "/.zattrs", zattrs_text(source, levels_, log_.range())));
  const int folder = ::open(store_path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return store_error(store_path_, errno);
  const int synced = ::syncfs(folder) == 0 ? 0 : errno;
  ::close(folder);
  if (synced != 0) return store_error(store_path_, synced);
  CATENA_CHECK(check_new_store(path_));
  if (std::rename(store_path_.c_str(), path_.c_str()) != 0) return store_error(path_, errno);
  remove();
  return Done{};
}

void ZarrFolder::remove() const {
  std::error_code code;
  fs::remove_all(part_, code);
}

}  // namespace catena::field
