// SPDX-License-Identifier: MIT
/// File formats that are not read, by file extension (any case; Zarr is a folder), and how common free programs convert them to a
/// supported format. Any thread.
#pragma once
#include <string>
#include <string_view>

namespace catena::field {

/// Returns a message fragment "a TIFF image, which is not supported; to convert it: ..."; empty: unknown extension.
std::string conversion_hint(std::string_view path);

}  // namespace catena::field
