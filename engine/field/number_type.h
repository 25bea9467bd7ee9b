// SPDX-License-Identifier: MIT
/// Number types in files, by name: float32 float64 uint8 int8 uint16 int16 uint32 int32 uint64 int64. Any thread.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace catena::field {

/// Loss in the conversion of numbers to 32-bit floats.
struct RoundingLoss {
  /// A number was rounded (not set when a slope or intercept is applied).
  bool has_rounded = false;
  /// Finite numbers too large for a float: they become infinite, which makes the voxel invalid.
  std::uint64_t overflow_count = 0;
};

/// Returns notes on the loss, sentences without a final period; `type`: name of the number type in the file.
inline std::vector<std::string> rounding_notes(const RoundingLoss& rounding, std::string_view type) {
  std::vector<std::string> notes;
  if (rounding.has_rounded) notes.push_back("values of type " + std::string(type) + " were rounded to 32-bit floats");
  if (rounding.overflow_count == 1) notes.push_back("1 value exceeds the range of 32-bit floats and is read as a hole");
  if (rounding.overflow_count > 1)
    notes.push_back(std::to_string(rounding.overflow_count) + " values exceed the range of 32-bit floats and are read as holes");
  return notes;
}

/// Number type with its conversion function.
struct NumberType {
  std::string_view name;
  std::size_t bytes;
  /// Converts `count` numbers: out[i] = slope * in[i] + inter, computed in double precision. `in` has native byte order and any alignment.
  void (*decode)(const std::byte* in, std::size_t count, double slope, double inter, float* out, RoundingLoss& rounding);
};

/// Implementation of NumberType::decode for T.
template <class T>
void decode_numbers(const std::byte* in, std::size_t count, double slope, double inter, float* out, RoundingLoss& rounding) {
  const bool plain = slope == 1 && inter == 0;
  for (std::size_t i = 0; i < count; ++i) {
    T v;
    std::memcpy(&v, in + i * sizeof(T), sizeof(T));
    const double number = slope * static_cast<double>(v) + inter;
    out[i] = static_cast<float>(number);
    if (static_cast<double>(out[i]) == number || std::isnan(number)) continue;
    rounding.has_rounded = rounding.has_rounded || plain;
    rounding.overflow_count += std::isinf(out[i]);
  }
}

/// Returns the number type with a name; nullopt when there is none.
inline std::optional<NumberType> find_number_type(std::string_view word) {
  static constexpr NumberType types[] = {
      {"float32", 4, decode_numbers<float>},        {"float64", 8, decode_numbers<double>},
      {"uint8", 1, decode_numbers<std::uint8_t>},   {"int8", 1, decode_numbers<std::int8_t>},
      {"uint16", 2, decode_numbers<std::uint16_t>}, {"int16", 2, decode_numbers<std::int16_t>},
      {"uint32", 4, decode_numbers<std::uint32_t>}, {"int32", 4, decode_numbers<std::int32_t>},
      {"uint64", 8, decode_numbers<std::uint64_t>}, {"int64", 8, decode_numbers<std::int64_t>},
  };
  for (const NumberType& t : types)
    if (t.name == word) return t;
  return std::nullopt;
}

}  // namespace catena::field
