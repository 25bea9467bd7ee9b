/// The version of Catena, semantic: before 1.0 a change of what headers promise raises the middle number. CMake reads it from here.
#pragma once

namespace catena {

inline constexpr const char* kVersion = "0.2.0";  ///< MAJOR.MINOR.PATCH

}  // namespace catena
