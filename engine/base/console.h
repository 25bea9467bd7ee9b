// SPDX-License-Identifier: MIT
/// Messages to the user at the terminal. No function here throws or blocks the caller for long: a terminal paused by the user (Ctrl-S), a
/// frozen remote session or a pipe without a reader can block a write indefinitely, and a thread that drives a device or handles signals
/// must not wait. Output that is not accepted in time, or not at all (a closed descriptor, a full disk), is dropped; it changes neither the
/// work nor its exit code. Any thread.
#pragma once
#include <string>
#include <string_view>

namespace catena {

/// Prints one line to standard error. Control characters are replaced and the line is cut at kMaxLineBytes (text.h). Waits at most 500 ms
/// at a time for the terminal or pipe to accept it.
void print_line(std::string_view line) noexcept;
/// Prints one line to standard error as print_line() does, after the prefix "catena: ".
void print_message(std::string_view line) noexcept;

/// Writes `text` unchanged to standard output (`descriptor` 1) or standard error (2), as far as it is accepted; whenever the descriptor is
/// not ready, waits at most `wait_ms` milliseconds. Files accept all of it. An error of a write to standard output (for example a full
/// disk; not a write that would block) is retained for stdout_errno().
void print_nonblocking(int descriptor, std::string_view text, int wait_ms = 0) noexcept;

/// Sets and returns the long work that is being done, such as "reading a.nii: 3 s", for a window that waits for it; empty: none.
void set_activity(std::string text);
std::string activity();

/// Returns true when a failed CATENA_ASSERT has printed why the program aborts.
bool assertion_was_reported() noexcept;

/// Returns the errno of the first failed write of print_nonblocking() to standard output; 0: no write has failed.
int stdout_errno() noexcept;

}  // namespace catena
