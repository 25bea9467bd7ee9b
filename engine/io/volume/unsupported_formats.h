/// Kinds of files that are not read, by the endings of their names (any case; Zarr is a folder), and how a common free program converts
/// them into one that is. Any thread.
#pragma once
#include <string>
#include <string_view>

namespace catena::field {

/// "a TIFF image, which is not read; convert it: ..."; empty: the ending is not known.
std::string conversion_hint(std::string_view path);

}  // namespace catena::field
