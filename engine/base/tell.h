/// Words that hold nobody up. A terminal that a person has stopped (Ctrl-S), a frozen remote session or a pipe that nobody reads makes a
/// print wait for as long as it likes; whoever holds a device, or looks for signals, must not wait. Any thread.
#pragma once
#include <string_view>

namespace catena {

/// Writes the text to standard output (1) or standard error (2) as far as it is taken within `wait_ms`; the rest is dropped. Files take
/// all of it.
void tell(int descriptor, std::string_view text, int wait_ms = 0) noexcept;

}  // namespace catena
