// SPDX-License-Identifier: MIT
/// Append to a table (a text file of rows) such that completed rows survive a crash of the program or of the system.
#pragma once
#include <string>
#include <string_view>

#include "engine/base/result.h"

namespace catena {

/// Appends `text` to the file with a single write and waits until the data is on the disk (fdatasync); writes `header` first when the file
/// is new or empty. After a crash the text may be cut off in the middle; the reader of the file must repair that. When the write fails, the
/// file is truncated to its previous length. Error: "PATH: cannot write: why", or the file is an input of this process (input_files.h).
Outcome append_durably(const std::string& path, std::string_view header, std::string_view text);

}  // namespace catena
