// SPDX-License-Identifier: MIT
#include "engine/io/chunks/open_store.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <string_view>

#include "engine/base/text.h"

namespace catena::chunks {

Outcome OpenStore::list(const field::StoreRequest&, std::span<std::uint8_t> present) {
  std::ranges::fill(present, std::uint8_t{1});
  return Done{};
}

void OpenStore::record_file(const struct stat& about) {
  description_.opened_files.push_back(to_file_id(about));
  description_.newest_mtime_ns = std::max(description_.newest_mtime_ns, modified_ns(about));
}

Result<std::unique_ptr<OpenStore>> open_store(const StorePath& path, const field::ArrayLayout& layout) {
  const auto is_tiff = [](const std::string& name) {
    return std::ranges::any_of(std::initializer_list<std::string_view>{".tif", ".tiff", ".btf", ".tf8", ".tf2"},
                               [&](std::string_view extension) { return has_extension(name, extension); });
  };
  if (layout.is_raw != 0 || has_extension(path.real, ".npy")) return open_array(path, layout);
  std::error_code code;
  if (!std::filesystem::is_directory(path.real, code)) return is_tiff(path.real) ? open_tiff(path) : open_hdf5(path);
  for (const char* name : {"/.zarray", "/.zgroup", "/.zattrs", "/zarr.json"})
    if (std::filesystem::exists(path.real + name, code)) return open_zarr(path);
  for (std::filesystem::directory_iterator at(path.real, code), end; !code && at != end; at.increment(code))
    if (is_tiff(at->path().filename().string())) return open_tiff(path);
  return open_zarr(path);
}

}  // namespace catena::chunks
