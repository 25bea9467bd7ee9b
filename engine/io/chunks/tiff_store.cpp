// SPDX-License-Identifier: MIT
// Stores in TIFF files: a chunk is a tile or a strip of one page.
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <list>

#include "engine/base/natural_sort.h"
#include "engine/base/text.h"
#include "engine/io/chunks/chunk_cache.h"
#include "engine/io/chunks/copy_part.h"
#include "engine/io/chunks/open_store.h"
#include "engine/io/chunks/pyramid.h"
#include "engine/io/chunks/tiff_file.h"
#include "engine/io/chunks/tiff_image.h"
#include "engine/io/chunks/zarr_array.h"

namespace catena::chunks {
namespace {

namespace fs = std::filesystem;
using field::Index3;
using field::StoreBox;
using field::StoreGrid;
using field::StoreRequest;

/// Returns the number type of a page. Returns an Error with a message fragment.
Result<StoredType> type_of(const TiffPage& page) {
  const char* const kind = page.format == 3 ? "f" : page.format == 2 ? "i" : "u";
  const bool has_bytes = page.bits == 8 || page.bits == 16 || page.bits == 32 || page.bits == 64;
  if (page.format < 1 || page.format > 3 || !has_bytes || (page.format == 3 && page.bits < 32))
    return Error{fmt::format("has {} of {} bits, expected integers of 8, 16, 32 or 64 bits or floats of 32 or 64",
                             page.format == 3  ? "floats"
                             : page.format < 3 ? "integers"
                                               : "complex numbers",
                             page.bits)};
  return parse_numpy_type(fmt::format("|{}{}", kind, page.bits / 8));
}

class TiffStore final : public OpenStore {
 public:
  explicit TiffStore(StorePath path) : path_(std::move(path)) {}
  Outcome open();
  Outcome read(const StoreRequest& request, std::span<std::byte> values) override;

 private:
  struct Opened {
    int number;
    std::unique_ptr<TiffFile> file;
  };
  /// A grid: a sample of the planes of an image.
  struct Channel {
    std::size_t image = 0;
    int plane = 0, sample = 0;
  };

  Error in_file(const std::string& name, const Error& error) const {
    return Error{is_folder_ || name != files_.front() ? fmt::format("{}: {} {}", path_.shown, in_quotes(name), error.message)
                                                      : fmt::format("{}: the file {}", path_.shown, error.message),
                 error.system_failure};
  }
  Result<TiffFile*> file(int number);
  Outcome open_folder();
  Outcome describe(std::size_t index);
  Outcome read_plane(const StoreRequest& request, const Channel& channel, int slice, std::span<std::byte> values);

  StorePath path_;
  bool is_folder_ = false;
  std::string folder_;
  std::vector<std::string> files_;
  std::list<Opened> opened_;  ///< The last used first.
  std::vector<TiffImage> images_;
  TiffPage first_;                 ///< All pages are like the first one.
  std::vector<TiffPage> coarser_;  ///< Levels of the first page.
  std::vector<Channel> channels_;
  StoredType type_;
  ChunkCache cache_;
};

/// Returns an open file; a few stay open.
Result<TiffFile*> TiffStore::file(int number) {
  constexpr std::size_t kMaxOpen = 16;
  const auto found = std::ranges::find(opened_, number, &Opened::number);
  if (found != opened_.end()) {
    opened_.splice(opened_.begin(), opened_, found);
    return opened_.front().file.get();
  }
  const std::string& name = files_[static_cast<std::size_t>(number)];
  struct stat about {};
  auto file = TiffFile::open(folder_ + "/" + name, about);
  if (!file) return in_file(name, file.error());
  opened_.push_front({number, std::move(*file)});
  if (opened_.size() > kMaxOpen) opened_.pop_back();
  return opened_.front().file.get();
}

/// Returns a note if numbers are missing in the names of files, which are in the order of their numbers; empty: none, or the names are of
/// another kind.
static std::string note_missing_numbers(const std::vector<std::string>& names) {
  constexpr std::size_t kMaxDigits = 15, kMinFiles = 4;
  std::vector<std::int64_t> numbers;
  std::string prefix;
  std::size_t digits = 1;  // of padded numbers
  for (const std::string& name : names) {
    const std::size_t last = name.find_last_of("0123456789", name.rfind('.'));
    if (last == std::string::npos) return {};
    const std::size_t before = name.find_last_not_of("0123456789", last);
    const std::size_t first = before == std::string::npos ? 0 : before + 1;
    if (last + 1 - first > kMaxDigits || (!numbers.empty() && name.substr(0, first) != prefix)) return {};
    prefix = name.substr(0, first);
    if (name[first] == '0') digits = last + 1 - first;
    numbers.push_back(std::stoll(name.substr(first, last + 1 - first)));
  }
  if (numbers.size() < kMinFiles) return {};
  std::int64_t step = numbers.back() - numbers.front();
  for (std::size_t i = 1; i < numbers.size(); ++i) step = std::min(step, numbers[i] - numbers[i - 1]);
  if (step < 1) return {};
  std::int64_t missing = 0, first = -1;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    const std::int64_t gap = numbers[i] - numbers[i - 1];
    if (gap % step != 0) return {};
    if (gap > step && first < 0) first = numbers[i - 1] + step;
    missing += gap / step - 1;
  }
  if (missing == 0 || missing >= static_cast<std::int64_t>(numbers.size())) return {};
  return fmt::format("files with {} numbers are missing, the first is {}{:0{}}: the slices behind them have moved", missing, prefix, first,
                     digits);
}

/// Finds the slices of a folder.
Outcome TiffStore::open_folder() {
  constexpr std::size_t kMaxFiles = 1'000'000;
  std::error_code code;
  for (fs::directory_iterator at(path_.real, code), end; !code && at != end; at.increment(code)) {
    std::string name = at->path().filename().string();
    if (!name.starts_with('.') && (has_extension(name, ".tif") || has_extension(name, ".tiff"))) files_.push_back(std::move(name));
    if (files_.size() > kMaxFiles) return Error{fmt::format("{}: the folder has more than {} files", path_.shown, kMaxFiles)};
  }
  if (code) return Error{fmt::format("{}: the folder cannot be listed ({})", path_.shown, code.message())};
  if (files_.empty()) return Error{path_.shown + ": there is no TIFF file in this folder"};
  natural_sort(files_);
  if (const std::string note = note_missing_numbers(files_); !note.empty()) description_.notes.push_back(note);
  TiffImage& image = images_.emplace_back();
  image.slices = static_cast<int>(files_.size());
  for (int i = 0; i < image.slices; ++i) image.pages.push_back({i, 0});
  return Done{};
}

Outcome TiffStore::open() {
  const fs::path real(path_.real);
  std::error_code code;
  is_folder_ = fs::is_directory(real, code);
  folder_ = is_folder_ ? path_.real : real.parent_path().string();
  if (is_folder_) {
    CATENA_CHECK(open_folder());
  } else {
    files_.push_back(real.filename().string());
  }
  struct stat about {};
  auto opened = TiffFile::open(folder_ + "/" + files_.front(), about);
  if (!opened) return in_file(files_.front(), opened.error());
  record_file(about);
  TiffFile& first = **opened;
  first_ = first.pages().front();
  auto type = type_of(first_);
  if (!type) return in_file(files_.front(), type.error());
  type_ = *type;
  if (first_.width < 1 || first_.height < 1) return in_file(files_.front(), Error{"has no pixels"});
  if (first_.depth > 1) return in_file(files_.front(), Error{"has tiles of several slices, expected one slice in each page"});
  if (is_folder_) {
    images_.front().samples = first_.samples;
    if (first.pages().size() > 1)
      description_.notes.push_back(fmt::format("of each file its first page is read, of {} in the first file", first.pages().size()));
  } else {
    TiffHead head{files_.front(), first.pages(), {}, {0, 0}};
    head.description = first.description(head.pixels_per_unit);
    auto images = find_tiff_images(head, files_, description_.notes);
    if (!images) return in_file(head.file_name, images.error());
    images_ = std::move(*images);
    for (const std::uint64_t offset : first_.coarser)
      if (const auto page = first.read_page(offset); page && page->bits == first_.bits && page->samples == first_.samples)
        coarser_.push_back(*page);
  }
  const auto tiling = first.select(first_.offset, first_);
  if (!tiling) return in_file(files_.front(), tiling.error());
  opened_.push_front({0, std::move(*opened)});
  for (std::size_t image = 0; image < images_.size(); ++image) CATENA_CHECK(describe(image));
  if (description_.grids.empty()) return Error{path_.shown + ": the file has no image"};
  return Done{};
}

Outcome TiffStore::describe(std::size_t index) {
  TiffImage& image = images_[index];
  const TiffPage* page = &first_;
  TiffPage own;
  if (index > 0) {
    // further images of the file may have another size; one type is read
    const TiffPlane& plane = image.pages.front();
    if (plane.file < 0) return Done{};
    CATENA_TRY(TiffFile * file, this->file(plane.file));
    if (static_cast<std::size_t>(plane.page) >= file->pages().size()) return Done{};
    own = file->pages()[static_cast<std::size_t>(plane.page)];
    if (!own.is_like(first_)) {
      description_.notes.push_back(
          fmt::format("the image {} has another size or type than the first one, and is left out", in_quotes(image.name)));
      return Done{};
    }
    page = &own;
  }
  if (image.samples != page->samples) {
    if (page->samples > 1 && image.samples > 1)
      return in_file(files_.front(),
                     Error{fmt::format("has {} samples per pixel, but its OME-XML states {}", page->samples, image.samples)});
    image.samples = page->samples;
  }
  CATENA_TRY(TiffFile * file, this->file(0));
  const int count = image.planes * image.samples;
  constexpr int kMaxGrids = 4096;
  if (count > kMaxGrids) return Error{fmt::format("{}: the file has {} channels, expected at most {}", path_.shown, count, kMaxGrids)};
  for (int c = 0; c < count; ++c) {
    StoreGrid grid;
    const auto at = static_cast<std::size_t>(c);
    std::string name = at < image.channels.size() ? image.channels[at] : "";
    constexpr const char* kColors[] = {"red", "green", "blue", "alpha"};
    if (name.empty() && count > 1) name = image.planes == 1 && count <= 4 && count >= 3 ? kColors[c] : fmt::format("channel {}", c);
    if (images_.size() > 1) name = (image.name.empty() ? fmt::format("image {}", index) : image.name) + (name.empty() ? "" : "/" + name);
    if (name.empty()) name = !image.name.empty() && image.name.size() < 200 ? image.name : "data";
    grid.name = unique_name(description_, one_line(name));
    grid.type = type_.name;
    grid.length_unit = image.length_unit;
    grid.steps = image.steps;
    if (at < image.colors.size()) grid.color = image.colors[at];
    Vec3 spacing = image.spacing;
    if (spacing.x > 0 && !(spacing.y > 0)) spacing.y = spacing.x;
    if (spacing.x > 0 && !(spacing.z > 0)) spacing.z = spacing.x;
    std::vector<const TiffPage*> levels{page};
    if (index == 0)
      for (const TiffPage& level : coarser_) levels.push_back(&level);
    for (const TiffPage* level : levels) {
      const auto tiling = file->select(level->offset, *level);
      if (!tiling) return in_file(files_.front(), tiling.error());
      const Index3 size{static_cast<int>(level->width), static_cast<int>(level->height), image.slices};
      constexpr int kMaxAxis = static_cast<int>(field::kMaxStoreAxis);
      grid.levels.push_back(make_level(grid, size, {std::min(tiling->width, kMaxAxis), std::min(tiling->height, kMaxAxis), 1},
                                       level == page ? spacing : Vec3(0.0), Vec3(0.0)));
    }
    if (const std::string note = remove_misplaced_levels(grid); !note.empty() && c == 0) description_.notes.push_back(note);
    description_.grids.push_back(std::move(grid));
    channels_.push_back({index, c / image.samples, c % image.samples});
  }
  if (image.steps > 1 && description_.times.empty()) {
    for (int t = 0; t < image.steps; ++t) description_.times.push_back(t * image.time_step);
    description_.time_unit = image.time_unit;
  }
  return Done{};
}

Outcome TiffStore::read_plane(const StoreRequest& request, const Channel& channel, int slice, std::span<std::byte> values) {
  const TiffImage& image = images_[channel.image];
  const TiffPlane& plane = image.pages[image.place(std::min(request.step, image.steps - 1), channel.plane, slice)];
  if (plane.file < 0) {
    std::ranges::fill(values, std::byte{0});
    return Done{};
  }
  CATENA_TRY(TiffFile * file, this->file(plane.file));
  const std::string& name = files_[static_cast<std::size_t>(plane.file)];
  if (plane.page < 0 || static_cast<std::size_t>(plane.page) >= file->pages().size())
    return in_file(name, Error{fmt::format("has {} pages, but page {} is named as a slice", file->pages().size(), plane.page)});
  const TiffPage* page = &file->pages()[static_cast<std::size_t>(plane.page)];
  std::uint64_t offset = page->offset;
  const TiffPage* expected = &first_;
  if (request.level > 0) {
    const auto level = static_cast<std::size_t>(request.level - 1);
    if (level >= page->coarser.size()) return in_file(name, Error{fmt::format("has no level {} of page {}", request.level, plane.page)});
    offset = page->coarser[level];
    expected = &coarser_[level];
  }
  const auto tiling = file->select(offset, *expected);
  if (!tiling) return in_file(name, tiling.error());
  const StoreBox& box = request.box;
  const StoreBox layer{{box.lo.x, box.lo.y, slice}, {box.size.x, box.size.y, 1}};
  const int samples = expected->is_separate ? 1 : expected->samples;
  for (int y = box.lo.y / tiling->height * tiling->height; y < box.lo.y + box.size.y; y += tiling->height)
    for (int x = box.lo.x / tiling->width * tiling->width; x < box.lo.x + box.size.x; x += tiling->width) {
      const int separate = expected->is_separate ? channel.sample : 0;
      const std::string key = fmt::format("{}/{}/{}/{}/{}", plane.file, offset, x, y, separate);
      ChunkBytes bytes = cache_.find(key);
      if (bytes == nullptr) {
        auto decoded = file->decode(x, y, separate);
        if (!decoded) return in_file(name, decoded.error());
        bytes = cache_.add(key, std::move(*decoded));
      }
      const auto number = static_cast<std::ptrdiff_t>(type_.bytes);
      ChunkView view{bytes->data() + (expected->is_separate ? 0 : channel.sample) * number,
                     {number * samples, number * samples * tiling->width, 0},
                     {{x, y, slice}, {tiling->width, tiling->height, 1}}};
      copy_part(view, layer, type_.bytes, values);
    }
  return Done{};
}

Outcome TiffStore::read(const StoreRequest& request, std::span<std::byte> values) {
  const Channel& channel = channels_[static_cast<std::size_t>(request.grid)];
  const std::size_t layer = values.size() / static_cast<std::size_t>(request.box.size.z);
  for (int z = 0; z < request.box.size.z; ++z)
    CATENA_CHECK(read_plane(request, channel, request.box.lo.z + z, values.subspan(static_cast<std::size_t>(z) * layer, layer)));
  return Done{};
}

}  // namespace

Result<std::unique_ptr<OpenStore>> open_tiff(const StorePath& path) {
  auto store = std::make_unique<TiffStore>(path);
  CATENA_CHECK(store->open());
  return std::unique_ptr<OpenStore>(std::move(store));
}

}  // namespace catena::chunks
