// SPDX-License-Identifier: MIT
#include "engine/io/sandbox/npy.h"

#include <Imath/half.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/base/memory_limit.h"
#include "engine/base/text.h"
#include "engine/field/number_type.h"
#include "engine/io/sandbox/response_file.h"

namespace catena::sandbox {
namespace {

constexpr std::size_t kMaxHead = 1 << 16;

/// Returns the text after 'KEY': in the header, which is a Python dictionary.
std::optional<std::string_view> value_of(std::string_view head, std::string_view key) {
  const std::size_t at = head.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  const std::size_t colon = head.find(':', at);
  if (colon == std::string_view::npos) return std::nullopt;
  std::string_view value = head.substr(colon + 1);
  value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
  return value;
}

/// Parses a tuple such as "(3, 4, 5)".
std::optional<std::vector<std::int64_t>> shape_of(std::string_view text) {
  if (text.empty() || text.front() != '(') return std::nullopt;
  const std::size_t end = text.find(')');
  if (end == std::string_view::npos) return std::nullopt;
  std::vector<std::int64_t> shape;
  const char *at = text.data() + 1, *last = text.data() + end;
  while (at < last) {
    if (*at == ' ' || *at == ',' || *at == 'L') {
      ++at;
      continue;
    }
    std::int64_t n = 0;
    const auto read = std::from_chars(at, last, n);
    if (read.ec != std::errc() || n < 0) return std::nullopt;
    shape.push_back(n);
    at = read.ptr;
  }
  return shape;
}

Outcome read_type(std::string_view word, NpyHeader& head) {
  const auto unknown = [&] {
    return Error{fmt::format("contains numbers of type {}, expected integers, floats or bools", in_quotes(word))};
  };
  if (word.size() < 3) return unknown();
  head.is_byte_swapped = word[0] == '>';
  if (word[0] != '<' && word[0] != '>' && word[0] != '|' && word[0] != '=') return unknown();
  int bytes = 0;
  const auto read = std::from_chars(word.data() + 2, word.data() + word.size(), bytes);
  if (read.ec != std::errc() || read.ptr != word.data() + word.size()) return unknown();
  const char kind = word[1];
  head.number_bytes = static_cast<std::size_t>(bytes);
  if (kind == 'f' && bytes == 2)
    head.type = "float16";
  else if (kind == 'b' && bytes == 1)
    head.type = "bool";
  else if (kind == 'f' || kind == 'i' || kind == 'u')
    head.type = (kind == 'f' ? "float" : kind == 'i' ? "int" : "uint") + std::to_string(8 * bytes);
  if (head.type.empty() || (head.type != "float16" && head.type != "bool" && !field::find_number_type(head.type))) return unknown();
  return Done{};
}

/// Decodes `count` numbers from number `first` on, `stride` apart.
void decode_row(const NpyHeader& head, const std::byte* data, std::uint64_t first, std::uint64_t stride, std::size_t count, float* out,
                std::size_t out_stride, field::RoundingLoss& rounding) {
  const auto type = field::find_number_type(head.type);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::byte, 8> number{};
    std::memcpy(number.data(), data + (first + i * stride) * head.number_bytes, head.number_bytes);
    if (head.is_byte_swapped) std::reverse(number.begin(), number.begin() + static_cast<std::ptrdiff_t>(head.number_bytes));
    float& to = out[i * out_stride];
    if (type) {
      type->decode(number.data(), 1, 1, 0, &to, rounding);
    } else if (head.type == "bool") {
      to = number[0] != std::byte{0} ? 1.f : 0.f;
    } else {
      std::uint16_t half = 0;
      std::memcpy(&half, number.data(), sizeof half);
      to = imath_half_to_float(half);
    }
  }
}

}  // namespace

Result<NpyHeader> read_npy_header(std::span<const std::byte> bytes, bool axes_xyz) {
  const auto* text = reinterpret_cast<const unsigned char*>(bytes.data());
  constexpr std::string_view kMagic = "\x93NUMPY";
  if (bytes.size() < 12 || std::memcmp(text, kMagic.data(), kMagic.size()) != 0) return Error{"is not a NumPy array (.npy)"};
  const bool long_head = text[6] >= 2;
  NpyHeader head;
  const std::size_t begin = long_head ? 12 : 10;
  std::size_t length = static_cast<std::size_t>(text[8]) | static_cast<std::size_t>(text[9]) << 8;
  if (long_head) length |= static_cast<std::size_t>(text[10]) << 16 | static_cast<std::size_t>(text[11]) << 24;
  if (length > kMaxHead || begin + length > bytes.size()) return Error{"has a truncated or oversized header"};
  head.data_offset = begin + length;
  const std::string_view words(reinterpret_cast<const char*>(text) + begin, length);
  const auto descr = value_of(words, "'descr'"), order = value_of(words, "'fortran_order'"), dimensions = value_of(words, "'shape'");
  const auto shape = dimensions ? shape_of(*dimensions) : std::nullopt;
  if (!descr || !order || !shape) return Error{"has a header without descr, fortran_order or shape"};
  if (descr->empty() || descr->front() != '\'') return Error{"contains records, expected an array of numbers"};
  CATENA_CHECK(read_type(descr->substr(1, descr->find('\'', 1) - 1), head));
  // strides of the array's own indices
  std::vector<std::int64_t> n = *shape;
  const bool fortran = order->starts_with("True");
  double all = 1;
  for (const std::int64_t v : n) all *= static_cast<double>(v);
  constexpr double kMaxValues = 1e15;
  if (all > kMaxValues) return Error{fmt::format("has the shape ({}) with more than {:.0e} values", fmt::join(n, ", "), kMaxValues)};
  if (n.empty() || n.size() > 4 || !(all >= 1))
    return Error{fmt::format("has the shape ({}), expected one to four dimensions of size 1 or more", fmt::join(n, ", "))};
  std::vector<std::uint64_t> stride(n.size());
  std::uint64_t next = 1;
  for (std::size_t i = 0; i < n.size(); ++i) {
    const std::size_t a = fortran ? i : n.size() - 1 - i;
    stride[a] = next;
    next *= static_cast<std::uint64_t>(n[a]);
  }
  // the components of vectors are the last or the first dimension
  if (n.size() == 4) {
    const bool last = n.back() == 3 || n.back() == 2;
    const std::size_t a = last ? n.size() - 1 : 0;
    if (n[a] != 3 && n[a] != 2)
      return Error{fmt::format("has the shape ({}), expected 2 or 3 components as the first or last dimension of a four-dimensional array",
                               fmt::join(n, ", "))};
    head.components = static_cast<int>(n[a]);
    head.stride[3] = stride[a];
    n.erase(n.begin() + static_cast<std::ptrdiff_t>(a));
    stride.erase(stride.begin() + static_cast<std::ptrdiff_t>(a));
  }
  if (!axes_xyz) {
    std::reverse(n.begin(), n.end());
    std::reverse(stride.begin(), stride.end());
  }
  n.resize(3, 1);
  stride.resize(3, 0);
  head.size = {n[0], n[1], n[2]};
  std::copy(stride.begin(), stride.end(), head.stride);
  return head;
}

field::Size3 npy_grid_size(const NpyHeader& head) {
  field::Size3 size = head.size;
  for (std::int64_t* n : {&size.x, &size.y, &size.z}) *n = std::max<std::int64_t>(*n, 2);
  return size;
}

std::uint64_t npy_float_count(const NpyHeader& head) {
  const field::Size3 n = npy_grid_size(head);
  return static_cast<std::uint64_t>(n.x) * static_cast<std::uint64_t>(n.y) * static_cast<std::uint64_t>(n.z) *
         (head.components == 1 ? 1 : 3);
}

field::RoundingLoss decode_npy(const NpyHeader& head, std::span<const std::byte> numbers, std::span<float> out) {
  field::RoundingLoss rounding;
  const std::size_t components = head.components == 1 ? 1 : 3;
  const field::Size3 n = npy_grid_size(head);
  const auto row = static_cast<std::size_t>(head.size.x);
  // an axis of one voxel is read with this voxel twice
  const auto voxel = [](std::int64_t i, std::int64_t size) { return static_cast<std::uint64_t>(std::min(i, size - 1)); };
  float* to = out.data();
  for (std::int64_t k = 0; k < n.z; ++k)
    for (std::int64_t j = 0; j < n.y; ++j, to += static_cast<std::size_t>(n.x) * components) {
      const std::uint64_t first = voxel(k, head.size.z) * head.stride[2] + voxel(j, head.size.y) * head.stride[1];
      for (std::uint64_t c = 0; c < static_cast<std::uint64_t>(head.components); ++c)
        decode_row(head, numbers.data(), first + c * head.stride[3], head.stride[0], row, to + c, components, rounding);
      if (row == 1) std::copy_n(to, components, to + components);
    }
  return rounding;
}

field::ReadResponse handle_npy_request(const field::ReadRequest& request, std::span<const std::byte> file, ResponseFile& out) {
  const std::string& path = request.load_request.path;
  field::ReadResponse reply;
  reply.name = std::filesystem::path(path).stem().string();
  const auto failed = [&](const std::string& what) {
    reply.error = one_line(path + ": " + what);
    return reply;
  };
  if (!request.load_request.grid.empty() && request.load_request.grid != reply.name)
    return failed(fmt::format("there is no grid \"{}\"; the only grid of the .npy file is \"{}\"", request.load_request.grid, reply.name));
  if (request.load_request.mask_required) return failed("a .npy file has no mask");
  const auto head = read_npy_header(file, request.load_request.axes_xyz);
  if (!head) return failed(head.error().message);
  const std::span<const std::byte> numbers = file.subspan(head->data_offset);
  const double actual_bytes = static_cast<double>(numbers.size());
  const double expected_bytes =
      double(head->size.x) * double(head->size.y) * double(head->size.z) * head->components * double(head->number_bytes);
  if (actual_bytes != expected_bytes)
    return failed(fmt::format("the file has {:.0f} bytes of array data, expected {:.0f}", actual_bytes, expected_bytes));
  const double bytes = static_cast<double>(npy_float_count(*head)) * sizeof(float);
  if (const auto allowed = check_memory_available(path + ": the array", bytes, request.memory_bytes); !allowed) {
    reply.error = allowed.error().message;
    return reply;
  }
  reply.is_vector = head->components > 1;
  reply.dense.size = npy_grid_size(*head);
  reply.dense.components = reply.is_vector ? 3 : 1;
  reply.dense.type = head->type;
  field::NanoMemory memory = out.allocate(static_cast<std::size_t>(bytes), reply.dense.values);
  const field::RoundingLoss rounding =
      decode_npy(*head, numbers, {reinterpret_cast<float*>(memory.data()), static_cast<std::size_t>(npy_float_count(*head))});
  reply.notes = field::rounding_notes(rounding, head->type);
  // a last dimension of 2 or 3 may have been meant as components
  const field::Size3& n = head->size;
  const std::int64_t last = !request.load_request.axes_xyz ? n.x
                            : n.z > 1                      ? n.z
                                                           : n.y,
                     first = request.load_request.axes_xyz ? n.x : std::max(n.y, n.z);
  if (!reply.is_vector && (last == 2 || last == 3) && first > 3)
    reply.notes.push_back(
        fmt::format("the last dimension of size {} was read as voxels of scalars; an array of vectors with {} components has four "
                    "dimensions, such as (1, {}, {}, {})",
                    last, last, request.load_request.axes_xyz ? n.x : std::max<std::int64_t>(n.z, 1),
                    request.load_request.axes_xyz ? std::max<std::int64_t>(n.y, 1) : n.y, last));
  return reply;
}

}  // namespace catena::sandbox
