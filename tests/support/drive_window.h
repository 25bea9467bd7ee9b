// SPDX-License-Identifier: MIT
/// Drives `catena view` on a virtual display with real key and pointer events, by a shell script. Nothing waits for a time where it can
/// wait for a title or a file.
#pragma once
#include <string>

#include "tests/support/support.h"

namespace catena::test {

/// Xvfb and xdotool are here.
bool can_drive_windows();
/// What is put before a command to run it on a virtual display of its own, for instance of 640x480.
std::string on_display(const std::string& size);

/// In `folder`, which becomes the home of the window's user; what it says goes to `folder`/log.
///   drive("flow.json --size 900x600", "keys ctrl+q")   runs `catena view ...`, waits for its title, plays the script, waits for its end.
/// The script knows $V (the window's process), $W (its X window) and
///   titled REGEX     until a window has such a title
///   written FILE     until FILE is there and not empty
///   gone FILE        until it is not
///   says TEXT        until the log has the text
///   keys K...        each is a stroke, with time between them for a person's eye
/// What never comes is said as "never ..." in the log. Exit code of the window; -1: it was killed by a signal, or the script's 120 s are
/// over.
int drive_window(const TemporaryFolder& folder, const std::string& options, const std::string& script, const std::string& environment = "");
/// The same without a first window: the script opens its own by `view OPTIONS` (sets $V and $W) and ends with an exit code.
int drive_windows(const TemporaryFolder& folder, const std::string& script);

}  // namespace catena::test
