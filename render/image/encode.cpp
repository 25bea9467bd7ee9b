// SPDX-License-Identifier: MIT
#include "render/image/encode.h"

#include <png.h>
#include <turbojpeg.h>

#include <memory>

namespace catena::render {

Result<std::string> encode_jpeg(const Image8& image, int quality) {
  CATENA_ASSERT(image.width > 0 && image.height > 0 && quality >= 1 && quality <= 100);
  const auto end = [](void* encoder) { tjDestroy(encoder); };
  const std::unique_ptr<void, decltype(end)> encoder(tjInitCompress(), end);
  const auto width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  if (!encoder) return Error{"the image cannot be encoded: out of memory", true};
  std::string bytes(tjBufSize(width, height, TJSAMP_420), '\0');
  auto* out = reinterpret_cast<unsigned char*>(bytes.data());
  unsigned long size = bytes.size();
  if (tjCompress2(encoder.get(), image.rgba.data(), width, 0, height, TJPF_RGBX, &out, &size, TJSAMP_420, quality, TJFLAG_NOREALLOC) != 0)
    return Error{std::string("the image cannot be encoded: ") + tjGetErrorStr2(encoder.get()), true};
  bytes.resize(size);
  return bytes;
}

Result<std::string> encode_png(const Image8& image) {
  CATENA_ASSERT(image.width > 0 && image.height > 0);
  std::string rgb(std::size_t(3) * image.width * image.height, '\0');
  for (std::size_t i = 0; i < std::size_t(image.width) * image.height; ++i)
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] = static_cast<char>(image.rgba[4 * i + c]);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = image.width;
  png.height = image.height;
  png.format = PNG_FORMAT_RGB;
  png.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
    return Error{std::string("the image cannot be encoded: ") + png.message, true};
  bytes.resize(size);
  return bytes;
}

}  // namespace catena::render
