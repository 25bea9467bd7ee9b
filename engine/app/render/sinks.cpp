#include "engine/app/render/sinks.h"

#include <utility>

#include "engine/app/render/video_writer.h"
#include "render/vk/exr_writer.h"
#include "render/vk/png_writer.h"

namespace catena::app {
namespace {

/// RGBA, or its RGB.
template <class To, class From, class Convert>
std::vector<To> packed(const std::vector<From>& rgba, bool alpha, const Convert& convert) {
  const std::size_t channels = alpha ? 4 : 3, pixels = rgba.size() / 4;
  std::vector<To> values(channels * pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < channels; ++c) values[channels * i + c] = convert(rgba[4 * i + c]);
  return values;
}

/// Video has no transparent background, but .webm: black behind it, as picture viewers show it.
std::vector<std::uint8_t> over_black(const std::vector<std::uint8_t>& rgba) {
  std::vector<std::uint8_t> values(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < rgba.size() / 4; ++i)
    for (std::size_t c = 0; c < 3; ++c) values[3 * i + c] = std::uint8_t((rgba[4 * i + c] * rgba[4 * i + 3] + 127) / 255);
  return values;
}

/// A writer with a way to feed it.
template <class Writer, class Feed>
class WriterSink : public Sink {
 public:
  WriterSink(Writer writer, Feed feed) : writer_(std::move(writer)), feed_(std::move(feed)) {}
  Outcome take(const render::Band& band) override { return feed_(writer_, band); }
  Outcome finish() override { return writer_.finish(); }
  Outcome commit() override { return writer_.commit(); }

 private:
  Writer writer_;
  Feed feed_;
};

template <class Writer, class Feed>
std::unique_ptr<Sink> sink_of(Writer writer, Feed feed) {
  return std::make_unique<WriterSink<Writer, Feed>>(std::move(writer), std::move(feed));
}

}  // namespace

Result<std::unique_ptr<Sink>> open_picture(const std::string& path, const PictureShape& shape) {
  using render::Band;
  const bool alpha = shape.alpha;
  const auto as_it_is = [](std::uint8_t x) { return x; };
  if (video_kind(path)) {
    const bool held = alpha && holds_alpha(path);
    CATENA_TRY(VideoWriter video, VideoWriter::open(path, {shape.width, shape.height, shape.fps, held}));
    return sink_of(std::move(video), [=](VideoWriter& to, const Band& band) {
      if (held) return to.rows(band.bytes);
      return to.rows(alpha ? over_black(band.bytes) : packed<std::uint8_t>(band.bytes, false, as_it_is));
    });
  }
  if (path.ends_with(".exr")) {
    render::ExrFormat format{shape.width, shape.height, {"R", "G", "B"}, "linear light of sRGB display values"};
    if (alpha) {
      format.channels.push_back("A");
      format.comments += ", premultiplied by alpha";
    }
    CATENA_TRY(render::ExrWriter exr, render::ExrWriter::open(path, format));
    return sink_of(std::move(exr), [=](render::ExrWriter& to, const Band& band) {
      const std::size_t channels = alpha ? 4 : 3;
      std::vector<float> values(band.floats.size() / 4 * channels);
      for (std::size_t i = 0; i < band.floats.size() / 4; ++i) {
        const std::array<float, 4> c = render::premultiplied_linear(band.floats.data() + 4 * i);
        std::copy_n(c.begin(), channels, values.begin() + std::ptrdiff_t(channels * i));
      }
      return to.rows(values);
    });
  }
  CATENA_TRY(render::PngWriter png, render::PngWriter::open(path, {shape.width, shape.height, shape.bits, alpha ? 4 : 3}));
  if (shape.bits == 16)
    return sink_of(std::move(png), [=](render::PngWriter& to, const Band& band) {
      return to.rows(packed<std::uint16_t>(band.floats, alpha, [](float x) { return std::uint16_t(render::to_level(x, 65535)); }));
    });
  return sink_of(std::move(png),
                 [=](render::PngWriter& to, const Band& band) { return to.rows(packed<std::uint8_t>(band.bytes, alpha, as_it_is)); });
}

Result<std::unique_ptr<Sink>> open_depth(const std::string& path, const PictureShape& shape) {
  CATENA_TRY(
      render::ExrWriter exr,
      render::ExrWriter::open(
          path,
          {shape.width, shape.height, {"Z"}, "Z: distance along the view axis in world units, infinite where nothing opaque is seen"}));
  return sink_of(std::move(exr), [](render::ExrWriter& to, const render::Band& band) { return to.rows(band.depth); });
}

Result<std::unique_ptr<Sink>> open_ids(const std::string& path, const PictureShape& shape) {
  CATENA_TRY(render::PngWriter png, render::PngWriter::open(path, {shape.width, shape.height, 16, 1, "Objects", shape.legend}));
  return sink_of(std::move(png), [](render::PngWriter& to, const render::Band& band) {
    const std::vector<std::uint16_t> ids(band.ids.begin(), band.ids.end());
    return to.rows(ids);
  });
}

}  // namespace catena::app
