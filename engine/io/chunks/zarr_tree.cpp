// SPDX-License-Identifier: MIT
#include "engine/io/chunks/zarr_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "engine/base/natural_sort.h"
#include "engine/base/text.h"

namespace catena::chunks {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxDepth = 4;
constexpr std::size_t kMaxImages = 256, kMaxMetadataBytes = 16 << 20, kMaxChildren = 10'000;

class Tree {
 public:
  Tree(const StorePath& path, const std::function<void(const struct stat&)>& record) : path_(path), record_(record) {}

  Result<std::vector<ZarrImage>> find(std::vector<std::string>& notes) {
    CATENA_CHECK(visit("", 0));
    if (images_.empty() && !left_out_.empty()) return left_out_.front();
    for (const Error& error : left_out_) notes.push_back("left out: " + error.message);
    if (images_.empty())
      return Error{path_.shown + ": there is no array in this Zarr store, expected .zarray or .zgroup files of version 2"};
    return std::move(images_);
  }

 private:
  std::string real(const std::string& name) const { return name.empty() ? path_.real : path_.real + "/" + name; }
  std::string shown(const std::string& name) const { return name.empty() ? path_.shown : path_.shown + "/" + name; }
  static std::string join(const std::string& folder, const std::string& name) { return folder.empty() ? name : folder + "/" + name; }
  bool exists(const std::string& name) const {
    struct stat about {};
    return ::stat(real(name).c_str(), &about) == 0;
  }

  /// Reads a metadata file; nullopt: there is none.
  Result<std::optional<std::string>> read(const std::string& name) const {
    auto bytes = read_chunk_file(real(name).c_str(), kMaxMetadataBytes);
    if (!bytes) return Error{shown(name) + ": " + bytes.error().message, bytes.error().system_failure};
    if (!*bytes) return std::optional<std::string>();
    struct stat about {};
    if (::stat(real(name).c_str(), &about) == 0) record_(about);
    return std::optional(std::string(reinterpret_cast<const char*>((*bytes)->data()), (*bytes)->size()));
  }

  /// Adds what a folder contains.
  Outcome visit(const std::string& folder, int depth) {
    if (exists(join(folder, "zarr.json")))
      return Error{shown(folder) +
                   ": this is a Zarr store of version 3 (zarr.json), expected version 2; zarr.save or \"ome_zarr\" with "
                   "zarr_format=2 writes it"};
    CATENA_TRY(const auto array, read(join(folder, ".zarray")));
    if (array) return add_array(folder, *array);
    CATENA_TRY(const auto attributes, read(join(folder, ".zattrs")));
    OmeMetadata meta;
    if (attributes) {
      CATENA_TRY(meta, parse_ome(*attributes, shown(join(folder, ".zattrs"))));
    }
    if (meta.is_plate)
      return Error{shown(folder) + ": this is a plate of wells, expected one image, such as " + shown(join(folder, "A/1/0"))};
    if (meta.is_image) return add_image(folder, std::move(meta), false);
    return visit_children(folder, depth);
  }

  Outcome visit_children(const std::string& folder, int depth) {
    if (depth >= kMaxDepth) return Done{};
    std::vector<std::string> names;
    std::error_code code;
    for (fs::directory_iterator at(real(folder), code), end; !code && at != end && names.size() < kMaxChildren; at.increment(code)) {
      std::error_code ignored;
      const std::string name = at->path().filename().string();
      if (!name.starts_with('.') && at->is_directory(ignored)) names.push_back(name);
    }
    natural_sort(names);
    for (const std::string& name : names) {
      const std::string child = join(folder, name);
      if (images_.size() >= kMaxImages) return Done{};
      if (exists(join(child, ".zarray")) || exists(join(child, ".zgroup")) || exists(join(child, "zarr.json")))
        if (const Outcome visited = visit(child, depth + 1); !visited) {
          if (visited.error().system_failure) return visited;
          left_out_.push_back(visited.error());
        }
    }
    return Done{};
  }

  Result<ZarrArray> read_array(const std::string& folder) const {
    if (exists(join(folder, "zarr.json"))) return Error{shown(folder) + ": this is an array of Zarr version 3, expected version 2"};
    CATENA_TRY(const auto text, read(join(folder, ".zarray")));
    if (!text) return Error{shown(folder) + ": there is no array (.zarray), expected the one that the metadata of the store name"};
    CATENA_TRY(ZarrArray array, parse_zarr_array(*text, shown(join(folder, ".zarray"))));
    array.folder = folder;
    return array;
  }

  /// Adds an array without OME metadata.
  Outcome add_array(const std::string& folder, const std::string& text) {
    ZarrImage image;
    image.name = folder;
    CATENA_TRY(ZarrArray array, parse_zarr_array(text, shown(join(folder, ".zarray"))));
    array.folder = folder;
    const std::size_t axes = array.shape.size();
    constexpr std::size_t kMaxPlainAxes = 5;
    if (axes < 2 || axes > kMaxPlainAxes)
      return images_.empty() && folder.empty()
                 ? Outcome(Error{fmt::format("{}: the array has {} axes, expected 2 to {}: z, y, x, and c and t in front of them",
                                             path_.shown, axes, kMaxPlainAxes)})
                 : Outcome(Done{});
    const std::string_view order = std::string_view("tczyx").substr(kMaxPlainAxes - axes);
    for (const char name : order) image.meta.axes.push_back({name, ""});
    if (const auto attributes = read(join(folder, ".zattrs")); attributes && *attributes) use_dimension_names(**attributes, image);
    image.meta.datasets.push_back({folder, {}, {}});
    image.levels.push_back(std::move(array));
    return add(std::move(image));
  }

  /// Uses the names that xarray gives the axes, if all of them are known.
  static void use_dimension_names(const std::string& text, ZarrImage& image) {
    const auto meta = parse_ome(text, "");
    if (!meta || meta->dimensions.size() != image.meta.axes.size()) return;
    std::vector<OmeAxis> axes;
    std::string seen;
    for (const std::string& name : meta->dimensions) {
      const char axis = name == "time" ? 't' : name == "channel" || name == "band" ? 'c' : name.size() == 1 ? name[0] : '?';
      if (std::string_view("tczyx").find(axis) == std::string_view::npos || seen.find(axis) != std::string::npos) return;
      seen += axis;
      axes.push_back({axis, ""});
    }
    if (seen.find('y') != std::string::npos && seen.find('x') != std::string::npos) image.meta.axes = std::move(axes);
  }

  /// Adds an image with OME metadata, and its label images.
  Outcome add_image(const std::string& folder, OmeMetadata meta, bool is_label) {
    ZarrImage image;
    image.name = folder;
    image.is_label = is_label || meta.is_label;
    if (meta.axes.empty())
      for (const char name : {'t', 'c', 'z', 'y', 'x'}) meta.axes.push_back({name, ""});
    image.meta = std::move(meta);
    for (const OmeDataset& dataset : image.meta.datasets) {
      CATENA_TRY(ZarrArray array, read_array(join(folder, dataset.path)));
      if (array.shape.size() != image.meta.axes.size())
        return Error{fmt::format("{}: the array {} has {} axes, expected the {} of \"multiscales\"", shown(folder), in_quotes(dataset.path),
                                 array.shape.size(), image.meta.axes.size())};
      if (!image.levels.empty() && array.type.name != image.levels.front().type.name)
        return Error{fmt::format("{}: the levels {} and {} have different types, {} and {}; expected one type", shown(folder),
                                 in_quotes(image.meta.datasets.front().path), in_quotes(dataset.path), image.levels.front().type.name,
                                 array.type.name)};
      image.levels.push_back(std::move(array));
    }
    CATENA_CHECK(add(std::move(image)));
    if (is_label) return Done{};
    const std::string labels = join(folder, "labels");
    CATENA_TRY(const auto text, read(join(labels, ".zattrs")));
    if (!text) return Done{};
    CATENA_TRY(const OmeMetadata list, parse_ome(*text, shown(join(labels, ".zattrs"))));
    for (const std::string& name : list.labels) {
      const std::string child = join(labels, name);
      CATENA_TRY(const auto attributes, read(join(child, ".zattrs")));
      if (!attributes) continue;
      CATENA_TRY(OmeMetadata own, parse_ome(*attributes, shown(join(child, ".zattrs"))));
      if (own.is_image && images_.size() < kMaxImages) CATENA_CHECK(add_image(child, std::move(own), true));
    }
    return Done{};
  }

  /// Adds an image whose arrays have been read; checks that they have the same channels and times.
  Outcome add(ZarrImage image) {
    constexpr std::string_view kNames = "xyzct";  // as in ZarrAxis
    for (std::size_t i = 0; i < image.meta.axes.size(); ++i) image.axis[kNames.find(image.meta.axes[i].name)] = static_cast<int>(i);
    for (std::size_t level = 1; level < image.levels.size(); ++level)
      for (const ZarrAxis axis : {kAxisX, kAxisY, kAxisZ, kAxisC, kAxisT}) {
        const std::int64_t fine = image.size(level - 1, axis), coarse = image.size(level, axis);
        if (axis == kAxisC || axis == kAxisT ? fine != coarse : coarse > fine)
          return Error{fmt::format("{}: the levels {} and {} disagree: {} and {} along {}", shown(image.name), level - 1, level, fine,
                                   coarse, kNames[axis])};
      }
    images_.push_back(std::move(image));
    return Done{};
  }

  const StorePath& path_;
  const std::function<void(const struct stat&)>& record_;
  std::vector<ZarrImage> images_;
  std::vector<Error> left_out_;  ///< Of arrays and groups that are not supported, beside others that are.
};

}  // namespace

Result<std::vector<ZarrImage>> find_zarr_images(const StorePath& path, const std::function<void(const struct stat&)>& record,
                                                std::vector<std::string>& notes) {
  return Tree(path, record).find(notes);
}

}  // namespace catena::chunks
