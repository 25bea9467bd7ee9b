/// Checks of plain data that came from outside, such as the state in a log: a bool or an enumerator that is none of its values is
/// undefined behaviour to read, so that their bytes are looked at. Off the tick.
#pragma once
#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace catena::haptics {

/// Each byte is 0 or 1.
template <class... Flags>
bool are_bools(const Flags&... flags) noexcept {
  static_assert((std::is_same_v<Flags, bool> && ...));
  const auto is_one = [](const bool& flag) {
    unsigned char byte;
    std::memcpy(&byte, &flag, 1);
    return byte <= 1;
  };
  return (is_one(flags) && ...);
}

template <std::size_t n>
bool are_bools(const std::array<bool, n>& flags) noexcept {
  for (std::size_t i = 0; i < n; ++i)
    if (!are_bools(flags.data()[i])) return false;
  return true;
}

/// The number is one of the enumerators from 0 to `last`.
template <class Enum>
bool is_one_of(const Enum& word, Enum last) noexcept {
  std::underlying_type_t<Enum> value;
  std::memcpy(&value, &word, sizeof value);
  return value >= 0 && value <= static_cast<std::underlying_type_t<Enum>>(last);
}

}  // namespace catena::haptics
