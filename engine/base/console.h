/// What a person at the terminal is told beside the work. Nothing here throws or holds anybody up: a terminal that a person has stopped
/// (Ctrl-S), a frozen remote session or a pipe that nobody reads makes a print wait for as long as it likes, and whoever holds a device,
/// or looks for signals, must not wait. What is not taken in time, or by nobody (a closed descriptor, a full disk), is dropped: it changes
/// neither the work nor its exit code. Any thread.
#pragma once
#include <string_view>

namespace catena {

/// One line on standard error, filtered for a terminal.
void print_line(std::string_view line) noexcept;
/// The same after "catena: ".
void print_message(std::string_view line) noexcept;

/// Writes the text, as it is, to standard output (1) or standard error (2), as far as it is taken within `wait_ms`. Files take all of it.
/// An error of a write to standard output (a full disk, no waiting) is kept for stdout_errno().
void print_nonblocking(int descriptor, std::string_view text, int wait_ms = 0) noexcept;

/// Whether a failed CATENA_ASSERT has said why the program aborts.
bool assertion_was_reported() noexcept;

/// The first error (errno) of print_nonblocking() on standard output; 0: none.
int stdout_errno() noexcept;

}  // namespace catena
