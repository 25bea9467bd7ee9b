// SPDX-License-Identifier: MIT
#include "engine/io/vtk/dicom_pixels.h"

#include <fmt/format.h>
#include <gdcmPixmapReader.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "engine/io/vtk/dicom_element.h"
#include "engine/io/vtk/gdcm_guard.h"

namespace catena::vtk {
namespace {

using gdcm::Tag;
using Syntax = gdcm::TransferSyntax;

/// Type of the numbers as stored, before rescale.
enum class Stored { integers, floats, doubles };

/// Map from stored to modality values, and the range of the stored values that are padding, in units of the stored type.
struct ValueTable {
  std::vector<double> table;  ///< modality LUT; empty: none
  double first = 0;           ///< stored value of its first entry
  std::optional<double> padding_lo, padding_hi;

  double look_up(double stored) const {
    if (table.empty()) return stored;
    return table[static_cast<std::size_t>(std::clamp(stored - first, 0.0, static_cast<double>(table.size() - 1)))];
  }
  bool is_padding(double stored) const { return padding_lo && stored >= *padding_lo && stored <= *padding_hi; }
};

/// Returns a 16-bit word of the header as a value of the pixels' type.
double in_type_of_pixels(double word, const DicomFile& file) {
  const auto bits = static_cast<std::uint16_t>(word);
  if (file.is_signed) return static_cast<std::int16_t>(bits);
  const double maximum = std::ldexp(1.0, std::min<int>(file.bits_stored, 32)) - 1;
  return std::min<double>(bits, maximum);
}

Result<ValueTable> table_of(const gdcm::DataSet& root, const DicomFile& file, Stored stored) {
  ValueTable table;
  const auto pair = [&](Tag lo, Tag hi, DicomEncoding encoding) {
    auto value = read_number(root, lo, encoding), limit = read_number(root, hi, encoding);
    if (!value) return;
    if (stored == Stored::integers) {
      value = in_type_of_pixels(*value, file);
      if (limit) limit = in_type_of_pixels(*limit, file);
    }
    table.padding_lo = std::min(*value, limit.value_or(*value));
    table.padding_hi = std::max(*value, limit.value_or(*value));
  };
  if (stored == Stored::integers) pair(Tag(0x28, 0x120), Tag(0x28, 0x121), DicomEncoding::u16);
  if (stored == Stored::floats) pair(Tag(0x28, 0x122), Tag(0x28, 0x124), DicomEncoding::f32);
  if (stored == Stored::doubles) pair(Tag(0x28, 0x123), Tag(0x28, 0x125), DicomEncoding::f64);
  for (const gdcm::DataSet& lut : read_items(root, Tag(0x28, 0x3000))) {
    const std::vector<double> descriptor = read_numbers(lut, Tag(0x28, 0x3002), DicomEncoding::u16);
    if (descriptor.size() < 3) return Error{"the modality LUT has no descriptor"};
    const auto entries = static_cast<std::size_t>(descriptor[0] == 0 ? 65'536 : descriptor[0]);
    table.first = file.is_signed ? static_cast<std::int16_t>(static_cast<std::uint16_t>(descriptor[1])) : descriptor[1];
    const std::string bytes = read_bytes(lut, Tag(0x28, 0x3006));
    const std::size_t width = descriptor[2] <= 8 && bytes.size() < 2 * entries ? 1 : 2;
    if (bytes.size() < width * entries) return Error{fmt::format("the modality LUT is truncated, expected {} entries", entries)};
    for (std::size_t i = 0; i < entries; ++i) {
      const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
      table.table.push_back(width == 1 ? byte(i) : byte(2 * i) | byte(2 * i + 1) << 8);
    }
  }
  return table;
}

/// Decodes little-endian pixels of one frame, already extracted from the file.
class FrameDecoder {
 public:
  FrameDecoder(const DicomFile& file, Stored stored, unsigned bits, const ValueTable& table)
      : stored_(stored), bits_(bits), table_(table), is_signed_(file.is_signed) {
    const unsigned used_bits = std::min<unsigned>(file.bits_stored, bits);
    shift_ = file.high_bit + 1u > used_bits && file.high_bit < bits ? file.high_bit + 1u - used_bits : 0u;
    mask_ = used_bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << used_bits) - 1;
    sign_ = std::uint64_t{1} << (used_bits - 1);
  }

  /// `first_bit`: offset of the frame's first pixel in `bytes`.
  void decode(std::string_view bytes, std::size_t first_bit, const DicomFrame& frame, std::span<float> values, PixelStats& notes) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double stored = number_at(bytes, first_bit + i * bits_);
      if (table_.is_padding(stored)) {
        values[i] = std::numeric_limits<float>::quiet_NaN();
        ++notes.padding_count;
        continue;
      }
      values[i] = static_cast<float>(frame.slope * table_.look_up(stored) + frame.intercept);
      if (stored_ != Stored::floats && std::fabs(stored) > kExact && static_cast<double>(static_cast<float>(stored)) != stored)
        ++notes.rounded_count;
    }
  }

 private:
  static constexpr double kExact = 1 << 24;

  double number_at(std::string_view bytes, std::size_t bit) const {
    const char* from = bytes.data() + bit / 8;
    if (stored_ == Stored::floats) {
      float value;
      std::memcpy(&value, from, sizeof value);
      return static_cast<double>(value);
    }
    if (stored_ == Stored::doubles) {
      double value;
      std::memcpy(&value, from, sizeof value);
      return value;
    }
    if (bits_ == 1) return static_cast<unsigned char>(*from) >> (bit % 8) & 1;
    std::uint64_t raw = 0;
    std::memcpy(&raw, from, bits_ / 8);
    raw = raw >> shift_ & mask_;
    if (is_signed_ && (raw & sign_) != 0) return static_cast<double>(static_cast<std::int64_t>(raw | ~mask_));
    return static_cast<double>(raw);
  }

  Stored stored_;
  unsigned bits_, shift_ = 0;
  std::uint64_t mask_ = 0, sign_ = 0;
  const ValueTable& table_;
  bool is_signed_;
};

/// All pixels of a file, in memory, little-endian.
struct Pixels {
  std::string bytes;
  unsigned bits = 0;  ///< per pixel
};

/// Corrects the order of 16-bit words. GDCM has swapped the bytes of big-endian words, but wider numbers still have their words reversed.
void order_words(std::string& bytes, unsigned bits) {
  const std::size_t step = bits / 8;
  if (step <= 2) return;
  for (std::size_t at = 0; at + step <= bytes.size(); at += step)
    for (std::size_t a = 0, b = step - 2; a < b; a += 2, b -= 2)
      for (std::size_t k = 0; k < 2; ++k) std::swap(bytes[at + a + k], bytes[at + b + k]);
}

Result<Pixels> decoded_pixels(const DicomFile& file, std::size_t pixels) {
  auto reader = std::make_unique<gdcm::PixmapReader>();  // reads no geometry, unlike ImageReader, which rejects some valid geometries
  reader->SetFileName(file.path.c_str());
  Pixels decoded;
  std::size_t bytes = 0;
  bool read = false;
  const auto guarded = [&](const std::function<void()>& call) {
    if (!call_gdcm(call)) static_cast<void>(reader.release());
    return reader != nullptr;
  };
  if (!guarded([&] {
        read = reader->Read();
        if (read) bytes = reader->GetPixmap().GetBufferLength();
      }) ||
      !read)
    return Error{"the pixels cannot be decoded"};
  if (pixels == 0 || bytes % pixels != 0 || bytes / pixels > 8)
    return Error{fmt::format("the compressed pixels decode to {} bytes, expected {} pixels", bytes, pixels)};
  decoded.bytes.resize(bytes);
  decoded.bits = static_cast<unsigned>(8 * (bytes / pixels));
  if (!guarded([&] { read = reader->GetPixmap().GetBuffer(decoded.bytes.data()); }) || !read)
    return Error{"the compressed pixels cannot be decoded: the pixels are damaged, or the compression is unknown"};
  return decoded;
}

/// Checks that the fragments of compressed pixels are complete and end with a delimiter: decoders fill in missing data silently.
Outcome check_fragments(const DicomFile& file) {
  if (file.fragments_offset < 0) return Done{};
  std::ifstream in(file.path, std::ios::binary | std::ios::ate);
  const auto end = static_cast<std::int64_t>(in.tellg());
  for (std::int64_t at = file.fragments_offset; at + 8 <= end;) {
    std::array<std::uint16_t, 4> head{};  // group and element of an item or delimiter, and the length as two words
    in.seekg(at).read(reinterpret_cast<char*>(head.data()), sizeof head);
    if (in && head[0] == 0xfffe && head[1] == 0xe0dd) return Done{};
    if (!in || head[0] != 0xfffe || head[1] != 0xe000) return Error{"the compressed pixels are damaged"};
    at += 8 + (std::int64_t{head[3]} << 16 | head[2]);
  }
  return Error{"the file is truncated inside the compressed pixels"};
}

Outcome truncated(std::size_t has, std::size_t expected) {
  return Error{fmt::format("the file is truncated: it has {} bytes of pixels, expected {}", has, expected)};
}

/// Reads uncompressed pixels, one frame at a time.
Outcome read_plain(const DicomFile& file, const std::vector<const DicomFrame*>& frames, const FrameDecoder& decoder,
                   const FrameCallback& on_frame, PixelStats& notes) {
  std::ifstream in(file.path, std::ios::binary | std::ios::ate);
  const auto end = static_cast<std::uint64_t>(in.tellg());
  const auto start = static_cast<std::uint64_t>(file.pixel_offset);
  const std::uint64_t available = std::min<std::uint64_t>(end > start ? end - start : 0, file.pixel_bytes);
  const std::size_t bits = file.bits_allocated, count = std::size_t{frames.front()->columns} * frames.front()->rows;
  if (const std::uint64_t all = (file.frames.size() * count * bits + 7) / 8; available < all) return truncated(available, all);
  std::vector<float> values(count);
  std::string bytes;
  for (const DicomFrame* frame : frames) {
    const std::size_t first = frame->index * count * bits;
    bytes.resize((first % 8 + count * bits + 7) / 8);
    in.seekg(static_cast<std::streamoff>(start + first / 8)).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!in) return truncated(available, bytes.size());
    decoder.decode(bytes, first % 8, *frame, values, notes);
    on_frame(*frame, values);
  }
  return Done{};
}

}  // namespace

Outcome read_dicom_pixels(const DicomFile& file, const std::vector<const DicomFrame*>& frames, const FrameCallback& on_frame,
                          PixelStats& notes) {
  if (frames.empty()) return Done{};
  const std::size_t count = std::size_t{frames.front()->columns} * frames.front()->rows;
  const bool is_uncompressed = file.pixel_offset >= 0;
  if (!is_uncompressed) CATENA_CHECK(check_fragments(file));
  const Tag pixel_tag(0x7fe0, 0x10);
  const std::unique_ptr<gdcm::Reader> owned = open_dicom_reader(file.path, is_uncompressed);
  if (owned == nullptr) return Error{"cannot be read: the file is damaged"};
  const gdcm::Reader& reader = *owned;
  const gdcm::DataSet& root = reader.GetFile().GetDataSet();
  const Syntax& syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
  const bool floats = root.FindDataElement(Tag(0x7fe0, 0x8)), doubles = root.FindDataElement(Tag(0x7fe0, 0x9));
  const Stored stored = doubles ? Stored::doubles : floats ? Stored::floats : Stored::integers;
  CATENA_TRY(const ValueTable table, table_of(root, file, stored));
  const unsigned allocated = doubles ? 64 : floats ? 32 : file.bits_allocated;
  if (allocated != 1 && allocated != 8 && allocated != 16 && allocated != 32 && allocated != 64)
    return Error{fmt::format("has pixels of {} bits, expected 1, 8, 16, 32 or 64", allocated)};
  if (file.bits_stored < 1 || (stored == Stored::integers && file.bits_stored > allocated))
    return Error{fmt::format("has {} stored bits per pixel, expected 1 to {}", file.bits_stored, allocated)};
  if (is_uncompressed) return read_plain(file, frames, FrameDecoder(file, stored, allocated, table), on_frame, notes);
  // compressed, big-endian or deflated pixels, and floats, are read all at once
  Pixels pixels{read_bytes(root, floats ? Tag(0x7fe0, 0x8) : doubles ? Tag(0x7fe0, 0x9) : pixel_tag), allocated};
  const std::size_t all = count * file.frames.size();
  if (syntax.IsEncapsulated()) {
    CATENA_TRY(pixels, decoded_pixels(file, all));
  } else if (syntax == Syntax::ExplicitVRBigEndian && stored == Stored::integers) {
    order_words(pixels.bytes, allocated);
  }
  if (const std::size_t expected = (all * pixels.bits + 7) / 8; pixels.bytes.size() < expected)
    return truncated(pixels.bytes.size(), expected);
  const FrameDecoder decoder(file, stored, pixels.bits, table);
  std::vector<float> values(count);
  for (const DicomFrame* frame : frames) {
    const std::size_t first = frame->index * count * pixels.bits;
    decoder.decode(std::string_view(pixels.bytes).substr(first / 8), first % 8, *frame, values, notes);
    on_frame(*frame, values);
  }
  return Done{};
}

}  // namespace catena::vtk
