// SPDX-License-Identifier: MIT
// Loads MRtrix tracks: "mrtrix tracks", lines "key: value", "END"; "file: . OFFSET" gives the offset of the triples.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/geometry/curves/byte_order.h"
#include "engine/io/curves/load_curves.h"
#include "engine/io/formats.h"
#include "engine/io/parse_file.h"

namespace catena::curves {
namespace {

constexpr std::string_view kMagic = "mrtrix tracks";
constexpr std::size_t kMaxHeader = std::size_t{1} << 24;

struct Numbers {
  std::string_view word;
  std::size_t bytes;
  bool big_endian;
};
constexpr Numbers kNumbers[] = {{"Float32LE", 4, false}, {"Float32BE", 4, true}, {"Float64LE", 8, false}, {"Float64BE", 8, true}};

struct TckHeader {
  const Numbers* numbers = nullptr;
  std::size_t data = 0;  ///< offset of the first triple
};

Result<TckHeader> read_tck_header(std::string_view bytes, const std::string& name) {
  const auto failed = [&](int line, const std::string& what) { return Error{one_line(fmt::format("{}: line {}: {}", name, line, what))}; };
  TckHeader header;
  std::optional<std::size_t> offset;
  std::size_t at = 0;
  for (int line = 1;; ++line) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos || end > kMaxHeader) return failed(line, "the header has no end; a line END was expected");
    const std::string_view text = trim(bytes.substr(at, end - at));
    at = end + 1;
    if (line == 1 && text != kMagic) return failed(1, "the first line is " + in_quotes(text) + "; \"mrtrix tracks\" was expected");
    if (text == "END") {
      if (header.numbers == nullptr) return failed(line, "the header has no datatype; a line such as \"datatype: Float32LE\" was expected");
      header.data = offset.value_or(at);
      if (header.data < at || header.data > bytes.size())
        return failed(line, fmt::format("the data begin at byte {}; an offset from {} to {} was expected", header.data, at, bytes.size()));
      return header;
    }
    const std::size_t colon = text.find(':');
    if (line == 1 || colon == std::string_view::npos) continue;
    const std::string_view key = trim(text.substr(0, colon)), value = trim(text.substr(colon + 1));
    if (key == "datatype") {
      for (const Numbers& numbers : kNumbers)
        if (value == numbers.word) header.numbers = &numbers;
      if (header.numbers == nullptr)
        return failed(line, "the datatype is " + in_quotes(value) + "; one of Float32LE, Float32BE, Float64LE, Float64BE was expected");
    } else if (key == "file") {
      const std::size_t blank = value.find(' ');
      const long long number = blank == std::string_view::npos ? -1 : parse_integer(trim(value.substr(blank))).value_or(-1);
      if (!value.starts_with(". ") || number < 0)
        return failed(line, "the data are in " + in_quotes(value) + "; \". OFFSET\", an offset in this file, was expected");
      offset = static_cast<std::size_t>(number);
    }
  }
}

}  // namespace

Result<CurveSet> parse_tck(std::string_view bytes, const std::string& name) {
  CATENA_TRY(const TckHeader header, read_tck_header(bytes, name));
  const std::size_t triple = 3 * header.numbers->bytes;
  CATENA_TRY(CurveSetBuilder builder, CurveSetBuilder::create(name, (bytes.size() - header.data) / triple, {}));
  const bool big = header.numbers->big_endian;
  for (std::size_t at = header.data; at + triple <= bytes.size(); at += triple) {
    Vec3 p;
    for (int i = 0; i < 3; ++i) {
      const char* number = bytes.data() + at + static_cast<std::size_t>(i) * header.numbers->bytes;
      p[i] = triple == 12 ? static_cast<double>(decode_number<float>(number, big)) : decode_number<double>(number, big);
    }
    if (std::isnan(p.x) && std::isnan(p.y) && std::isnan(p.z)) {
      builder.end_line();
    } else if (std::isinf(p.x) && std::isinf(p.y) && std::isinf(p.z)) {
      CATENA_TRY(CurveSet set, builder.finish());
      set.unit = "mm";
      set.is_patient_space = true;
      return set;
    } else if (!builder.add(p)) {
      return Error{one_line(
          fmt::format("{}: byte {}: the point ({}, {}, {}) of line {} is not finite or too far away; numbers up to 1e15 were expected",
                      name, at, p.x, p.y, p.z, builder.line_count()))};
    }
  }
  return Error{one_line(name + ": the file ends before the end of the lines; a triple of infinities was expected at the end")};
}

}  // namespace catena::curves

namespace catena::io {

Format tck_format() {
  return {.name = "MRtrix tractogram", .extensions = {".tck"}, .read_curves = parse_file<curves::parse_tck, DataKind::curves, 8>};
}

}  // namespace catena::io
