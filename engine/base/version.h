// SPDX-License-Identifier: MIT
/// Semantic version of Catena. Before 1.0 an incompatible change of the public headers raises the middle number. CMake reads it from here.
#pragma once

namespace catena {

inline constexpr const char* kVersion = "0.3.0";  ///< MAJOR.MINOR.PATCH

}  // namespace catena
