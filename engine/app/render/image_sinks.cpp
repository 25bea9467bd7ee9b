// SPDX-License-Identifier: MIT
#include "engine/app/render/image_sinks.h"

#include <algorithm>
#include <span>
#include <utility>

#include "engine/app/render/video_writer.h"
#include "render/image/exr_writer.h"
#include "render/image/png_writer.h"

namespace catena::app {
namespace {

constexpr std::size_t kRowsAtOnce = 16;  // rows converted at a time, since converted rows are held in addition to the originals

/// A block of rows of a band.
struct Rows {
  std::span<const std::uint8_t> bytes;
  std::span<const float> floats, depth;
  std::span<const std::uint32_t> ids;
};

template <class T>
std::span<const T> part(const std::vector<T>& values, const render::Band& band, std::size_t first, std::size_t count) {
  const std::size_t row = values.size() / band.height;
  return std::span<const T>(values).subspan(first * row, count * row);
}

/// Converts pixels with RGBA or RGB components.
template <class To, class From, class Convert>
std::vector<To> convert_components(std::span<const From> rgba, bool alpha, const Convert& convert) {
  const std::size_t channels = alpha ? 4 : 3, pixels = rgba.size() / 4;
  std::vector<To> values(channels * pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < channels; ++c) values[channels * i + c] = convert(rgba[4 * i + c]);
  return values;
}

/// Composites over black, as image viewers do: video formats other than .webm have no transparency.
std::vector<std::uint8_t> over_black(std::span<const std::uint8_t> rgba) {
  std::vector<std::uint8_t> values(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < rgba.size() / 4; ++i)
    for (std::size_t c = 0; c < 3; ++c) values[3 * i + c] = std::uint8_t((rgba[4 * i + c] * rgba[4 * i + 3] + 127) / 255);
  return values;
}

std::vector<float> linear(std::span<const float> rgba, bool alpha) {
  const std::size_t channels = alpha ? 4 : 3, pixels = rgba.size() / 4;
  std::vector<float> values(channels * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::array<float, 4> c = render::premultiplied_linear(rgba.data() + 4 * i);
    std::copy_n(c.begin(), channels, values.begin() + std::ptrdiff_t(channels * i));
  }
  return values;
}

/// A writer, together with the function that feeds it.
template <class Writer, class Feed>
class WriterSink : public ImageSink {
 public:
  WriterSink(Writer writer, Feed feed) : writer_(std::move(writer)), feed_(std::move(feed)) {}
  Outcome write(const render::Band& band) override {
    for (std::size_t y = 0; y < band.height; y += kRowsAtOnce) {
      const std::size_t count = std::min<std::size_t>(kRowsAtOnce, band.height - y);
      CATENA_CHECK(feed_(writer_, Rows{part(band.bytes, band, y, count), part(band.floats, band, y, count),
                                       part(band.depth, band, y, count), part(band.ids, band, y, count)}));
    }
    return Done{};
  }
  Outcome finish() override { return writer_.finish(); }
  Outcome commit() override { return writer_.commit(); }

 private:
  Writer writer_;
  Feed feed_;
};

template <class Writer, class Feed>
std::unique_ptr<ImageSink> sink_of(Writer writer, Feed feed) {
  return std::make_unique<WriterSink<Writer, Feed>>(std::move(writer), std::move(feed));
}

}  // namespace

Result<std::unique_ptr<ImageSink>> open_image_sink(const std::string& path, const ImageFormat& shape) {
  const bool alpha = shape.alpha;
  const auto as_it_is = [](std::uint8_t x) { return x; };
  if (video_kind(path)) {
    const bool held = alpha && supports_alpha(path);
    CATENA_TRY(VideoWriter video, VideoWriter::open(path, {shape.width, shape.height, shape.fps, held}));
    return sink_of(std::move(video), [=](VideoWriter& to, const Rows& rows) {
      if (held) return to.write_rows(rows.bytes);
      return to.write_rows(alpha ? over_black(rows.bytes) : convert_components<std::uint8_t>(rows.bytes, false, as_it_is));
    });
  }
  if (path.ends_with(".exr")) {
    render::ExrFormat format{shape.width, shape.height, {"R", "G", "B"}, "linear light of sRGB display values"};
    if (alpha) {
      format.channels.push_back("A");
      format.comments += ", premultiplied by alpha";
    }
    CATENA_TRY(render::ExrWriter exr, render::ExrWriter::open(path, format));
    return sink_of(std::move(exr), [=](render::ExrWriter& to, const Rows& rows) { return to.write_rows(linear(rows.floats, alpha)); });
  }
  CATENA_TRY(render::PngWriter png, render::PngWriter::open(path, {shape.width, shape.height, shape.bits, alpha ? 4 : 3}));
  if (shape.bits == 16)
    return sink_of(std::move(png), [=](render::PngWriter& to, const Rows& rows) {
      return to.write_rows(
          convert_components<std::uint16_t>(rows.floats, alpha, [](float x) { return std::uint16_t(render::quantize(x, 65535)); }));
    });
  return sink_of(std::move(png), [=](render::PngWriter& to, const Rows& rows) {
    return to.write_rows(convert_components<std::uint8_t>(rows.bytes, alpha, as_it_is));
  });
}

Result<std::unique_ptr<ImageSink>> open_depth_sink(const std::string& path, const ImageFormat& shape) {
  CATENA_TRY(
      render::ExrWriter exr,
      render::ExrWriter::open(path, {shape.width,
                                     shape.height,
                                     {"Z"},
                                     "Z: distance along the view axis in world units, infinite where no opaque surface is visible"}));
  return sink_of(std::move(exr), [](render::ExrWriter& to, const Rows& rows) { return to.write_rows(rows.depth); });
}

Result<std::unique_ptr<ImageSink>> open_id_sink(const std::string& path, const ImageFormat& shape) {
  CATENA_TRY(render::PngWriter png, render::PngWriter::open(path, {shape.width, shape.height, 16, 1, "Objects", shape.object_legend}));
  return sink_of(std::move(png), [](render::PngWriter& to, const Rows& rows) {
    const std::vector<std::uint16_t> ids(rows.ids.begin(), rows.ids.end());
    return to.write_rows(ids);
  });
}

}  // namespace catena::app
