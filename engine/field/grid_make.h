/// Private to this room: the makers of grid.h for data from outside, which may hold nothing finite or nothing valid.
#pragma once
#include "engine/base/result.h"
#include "engine/field/grid.h"

namespace catena::field {

Result<std::shared_ptr<const ScalarGrid>> try_make_scalar_grid(std::string name, const Mapping& mapping, const Index3& size,
                                                               std::span<const float> values, std::span<const std::uint8_t> valid = {});
Result<std::shared_ptr<const VectorGrid>> try_make_vector_grid(std::string name, const Mapping& mapping, const Index3& size,
                                                               std::span<const float> xyz, std::span<const std::uint8_t> valid = {});

}  // namespace catena::field
