// SPDX-License-Identifier: MIT
#include "engine/io/zarr/brick_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "engine/field/bricks/with_number_type.h"

namespace catena::field {
namespace {

/// Type in which eight numbers of T are added without overflow.
template <class T>
struct SumOf {
  using Integer = std::conditional_t<sizeof(T) == 8, __int128, std::conditional_t<sizeof(T) == 4, std::int64_t, std::int32_t>>;
  using Real = std::conditional_t<sizeof(T) == 8, long double, double>;
  using type = std::conditional_t<std::is_integral_v<T>, Integer, Real>;
};

template <class T>
T mean_of(typename SumOf<T>::type sum, int count) {
  if constexpr (std::is_integral_v<T>) {
    // the floor of (2 sum + count) / (2 count)
    const typename SumOf<T>::type numerator = 2 * sum + count, denominator = 2 * count;
    const typename SumOf<T>::type quotient = numerator / denominator;
    return static_cast<T>(quotient - (numerator % denominator < 0 ? 1 : 0));
  } else {
    return count == 0 ? std::numeric_limits<T>::quiet_NaN() : static_cast<T>(sum / count);
  }
}

/// Halves one row of the result from the `rows` rows of finer voxels that it covers.
template <class T>
void halve_row(const std::array<const T*, 4>& rows, int row_count, int size, T* out) {
  using Sum = typename SumOf<T>::type;
  const int pairs = size / 2;
  if constexpr (std::is_integral_v<T>) {
    std::array<Sum, kBrickEdge / 2> sums{};
    for (int r = 0; r < row_count; ++r)
      for (int x = 0; x < pairs; ++x) sums[x] += static_cast<Sum>(rows[r][2 * x]) + static_cast<Sum>(rows[r][2 * x + 1]);
    if (row_count == 4 && sizeof(T) < 8)
      for (int x = 0; x < pairs; ++x) out[x] = static_cast<T>((sums[x] + 4) >> 3);
    else
      for (int x = 0; x < pairs; ++x) out[x] = mean_of<T>(sums[x], 2 * row_count);
    if (size % 2 != 0) {
      Sum sum = 0;
      for (int r = 0; r < row_count; ++r) sum += static_cast<Sum>(rows[r][size - 1]);
      out[pairs] = mean_of<T>(sum, row_count);
    }
  } else {
    for (int x = 0; x < (size + 1) / 2; ++x) {
      Sum sum = 0;
      int count = 0;
      for (int r = 0; r < row_count; ++r)
        for (int i = 2 * x; i < std::min(size, 2 * x + 2); ++i)
          if (std::isfinite(rows[r][i])) {
            sum += static_cast<Sum>(rows[r][i]);
            ++count;
          }
      out[x] = mean_of<T>(sum, count);
    }
  }
}

}  // namespace

void fill_brick(const NumberType& type, double value, std::span<std::byte> values) {
  with_number_type(type, [&](auto number) {
    number = static_cast<decltype(number)>(value);
    for (std::size_t at = 0; at < values.size(); at += sizeof number) std::memcpy(&values[at], &number, sizeof number);
  });
}

bool is_same_brick(std::span<const std::byte> a, std::span<const std::byte> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size()) == 0;
}

void halve_brick(const NumberType& type, std::span<const std::byte> brick, const Index3& size, bool is_label_map,
                 std::span<std::byte> out) {
  constexpr int kHalf = kBrickEdge / 2;
  with_number_type(type, [&](auto zero) {
    using T = decltype(zero);
    const T* const values = reinterpret_cast<const T*>(brick.data());
    T* const halved = reinterpret_cast<T*>(out.data());
    const auto row_at = [&](int y, int z) { return values + (static_cast<std::ptrdiff_t>(z) * kBrickEdge + y) * kBrickEdge; };
    for (int z = 0; z < (size.z + 1) / 2; ++z)
      for (int y = 0; y < (size.y + 1) / 2; ++y) {
        T* const to = halved + (static_cast<std::ptrdiff_t>(z) * kHalf + y) * kHalf;
        if (is_label_map) {
          for (int x = 0; x < (size.x + 1) / 2; ++x) to[x] = row_at(2 * y, 2 * z)[2 * x];
          continue;
        }
        std::array<const T*, 4> rows{};
        int count = 0;
        for (int k = 2 * z; k < std::min(size.z, 2 * z + 2); ++k)
          for (int j = 2 * y; j < std::min(size.y, 2 * y + 2); ++j) rows[count++] = row_at(j, k);
        halve_row<T>(rows, count, size.x, to);
      }
  });
}

void copy_box(std::size_t voxel_bytes, std::span<const std::byte> in, const Index3& from_size, const Index3& from, std::span<std::byte> out,
              const Index3& to_size, const Index3& to, const Index3& size) {
  const auto offset = [&](const Index3& n, int x, int y, int z) {
    return ((static_cast<std::size_t>(z) * static_cast<std::size_t>(n.y) + static_cast<std::size_t>(y)) * static_cast<std::size_t>(n.x) +
            static_cast<std::size_t>(x)) *
           voxel_bytes;
  };
  const std::size_t row = static_cast<std::size_t>(size.x) * voxel_bytes;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y) {
      const std::size_t source = offset(from_size, from.x, from.y + y, from.z + z), target = offset(to_size, to.x, to.y + y, to.z + z);
      CATENA_ASSERT(source + row <= in.size() && target + row <= out.size());
      std::memcpy(&out[target], &in[source], row);
    }
}

}  // namespace catena::field
