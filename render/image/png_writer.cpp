// SPDX-License-Identifier: MIT
#include "render/image/png_writer.h"

#include <png.h>

#include <csetjmp>
#include <vector>

#include "engine/base/output_file.h"
#include "engine/base/result.h"

namespace catena::render {
namespace {

void to_file(png_structp png, png_bytep data, png_size_t size) {
  static_cast<OutputFile*>(png_get_io_ptr(png))->write({reinterpret_cast<const char*>(data), size});
}
void flush(png_structp) {}
void quiet(png_structp, png_const_charp) {}
[[noreturn]] void give_up(png_structp png, png_const_charp) { png_longjmp(png, 1); }

// Calls of libpng that can longjmp; their frames hold no object with a destructor. They return false after an error of libpng.
bool begin(png_structp png, png_infop info, const PngFormat& format, png_textp text) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_compression_level(png, 3);
  const int color = format.channels == 1 ? PNG_COLOR_TYPE_GRAY : format.channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA;
  png_set_IHDR(png, info, format.width, format.height, format.bits, color, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (text != nullptr) png_set_text(png, info, text, 1);
  png_write_info(png, info);
  return true;
}
bool write_row(png_structp png, const png_byte* row) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_write_row(png, row);
  return true;
}
bool end(png_structp png) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

struct PngWriter::Impl {
  Impl(OutputFile output, const PngFormat& f, const std::string& name) : file(std::move(output)), format(f), path(name) {}
  ~Impl() { png_destroy_write_struct(&png, &info); }
  Error error() const { return Error{path + ": the image cannot be encoded as PNG"}; }
  std::size_t row_values() const { return std::size_t(format.width) * format.channels; }

  OutputFile file;
  PngFormat format;
  std::string path;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::vector<std::uint8_t> big_endian;  // a row of 16-bit samples
};

PngWriter::PngWriter(std::unique_ptr<Impl> parts) : impl_(std::move(parts)) {}
PngWriter::~PngWriter() = default;
PngWriter::PngWriter(PngWriter&&) noexcept = default;

Result<PngWriter> PngWriter::open(const std::string& path, const PngFormat& format) {
  CATENA_ASSERT(format.width > 0 && format.height > 0 && (format.bits == 8 || format.bits == 16));
  CATENA_ASSERT(format.channels == 1 || format.channels == 3 || format.channels == 4);
  CATENA_TRY(OutputFile file, OutputFile::open(path));
  auto parts = std::make_unique<Impl>(std::move(file), format, path);
  parts->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, give_up, quiet);
  if (parts->png != nullptr) parts->info = png_create_info_struct(parts->png);
  if (parts->info == nullptr) return parts->error();
  png_set_write_fn(parts->png, &parts->file, to_file, flush);
  png_text text{};
  text.compression = PNG_ITXT_COMPRESSION_NONE;
  text.key = parts->format.text_key.data();
  text.text = parts->format.text.data();
  if (!begin(parts->png, parts->info, parts->format, format.text_key.empty() ? nullptr : &text)) return parts->error();
  return PngWriter(std::move(parts));
}

Outcome PngWriter::encode_row(const std::uint8_t* row) {
  if (!write_row(impl_->png, row)) return impl_->error();
  if (impl_->file.failed()) return impl_->file.finish();
  return Done{};
}

Outcome PngWriter::write_rows(std::span<const std::uint8_t> values) {
  const std::size_t row = impl_->row_values();
  CATENA_ASSERT(impl_->format.bits == 8 && values.size() % row == 0);
  for (std::size_t at = 0; at < values.size(); at += row) CATENA_CHECK(encode_row(values.data() + at));
  return Done{};
}

Outcome PngWriter::write_rows(std::span<const std::uint16_t> values) {
  const std::size_t row = impl_->row_values();
  CATENA_ASSERT(impl_->format.bits == 16 && values.size() % row == 0);
  impl_->big_endian.resize(2 * row);
  for (std::size_t at = 0; at < values.size(); at += row) {
    for (std::size_t i = 0; i < row; ++i) {
      impl_->big_endian[2 * i] = std::uint8_t(values[at + i] >> 8);
      impl_->big_endian[2 * i + 1] = std::uint8_t(values[at + i] & 0xff);
    }
    CATENA_CHECK(encode_row(impl_->big_endian.data()));
  }
  return Done{};
}

Outcome PngWriter::finish() {
  if (!end(impl_->png)) return impl_->error();
  return impl_->file.finish();
}

Outcome PngWriter::commit() { return impl_->file.commit(); }

}  // namespace catena::render
