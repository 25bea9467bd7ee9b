// SPDX-License-Identifier: MIT
// Arrays in one file without chunks: .npy, and .raw with the layout of the request. Rows are read where they lie.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "engine/base/helper_process.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/io/chunks/copy_part.h"
#include "engine/io/chunks/open_store.h"
#include "engine/io/chunks/pyramid.h"
#include "engine/io/sandbox/npy.h"

namespace catena::chunks {
namespace {

using field::ArrayLayout;
using field::Index3;
using field::StoreBox;
using field::StoreGrid;
using field::StoreRequest;

class ArrayStore final : public OpenStore {
 public:
  explicit ArrayStore(StorePath path) : path_(std::move(path)) {}
  Outcome open(const ArrayLayout& layout);
  Outcome read(const StoreRequest& request, std::span<std::byte> values) override;

 private:
  Result<sandbox::NpyHeader> read_header(const ArrayLayout& layout);
  Outcome read_bytes(std::uint64_t at, std::span<std::byte> bytes) const;

  StorePath path_;
  FileDescriptor file_;
  std::uint64_t file_bytes_ = 0;
  sandbox::NpyHeader head_;
  std::array<int, 3> order_{0, 1, 2};  ///< Axes, the fastest first.
  std::vector<std::byte> slab_;
};

/// Returns the header of a .npy file, or one with the layout of a .raw file.
Result<sandbox::NpyHeader> ArrayStore::read_header(const ArrayLayout& layout) {
  if (layout.is_raw == 0) {
    constexpr std::uint64_t kMaxBytes = 1 << 17;
    std::vector<std::byte> begin(static_cast<std::size_t>(std::min(kMaxBytes, file_bytes_)));
    CATENA_CHECK(read_bytes(0, begin));
    auto head = sandbox::read_npy_header(begin, layout.axes_xyz != 0);
    if (!head) return Error{path_.shown + ": " + head.error().message};
    if (head->type == "bool") head->type = "uint8";
    return head;
  }
  sandbox::NpyHeader head;
  head.type.assign(layout.type, ::strnlen(layout.type, ArrayLayout::kMaxType));
  head.size = {layout.shape.x, layout.shape.y, layout.shape.z};
  head.stride[0] = 1;
  head.stride[1] = static_cast<std::uint64_t>(head.size.x);
  head.stride[2] = head.stride[1] * static_cast<std::uint64_t>(head.size.y);
  return head;
}

Outcome ArrayStore::open(const ArrayLayout& layout) {
  file_ = FileDescriptor(::open(path_.real.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat about {};
  if (!file_ || ::fstat(file_.get(), &about) != 0) return system_error(path_.shown + ": cannot be opened", errno);
  record_file(about);
  file_bytes_ = static_cast<std::uint64_t>(about.st_size);
  CATENA_TRY(head_, read_header(layout));
  const auto type = field::find_number_type(head_.type);
  if (!type || head_.components > 1)
    return Error{fmt::format("{}: has {}, expected scalars of a number type of at least 8 bits that stores have", path_.shown,
                             head_.components > 1 ? "vectors" : head_.type)};
  head_.number_bytes = type->bytes;
  const field::Size3& n = head_.size;
  for (const std::int64_t voxels : {n.x, n.y, n.z})
    if (voxels < 1 || voxels > field::kMaxStoreAxis) return Error{fmt::format("{}: an axis has {} voxels", path_.shown, voxels)};
  const long double bytes = static_cast<long double>(n.x) * n.y * n.z * static_cast<long double>(type->bytes);
  if (bytes + static_cast<long double>(head_.data_offset) != static_cast<long double>(file_bytes_))
    return Error{fmt::format("{}: the file has {} bytes of array data, expected {:.0f}", path_.shown, file_bytes_ - head_.data_offset,
                             static_cast<double>(bytes))};
  constexpr std::uint64_t kNone = ~std::uint64_t{0};  // an axis that the array does not have
  std::ranges::stable_sort(order_, {}, [&](int a) { return head_.stride[a] == 0 ? kNone : head_.stride[a]; });
  StoreGrid grid;
  grid.name = one_line(std::filesystem::path(path_.shown).stem().string());
  grid.type = head_.type;
  const Index3 size{static_cast<int>(n.x), static_cast<int>(n.y), static_cast<int>(n.z)};
  int row[3] = {1, 1, 1};
  const int along[3] = {size.x, size.y, size.z};
  row[order_[0]] = along[order_[0]];
  const Vec3 spacing(layout.spacing[0], layout.spacing[1], layout.spacing[2]);
  for (int a = 0; a < 3; ++a)
    if (!(spacing[a] > 0)) return Error{fmt::format("{}: spacing is {}, expected positive numbers", path_.shown, spacing[a])};
  const Vec3 origin(layout.origin[0], layout.origin[1], layout.origin[2]);
  grid.levels.push_back(make_level(grid, size, {row[0], row[1], row[2]}, spacing, origin));
  description_.grids.push_back(std::move(grid));
  return Done{};
}

Outcome ArrayStore::read_bytes(std::uint64_t at, std::span<std::byte> bytes) const {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got = ::pread(file_.get(), bytes.data() + done, bytes.size() - done, static_cast<off_t>(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_error(path_.shown + ": cannot be read", errno);
    if (got == 0) return Error{path_.shown + ": cannot be read to the end"};
    done += static_cast<std::size_t>(got);
  }
  return Done{};
}

/// Reads slabs of the two fastest axes; rows that follow each other in the file are read at once.
Outcome ArrayStore::read(const StoreRequest& request, std::span<std::byte> values) {
  const StoreBox& box = request.box;
  const std::array<int, 3> lo{box.lo.x, box.lo.y, box.lo.z}, count{box.size.x, box.size.y, box.size.z};
  const std::array<std::int64_t, 3> all{head_.size.x, head_.size.y, head_.size.z};
  const auto [row, layer, slab] = order_;
  const auto at = [](const auto& numbers, int axis) { return static_cast<std::uint64_t>(numbers[static_cast<std::size_t>(axis)]); };
  const std::uint64_t row_bytes = at(count, row) * head_.number_bytes;
  const bool is_whole_row = at(count, row) == at(all, row);
  const std::uint64_t pieces = is_whole_row ? 1 : at(count, layer), piece_bytes = row_bytes * at(count, layer) / pieces;
  slab_.resize(static_cast<std::size_t>(row_bytes * at(count, layer)));
  ChunkView view;
  view.first = slab_.data();
  view.stride[row] = static_cast<std::ptrdiff_t>(head_.number_bytes);
  view.stride[layer] = static_cast<std::ptrdiff_t>(row_bytes);
  for (std::uint64_t k = 0; k < at(count, slab); ++k) {
    const std::uint64_t first =
        at(lo, row) * head_.stride[row] + at(lo, layer) * head_.stride[layer] + (at(lo, slab) + k) * head_.stride[slab];
    for (std::uint64_t i = 0; i < pieces; ++i)
      CATENA_CHECK(read_bytes(head_.data_offset + (first + i * head_.stride[layer]) * head_.number_bytes,
                              std::span(slab_).subspan(static_cast<std::size_t>(i * piece_bytes), static_cast<std::size_t>(piece_bytes))));
    std::array<int, 3> from = lo, size = count;
    from[static_cast<std::size_t>(slab)] += static_cast<int>(k);
    size[static_cast<std::size_t>(slab)] = 1;
    view.box = {{from[0], from[1], from[2]}, {size[0], size[1], size[2]}};
    copy_part(view, box, head_.number_bytes, values);
  }
  if (head_.is_byte_swapped) swap_bytes(values, head_.number_bytes);
  return Done{};
}

}  // namespace

Result<std::unique_ptr<OpenStore>> open_array(const StorePath& path, const ArrayLayout& layout) {
  auto store = std::make_unique<ArrayStore>(path);
  CATENA_CHECK(store->open(layout));
  return std::unique_ptr<OpenStore>(std::move(store));
}

}  // namespace catena::chunks
