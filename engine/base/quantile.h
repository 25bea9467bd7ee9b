/// The q-quantile of a sample: the element number floor(q n) of the sorted values, the largest for q = 1; 0 of none.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace catena {

/// Reorders `values`.
template <class T>
T quantile(std::vector<T>& values, double q) {
  if (values.empty()) return T{};
  const auto k = std::min(values.size() - 1, static_cast<std::size_t>(q * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
  return values[k];
}

}  // namespace catena
