// SPDX-License-Identifier: MIT
/// Drives `catena view` on a virtual display with real key and pointer events, by a shell script. Scripts wait for titles and files, not
/// for fixed times.
#pragma once
#include <string>

#include "tests/support/support.h"

namespace catena::test {

/// True if Xvfb and xdotool are installed.
bool can_drive_windows();
/// Prefix that runs a command on a new virtual display, for example of 640x480.
std::string on_display(const std::string& size);

/// Runs in `folder`, the home of the window's user; output goes to `folder`/log.
///   drive("flow.json --size 900x600", "keys ctrl+q")   runs `catena view ...`, waits for its title, plays the script, waits for its end.
/// The script has $V (the window's process), $W (its X window) and
///   titled REGEX     waits until a window has a matching title
///   written FILE     waits until FILE exists and is not empty
///   gone FILE        waits until FILE does not exist
///   says TEXT        waits until the log contains TEXT
///   keys K...        sends keystrokes with pauses
/// A wait that times out writes "never ..." to the log. Returns the window's exit code; -1: killed by a signal, or after the script's
/// limit of 120 s.
int drive_window(const TemporaryFolder& folder, const std::string& options, const std::string& script, const std::string& environment = "");
/// As drive(), without a first window: the script opens windows by `view OPTIONS` (sets $V and $W) and ends with an exit code.
int drive_windows(const TemporaryFolder& folder, const std::string& script);

}  // namespace catena::test
