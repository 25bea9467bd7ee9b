// SPDX-License-Identifier: MIT
/// Copy of a recording with other scene texts; ticks, states and hashes stay to the bit. Off the tick.
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "engine/base/result.h"

namespace catena::haptics::log {

/// Returns the new text of a scene.
using RewriteText = std::function<Result<std::string>(std::string_view scene_text)>;

/// Copies the recording `from` to the new file `to`; `rewrite` receives the header's scene text and those of programs with one of their
/// own. A block that is cut off at the end is left out. Error: `from` is no recording or has damaged blocks, `rewrite` fails, or `to`
/// cannot be written; `to` is then removed.
Outcome rewrite_scene_texts(const std::string& from, const std::string& to, const RewriteText& rewrite);

}  // namespace catena::haptics::log
