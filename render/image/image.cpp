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

Outcome write_png(const std::string& path, const Image8& picture, bool alpha) {
  CATENA_ASSERT(picture.width > 0 && picture.height > 0 && picture.rgba.size() == std::size_t(4) * picture.width * picture.height);

  // pack
  const std::size_t channels = alpha ? 4 : 3;
  std::vector<std::uint8_t> pixels(channels * picture.width * picture.height);
  for (std::size_t i = 0; i < std::size_t(picture.width) * picture.height; ++i)
    for (std::size_t c = 0; c < channels; ++c) pixels[channels * i + c] = picture.rgba[4 * i + c];
  CATENA_TRY(PngWriter png, PngWriter::open(path, {picture.width, picture.height, 8, int(channels)}));
  CATENA_CHECK(png.write_rows(pixels));
  CATENA_CHECK(png.finish());
  return png.commit();
}

Result<Image8> read_png(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&image, path.c_str()))
    return file_error(path, fmt::format("is not a readable PNG: {}", image.message));
  image.format = PNG_FORMAT_RGBA;
  Image8 picture{image.width, image.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
  if (!png_image_finish_read(&image, nullptr, picture.rgba.data(), 0, nullptr)) {
    const std::string message = image.message;
    png_image_free(&image);
    return file_error(path, "is not a readable PNG: " + message);
  }
  return picture;
}

}  // namespace catena::render
