/// What a person at the terminal is told beside the work: one line on stderr, filtered for a terminal.
/// Where nobody can read it (a closed descriptor, a full disk) it is dropped: it changes neither the work nor its exit code. Any thread.
#pragma once
#include <string_view>

namespace catena {

void tell(std::string_view line) noexcept;
/// The same after "catena: ".
void tell_from_catena(std::string_view line) noexcept;

}  // namespace catena
