// SPDX-License-Identifier: MIT
#include "engine/field/bricks/brick_range.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "engine/field/bricks/with_number_type.h"

namespace catena::field {

BrickRange find_range(const NumberType& type, std::span<const std::byte> values, const Index3& size, const Index3& stored) {
  BrickRange range{true, true, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  with_number_type(type, [&](auto zero) {
    using T = decltype(zero);
    T min = std::numeric_limits<T>::max(), max = std::numeric_limits<T>::lowest();
    bool found = std::is_integral_v<T>;
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y) {
        const std::byte* row =
            values.data() + (static_cast<std::ptrdiff_t>(z) * stored.y + y) * stored.x * static_cast<std::ptrdiff_t>(sizeof(T));
        for (int x = 0; x < size.x; ++x, row += sizeof(T)) {
          T value;
          std::memcpy(&value, row, sizeof value);
          if constexpr (!std::is_integral_v<T>) {
            if (!std::isfinite(value)) continue;
            found = true;
          }
          min = std::min(min, value);
          max = std::max(max, value);
        }
      }
    if (found) range.min = static_cast<double>(min), range.max = static_cast<double>(max);
  });
  return range;
}

}  // namespace catena::field
