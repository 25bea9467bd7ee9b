// SPDX-License-Identifier: MIT
/// Calls a generic function with the C++ type of a number type. Any thread.
#pragma once
#include <cstdint>

#include "engine/field/number_type.h"

namespace catena::field {

/// Calls `body` with a value of the C++ type of a number type.
template <class Body>
void with_number_type(const NumberType& type, const Body& body) {
  if (type.name == "float32") return body(float{});
  if (type.name == "float64") return body(double{});
  if (type.name == "uint8") return body(std::uint8_t{});
  if (type.name == "int8") return body(std::int8_t{});
  if (type.name == "uint16") return body(std::uint16_t{});
  if (type.name == "int16") return body(std::int16_t{});
  if (type.name == "uint32") return body(std::uint32_t{});
  if (type.name == "int32") return body(std::int32_t{});
  if (type.name == "uint64") return body(std::uint64_t{});
  return body(std::int64_t{});
}

}  // namespace catena::field
