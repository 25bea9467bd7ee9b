// SPDX-License-Identifier: MIT
#include "engine/io/chunks/zarr_array.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/base/json.h"
#include "engine/base/text.h"
#include "engine/io/chunks/copy_part.h"
#include "engine/io/stores/store_protocol.h"

namespace catena::chunks {
namespace {

/// Calls `body` with a value of the C++ type of a number type.
template <class Body>
auto with_type(const std::string& name, const Body& body) {
  if (name == "float32") return body(float{});
  if (name == "float64") return body(double{});
  if (name == "uint8") return body(std::uint8_t{});
  if (name == "int8") return body(std::int8_t{});
  if (name == "uint16") return body(std::uint16_t{});
  if (name == "int16") return body(std::int16_t{});
  if (name == "uint32") return body(std::uint32_t{});
  if (name == "int32") return body(std::int32_t{});
  if (name == "uint64") return body(std::uint64_t{});
  return body(std::int64_t{});
}

const json::Node* find(const json::Node& object, std::string_view key) {
  const json::Node* found = object.find(key);
  return found != nullptr && !found->is_null() ? found : nullptr;
}

Result<std::vector<std::int64_t>> read_sizes(const json::Node& root, std::string_view key, std::int64_t max) {
  const json::Node* node = find(root, key);
  std::vector<std::int64_t> sizes;
  if (node == nullptr || node->kind != json::Kind::array || node->items.empty() || node->items.size() > kMaxZarrAxes)
    return json::error_at(json::member_or_parent(root, key),
                          fmt::format("{}: expected a list of 1 to {} whole numbers", in_quotes(key), kMaxZarrAxes));
  for (const json::Node& item : node->items) {
    if (item.kind != json::Kind::number || item.number != std::floor(item.number) || item.number < 1 ||
        item.number > static_cast<double>(max))
      return json::error_at(*node, fmt::format("{}: expected whole numbers from 1 to {}", in_quotes(key), max));
    sizes.push_back(static_cast<std::int64_t>(item.number));
  }
  return sizes;
}

Result<StoredType> read_type(const json::Node& root, std::string_view key) {
  const json::Node* node = find(root, key);
  if (node == nullptr || node->kind != json::Kind::string)
    return json::error_at(json::member_or_parent(root, key), fmt::format("{}: expected one number type, such as \"<u2\"", in_quotes(key)));
  auto type = parse_numpy_type(node->string);
  if (!type) return json::error_at(*node, type.error().message);
  return *type;
}

/// Reads the fill value; whole numbers from the text itself, since not every one of 64 bits is a double.
Outcome read_fill(const json::Node& root, const std::string& text, ZarrArray& array) {
  const json::Node* node = find(root, "fill_value");
  if (node == nullptr) return Done{};
  const auto problem = [&] { return json::error_at(*node, fmt::format("\"fill_value\": expected a number of type {}", array.type.name)); };
  return with_type(array.type.name, [&](auto zero) -> Outcome {
    using T = decltype(zero);
    T value{};
    if (node->kind == json::Kind::boolean) {
      value = static_cast<T>(node->boolean);
    } else if (node->kind == json::Kind::string) {
      constexpr double kInfinity = std::numeric_limits<double>::infinity();
      if (std::is_integral_v<T>) return problem();
      if (node->string == "NaN")
        value = static_cast<T>(std::numeric_limits<double>::quiet_NaN());
      else if (node->string == "Infinity")
        value = static_cast<T>(kInfinity);
      else if (node->string == "-Infinity")
        value = static_cast<T>(-kInfinity);
      else
        return problem();
    } else if (node->kind == json::Kind::number) {
      if constexpr (std::is_integral_v<T>) {
        const char* const end = text.data() + node->end;
        const auto [stop, code] = std::from_chars(text.data() + node->begin, end, value);
        if (code != std::errc() || (stop != end && node->number != static_cast<double>(value))) return problem();
      } else {
        value = static_cast<T>(node->number);
      }
    } else {
      return problem();
    }
    std::memcpy(array.fill.data(), &value, sizeof value);
    return Done{};
  });
}

Outcome read_compression(const json::Node& root, ZarrArray& array) {
  const auto id_of = [](const json::Node& node) { return node.find("id") != nullptr ? node.find("id")->string : std::string(); };
  if (const json::Node* compressor = find(root, "compressor")) {
    const auto codec = find_codec(id_of(*compressor));
    if (!codec)
      return json::error_at(*compressor, fmt::format("the compressor {} is not supported, expected zlib, gzip, blosc, zstd, lz4 or none",
                                                     in_quotes(id_of(*compressor))));
    array.codec = *codec;
  }
  const json::Node* filters = find(root, "filters");
  if (filters == nullptr || (filters->kind == json::Kind::array && filters->items.empty())) return Done{};
  if (filters->kind != json::Kind::array || filters->items.size() != 1 || id_of(filters->items[0]) != "delta")
    return json::error_at(*filters, fmt::format("the filter {} is not supported, expected none or delta",
                                                in_quotes(filters->items.empty() ? std::string() : id_of(filters->items.back()))));
  CATENA_TRY(const StoredType from, read_type(filters->items[0], "dtype"));
  array.delta_type = from;
  if (find(filters->items[0], "astype") != nullptr) {
    CATENA_TRY(array.delta_type, read_type(filters->items[0], "astype"));
  }
  if (from.name != array.type.name || from.is_swapped != array.type.is_swapped)
    return json::error_at(*filters, "the filter delta has another type than the array, expected the same");
  array.has_delta = true;
  return Done{};
}

/// Sums differences, in the type of the array.
void undo_delta(const ZarrArray& array, std::vector<std::byte>& numbers) {
  std::vector<std::byte> from = std::move(numbers);
  if (array.delta_type.is_swapped) swap_bytes(from, array.delta_type.bytes);
  const std::size_t count = from.size() / array.delta_type.bytes;
  numbers.resize(count * array.type.bytes);
  with_type(array.type.name, [&](auto zero) {
    using T = decltype(zero);
    with_type(array.delta_type.name, [&](auto stored) {
      T sum{};
      for (std::size_t i = 0; i < count; ++i) {
        std::memcpy(&stored, from.data() + i * sizeof stored, sizeof stored);
        if constexpr (std::is_integral_v<T> && std::is_integral_v<decltype(stored)>)
          sum = static_cast<T>(static_cast<std::uint64_t>(sum) + static_cast<std::uint64_t>(stored));
        else
          sum = static_cast<T>(sum + static_cast<T>(stored));
        std::memcpy(numbers.data() + i * sizeof sum, &sum, sizeof sum);
      }
    });
  });
}

}  // namespace

Result<StoredType> parse_numpy_type(std::string_view text) {
  constexpr std::string_view kKinds = "iufb", kBytes = "1248";
  const auto problem = [&] {
    return Error{fmt::format("dtype is {}, expected integers of 1 to 8 bytes, float32 or float64", in_quotes(text))};
  };
  if (text.size() != 3 || std::string_view("<>|").find(text[0]) == std::string_view::npos ||
      kKinds.find(text[1]) == std::string_view::npos || kBytes.find(text[2]) == std::string_view::npos)
    return problem();
  StoredType type;
  type.bytes = static_cast<std::size_t>(text[2] - '0');
  type.is_swapped = text[0] == '>' && type.bytes > 1;
  if (text[1] == 'b' && type.bytes != 1) return problem();
  if (text[1] == 'f' && type.bytes < 4) return problem();
  type.name = (text[1] == 'i' ? "int" : text[1] == 'f' ? "float" : "uint") + std::to_string(8 * type.bytes);
  return type;
}

double to_double(const StoredType& type, const std::byte* number) {
  return with_type(type.name, [&](auto value) {
    std::memcpy(&value, number, sizeof value);
    return static_cast<double>(value);
  });
}

std::size_t ZarrArray::chunk_bytes() const {
  std::size_t bytes = type.bytes;
  for (const std::int64_t n : chunk) bytes *= static_cast<std::size_t>(n);
  return bytes;
}

Result<std::vector<std::byte>> ZarrArray::decode(std::span<const std::byte> file) const {
  std::vector<std::byte> numbers(has_delta ? chunk_bytes() / type.bytes * delta_type.bytes : chunk_bytes());
  CATENA_CHECK(decompress(codec, file, numbers));
  if (has_delta)
    undo_delta(*this, numbers);
  else if (type.is_swapped)
    swap_bytes(numbers, type.bytes);
  return numbers;
}

Result<ZarrArray> parse_zarr_array(const std::string& text, const std::string& name) {
  CATENA_TRY(const json::Node root, json::parse(text, name));
  ZarrArray array;
  const json::Node* format = root.find("zarr_format");
  if (format == nullptr || format->number != 2)
    return json::error_at(json::member_or_parent(root, "zarr_format"), "\"zarr_format\": expected 2");
  CATENA_TRY(array.shape, read_sizes(root, "shape", field::kMaxStoreAxis));
  CATENA_TRY(array.chunk, read_sizes(root, "chunks", field::kMaxStoreAxis));
  if (array.shape.size() != array.chunk.size()) return json::error_at(root, "\"shape\" and \"chunks\" differ in length");
  CATENA_TRY(array.type, read_type(root, "dtype"));
  long double bytes = static_cast<long double>(array.type.bytes);
  for (const std::int64_t n : array.chunk) bytes *= static_cast<long double>(n);
  if (bytes > static_cast<long double>(kMaxChunkBytes))
    return json::error_at(*root.find("chunks"),
                          fmt::format("a chunk has {:.0f} bytes, expected at most {}", static_cast<double>(bytes), kMaxChunkBytes));
  const json::Node* order = find(root, "order");
  if (order != nullptr && order->string != "C" && order->string != "F") return json::error_at(*order, "\"order\": expected \"C\" or \"F\"");
  array.is_fortran = order != nullptr && order->string == "F";
  if (const json::Node* separator = find(root, "dimension_separator")) {
    if (separator->string != "." && separator->string != "/")
      return json::error_at(*separator, "\"dimension_separator\": expected \".\" or \"/\"");
    array.separator = separator->string[0];
  }
  CATENA_CHECK(read_compression(root, array));
  CATENA_CHECK(read_fill(root, text, array));
  return array;
}

}  // namespace catena::chunks
