// SPDX-License-Identifier: MIT
#include "engine/io/chunks/tiff_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/base/text.h"
#include "engine/io/chunks/ome_metadata.h"
#include "engine/io/chunks/xml_tree.h"

namespace catena::chunks {
namespace {

constexpr double kMaxPlanes = 1e6;

/// Returns the pages that are slices: those like the first one, without previews.
std::vector<int> main_pages(const TiffHead& head, std::vector<std::string>& notes) {
  std::vector<int> found;
  for (std::size_t i = 0; i < head.pages.size(); ++i)
    if (i == 0 || (!head.pages[i].is_reduced && head.pages[i].is_like(head.pages.front()))) found.push_back(static_cast<int>(i));
  if (found.size() < head.pages.size())
    notes.push_back(fmt::format("{} of {} pages have another size or type than the first one, and are left out",
                                head.pages.size() - found.size(), head.pages.size()));
  return found;
}

/// Returns whether a name is that of a file in the same folder.
bool is_plain_name(const std::string& name) {
  return !name.empty() && name.find('/') == std::string::npos && name != ".." && name.size() < 256;
}

/// Reads one image of OME-XML.
class OmeImage {
 public:
  OmeImage(const XmlNode& image, const TiffHead& head, std::vector<std::string>& files) : xml_(image), head_(head), files_(files) {}

  Result<TiffImage> read() {
    const XmlNode* pixels = xml_.find("Pixels");
    if (pixels == nullptr) return Error{"its OME-XML has an image without pixels"};
    const int z = pixels->count("SizeZ"), c = pixels->count("SizeC"), t = pixels->count("SizeT");
    if (z < 1 || c < 1 || t < 1 || static_cast<double>(z) * c * t > kMaxPlanes)
      return Error{
          fmt::format("its OME-XML has the sizes {} z, {} c, {} t, expected at least 1 and at most {:.0f} planes", z, c, t, kMaxPlanes)};
    order_ = pixels->attribute("DimensionOrder");
    std::string sorted = order_;
    std::ranges::sort(sorted);
    if (sorted != "CTXYZ" || !order_.starts_with("XY"))
      return Error{fmt::format("its OME-XML has the order of dimensions {}, expected XYZCT or another order of these", in_quotes(order_))};
    image_.name = xml_.attribute("Name");
    image_.slices = z;
    image_.steps = t;
    read_channels(*pixels, c);
    const char* const keys[3] = {"PhysicalSizeX", "PhysicalSizeY", "PhysicalSizeZ"};
    LengthUnit first;
    for (int a = 0; a < 3; ++a) {
      const double size = pixels->number(keys[a], 0);
      const std::string name = pixels->attribute(std::string(keys[a]) + "Unit");
      const LengthUnit unit = find_length_unit(name.empty() ? "µm" : name);
      if (!(size > 0)) continue;
      if (first.name.empty()) first = unit;
      image_.spacing[a] = size * (unit.meters > 0 && first.meters > 0 ? unit.meters / first.meters : 1);
    }
    image_.length_unit = first.name;
    image_.time_step = pixels->number("TimeIncrement", 1);
    image_.time_unit = pixels->attribute("TimeIncrementUnit");
    if (image_.time_unit.empty() && !pixels->attribute("TimeIncrement").empty()) image_.time_unit = "s";
    image_.pages.resize(static_cast<std::size_t>(z) * static_cast<std::size_t>(image_.planes) * static_cast<std::size_t>(t));
    CATENA_CHECK(place_planes(*pixels));
    return image_;
  }

 private:
  void read_channels(const XmlNode& pixels, int count) {
    const auto channels = pixels.all("Channel");
    const int samples = channels.empty() ? 1 : std::max(1, channels.front()->count("SamplesPerPixel"));
    image_.samples = count % samples == 0 ? samples : 1;
    image_.planes = count / image_.samples;
    for (const XmlNode* channel : channels)
      for (int i = 0; i < image_.samples; ++i) {
        const std::string name = channel->attribute("Name");
        image_.channels.push_back(image_.samples == 1 || name.empty() ? name : fmt::format("{} {}", name, i));
        const double color = channel->number("Color", -1);
        // a signed 32-bit RGBA number; -1 is white
        constexpr double kLimit = 2147483648.0;
        const bool has_color = !channel->attribute("Color").empty() && std::fabs(color) <= kLimit;
        image_.colors.push_back(has_color ? static_cast<int>((static_cast<std::uint32_t>(static_cast<std::int64_t>(color)) >> 8) & 0xffffff)
                                          : -1);
      }
  }

  Outcome place_planes(const XmlNode& pixels) {
    const auto all = pixels.all("TiffData");
    const int total = static_cast<int>(image_.pages.size());
    if (all.empty()) return place(0, 0, 0, 0, 0, total);
    for (const XmlNode* data : all) {
      int file = 0;
      if (const XmlNode* uuid = data->find("UUID"); uuid != nullptr && !uuid->attribute("FileName").empty()) {
        CATENA_TRY(file, file_of(uuid->attribute("FileName")));
      }
      const bool has_page = !data->attribute("IFD").empty();
      int count = data->count("PlaneCount");
      if (count < 0) count = has_page ? 1 : total;
      CATENA_CHECK(place(file, std::max(0, data->count("IFD")), std::max(0, data->count("FirstZ")), std::max(0, data->count("FirstC")),
                         std::max(0, data->count("FirstT")), count));
    }
    return Done{};
  }

  /// Places `count` pages of a file, in the order of dimensions, from a plane on.
  Outcome place(int file, int page, int z, int c, int t, int count) {
    int at[3];
    const auto axis = [](char name) { return name == 'Z' ? 0 : name == 'C' ? 1 : 2; };
    at[0] = z, at[1] = c / image_.samples, at[2] = t;
    const int sizes[3] = {image_.slices, image_.planes, image_.steps};
    for (int i = 0; i < count; ++i) {
      for (int a = 0; a < 3; ++a)
        if (at[a] >= sizes[a]) return Error{"its OME-XML names planes outside of the image"};
      image_.pages[image_.place(at[2], at[1], at[0])] = {file, page + i};
      if (i + 1 == count) break;
      for (int d = 2; d < 5; ++d) {
        const int a = axis(order_[static_cast<std::size_t>(d)]);
        if (++at[a] < sizes[a]) break;
        if (d < 4) at[a] = 0;
      }
    }
    return Done{};
  }

  Result<int> file_of(const std::string& name) {
    constexpr std::size_t kMaxFiles = 100'000;
    if (name == head_.file_name) return 0;
    if (!is_plain_name(name)) return Error{fmt::format("its OME-XML names the file {}, expected one in the same folder", in_quotes(name))};
    if (numbers_.empty())
      for (std::size_t i = 0; i < files_.size(); ++i) numbers_[files_[i]] = static_cast<int>(i);
    const auto [found, is_new] = numbers_.try_emplace(name, static_cast<int>(files_.size()));
    if (is_new) files_.push_back(name);
    if (files_.size() > kMaxFiles) return Error{fmt::format("its OME-XML names more than {} files", kMaxFiles)};
    return found->second;
  }

  const XmlNode& xml_;
  const TiffHead& head_;
  std::vector<std::string>& files_;
  std::map<std::string, int> numbers_;
  std::string order_;
  TiffImage image_;
};

/// Returns the number after "KEY=" in ImageJ's description; `otherwise`: there is none.
double number_after(const std::string& text, const std::string& key, double otherwise) {
  const std::size_t at = text.find("\n" + key + "=");
  if (at == std::string::npos) return otherwise;
  const std::size_t begin = at + key.size() + 2, end = text.find('\n', begin);
  const std::vector<double> numbers = numbers_in(text.substr(begin, end - begin));
  return numbers.size() == 1 ? numbers.front() : otherwise;
}

void describe_imagej(const TiffHead& head, const std::vector<int>& pages, TiffImage& image) {
  const std::string& text = head.description;
  const double channels = number_after(text, "channels", 1), slices = number_after(text, "slices", 1),
               frames = number_after(text, "frames", 1);
  const bool is_whole = channels >= 1 && slices >= 1 && frames >= 1 && channels * slices * frames == static_cast<double>(pages.size());
  if (is_whole) {
    image.planes = static_cast<int>(channels);
    image.slices = static_cast<int>(slices);
    image.steps = static_cast<int>(frames);
  }
  for (int i = 0; i < static_cast<int>(pages.size()); ++i) {
    const int c = i % image.planes, z = i / image.planes % image.slices, t = i / image.planes / image.slices;
    image.pages[image.place(t, c, z)] = {0, pages[static_cast<std::size_t>(i)]};
  }
  const std::size_t at = text.find("\nunit=");
  std::string unit = at == std::string::npos ? "" : text.substr(at + 6, text.find('\n', at + 1) - at - 6);
  if (unit == "\\u00B5m") unit = "µm";
  image.length_unit = unit == "pixel" ? "" : find_length_unit(unit).name;
  for (int a = 0; a < 2; ++a)
    if (head.pixels_per_unit[a] > 0 && !image.length_unit.empty()) image.spacing[a] = 1 / head.pixels_per_unit[a];
  image.spacing.z = std::fabs(number_after(text, "spacing", 0));
  const double interval = number_after(text, "finterval", 0);
  image.time_step = interval > 0 ? interval : 1;
  if (interval > 0) image.time_unit = "s";
}

}  // namespace

Result<std::vector<TiffImage>> find_tiff_images(const TiffHead& head, std::vector<std::string>& files, std::vector<std::string>& notes) {
  files.assign(1, head.file_name);
  const std::string& text = head.description;
  if (text.find("<OME") != std::string::npos) {
    CATENA_TRY(const XmlNode root, parse_xml(text));
    std::vector<TiffImage> images;
    for (const XmlNode* image : root.all("Image")) {
      CATENA_TRY(TiffImage read, OmeImage(*image, head, files).read());
      images.push_back(std::move(read));
    }
    if (!images.empty()) return images;
    notes.push_back("the OME-XML has no image: every page is a slice");
  }
  TiffImage image;
  const std::vector<int> pages = main_pages(head, notes);
  image.samples = head.pages.front().samples;
  image.slices = static_cast<int>(pages.size());
  image.pages.resize(pages.size());
  if (text.starts_with("ImageJ=")) {
    const double stated = number_after(text, "images", 1);
    if (stated > static_cast<double>(pages.size()))
      return Error{
          fmt::format("has {} pages, but ImageJ states {:.0f} images in them; Fiji saves them as pages (File > Save As > OME-TIFF)",
                      pages.size(), stated)};
    describe_imagej(head, pages, image);
  } else {
    for (std::size_t i = 0; i < pages.size(); ++i) image.pages[i] = {0, pages[i]};
  }
  return std::vector<TiffImage>{image};
}

}  // namespace catena::chunks
