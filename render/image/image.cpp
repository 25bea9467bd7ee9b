// SPDX-License-Identifier: MIT
#include "render/image/image.h"

#include <fmt/format.h>
#include <png.h>

#include "engine/base/result.h"
#include "render/image/png_writer.h"

namespace catena::render {
namespace {

Error file_error(const std::string& path, const std::string& what) { return Error{fmt::format("{}: {}", path, what)}; }

}  // namespace

Outcome write_png(const std::string& path, const Image8& image, bool alpha) {
  CATENA_ASSERT(image.width > 0 && image.height > 0 && image.rgba.size() == std::size_t(4) * image.width * image.height);

  // tightly packed rows
  const std::size_t channels = alpha ? 4 : 3;
  std::vector<std::uint8_t> pixels(channels * image.width * image.height);
  for (std::size_t i = 0; i < std::size_t(image.width) * image.height; ++i)
    for (std::size_t c = 0; c < channels; ++c) pixels[channels * i + c] = image.rgba[4 * i + c];
  CATENA_TRY(PngWriter png, PngWriter::open(path, {image.width, image.height, 8, int(channels)}));
  CATENA_CHECK(png.write_rows(pixels));
  CATENA_CHECK(png.finish());
  return png.commit();
}

Result<Image8> read_png(const std::string& path) {
  png_image png_data{};
  png_data.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&png_data, path.c_str()))
    return file_error(path, fmt::format("is not a readable PNG: {}", png_data.message));
  png_data.format = PNG_FORMAT_RGBA;
  Image8 image{png_data.width, png_data.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(png_data))};
  if (!png_image_finish_read(&png_data, nullptr, image.rgba.data(), 0, nullptr)) {
    const std::string message = png_data.message;
    png_image_free(&png_data);
    return file_error(path, "is not a readable PNG: " + message);
  }
  return image;
}

}  // namespace catena::render
