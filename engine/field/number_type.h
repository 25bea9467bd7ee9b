/// Private to this room: plain numbers in files, by their word: float32 float64 uint8 int8 uint16 int16 uint32 int32 uint64 int64.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

namespace catena::field {

struct NumberType {
  std::string_view word;
  std::size_t bytes;
  /// out[i] = slope * in[i] + inter, computed in double; `in` in the machine's byte order, of any alignment.
  void (*decode)(const std::byte* in, std::size_t count, double slope, double inter, float* out);
};

template <class T>
void decode_numbers(const std::byte* in, std::size_t count, double slope, double inter, float* out) {
  for (std::size_t i = 0; i < count; ++i) {
    T v;
    std::memcpy(&v, in + i * sizeof(T), sizeof(T));
    out[i] = static_cast<float>(slope * static_cast<double>(v) + inter);
  }
}

inline std::optional<NumberType> number_type(std::string_view word) {
  static constexpr NumberType types[] = {
      {"float32", 4, decode_numbers<float>},        {"float64", 8, decode_numbers<double>},
      {"uint8", 1, decode_numbers<std::uint8_t>},   {"int8", 1, decode_numbers<std::int8_t>},
      {"uint16", 2, decode_numbers<std::uint16_t>}, {"int16", 2, decode_numbers<std::int16_t>},
      {"uint32", 4, decode_numbers<std::uint32_t>}, {"int32", 4, decode_numbers<std::int32_t>},
      {"uint64", 8, decode_numbers<std::uint64_t>}, {"int64", 8, decode_numbers<std::int64_t>},
  };
  for (const NumberType& t : types)
    if (t.word == word) return t;
  return std::nullopt;
}

}  // namespace catena::field
