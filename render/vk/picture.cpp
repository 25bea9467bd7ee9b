#include <fmt/format.h>
#include <png.h>

#include <csetjmp>

#include "engine/base/output_file.h"
#include "render/vk/picture.h"

namespace catena::render {
namespace {

Error file_error(const std::string& path, const std::string& what) { return Error{fmt::format("{}: {}", path, what)}; }

/// Everything goes through one memory block, so that the file system is met once and libpng's errors are only ours.
struct Sink {
  std::vector<png_byte> bytes;
};
void sink_write(png_structp png, png_bytep data, png_size_t size) {
  auto& bytes = static_cast<Sink*>(png_get_io_ptr(png))->bytes;
  bytes.insert(bytes.end(), data, data + size);
}
void sink_flush(png_structp) {}

/// False if libpng gave up. Holds no object with a destructor across its long jump.
bool encode(png_structp png, png_infop info, Sink* sink, std::uint32_t width, std::uint32_t height, int color, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, sink, sink_write, sink_flush);
  png_set_compression_level(png, 3);
  png_set_IHDR(png, info, width, height, 8, color, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_write_image(png, rows);
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

Outcome write_png(const std::string& path, const Picture& picture, bool alpha) {
  CATENA_ASSERT(picture.width > 0 && picture.height > 0 && picture.rgba.size() == std::size_t(4) * picture.width * picture.height);

  // pack
  const std::size_t channels = alpha ? 4 : 3;
  std::vector<png_byte> pixels(channels * picture.width * picture.height);
  for (std::size_t i = 0; i < std::size_t(picture.width) * picture.height; ++i)
    for (std::size_t c = 0; c < channels; ++c) pixels[channels * i + c] = picture.rgba[4 * i + c];
  std::vector<png_bytep> rows(picture.height);
  for (std::size_t y = 0; y < picture.height; ++y) rows[y] = pixels.data() + y * channels * picture.width;

  // encode
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  Sink sink;
  const bool good =
      info && encode(png, info, &sink, picture.width, picture.height, alpha ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB, rows.data());
  png_destroy_write_struct(&png, &info);
  if (!good) return file_error(path, "the picture cannot be encoded as PNG");

  CATENA_TRY(OutputFile file, OutputFile::open(path));
  file.write({reinterpret_cast<const char*>(sink.bytes.data()), sink.bytes.size()});
  return file.commit();
}

Result<Picture> read_png(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&image, path.c_str()))
    return file_error(path, fmt::format("is not a readable PNG: {}", image.message));
  image.format = PNG_FORMAT_RGBA;
  Picture picture{image.width, image.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
  if (!png_image_finish_read(&image, nullptr, picture.rgba.data(), 0, nullptr)) {
    const std::string message = image.message;
    png_image_free(&image);
    return file_error(path, "is not a readable PNG: " + message);
  }
  return picture;
}

}  // namespace catena::render
