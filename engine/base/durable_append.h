/// A table that grows by rows and is kept while it does: what is in it survives the program and the machine.
#pragma once
#include <string>
#include <string_view>

#include "engine/base/result.h"

namespace catena {

/// Appends `text`, after `header` where the file is new or empty, with one write, and waits until it is on the disk: it is there whole, or
/// torn by the end of the program or the machine, which who reads the file repairs. Where it cannot be written whole, the file is as long
/// as before. Error: "PATH: cannot write: why".
Outcome append_durably(const std::string& path, std::string_view header, std::string_view text);

}  // namespace catena
