// SPDX-License-Identifier: MIT
/// Private to this module: vectors whose final length no header states check the memory budget before they grow.
#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

#include "engine/base/memory_limit.h"

namespace catena::mesh {

/// Reserves capacity for one more element. `beside`: bytes already in use that stay in use; `what` names the elements, such as "vertices".
/// Returns an Error when the memory budget does not allow it.
template <class T>
Outcome reserve_checked(std::vector<T>& list, double beside, const std::string& name, const char* what) {
  if (list.size() < list.capacity()) return Done{};
  constexpr std::size_t kFirst = 1024;
  const std::size_t capacity = list.empty() ? kFirst : 2 * list.size();
  // the old buffer stays allocated until the new one is filled
  CATENA_CHECK(check_text_memory_available(fmt::format("{}: a mesh of more than {} {}", name, list.size(), what),
                                           beside + static_cast<double>((list.size() + capacity) * sizeof(T))));
  list.reserve(capacity);
  return Done{};
}

/// Memory allocated by a vector, bytes.
template <class T>
double capacity_bytes(const std::vector<T>& list) {
  return static_cast<double>(list.capacity() * sizeof(T));
}

}  // namespace catena::mesh
