// SPDX-License-Identifier: MIT
/// --device-file FILE.json: the settings of a device as an object of their own, with the keys of a scene's "device"
/// (docs/reference/scene.md). They replace the scene's "device" in every scene, so that the settings of a device on the desk are stored in
/// one place. A file that does not exist has no effect; it is created when there are settings to store. Errors: "FILE:LINE: what; what was
/// expected". Frame thread.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/scene/document.h"

namespace catena::app {

/// Replaces the scene's "device" by the file's; does nothing if `path` is empty or the file does not exist.
Outcome apply_device_file(const std::string& path, scene::Scene& scene);

/// Writes the edited values into the file and leaves the rest unchanged; atomically.
Outcome write_device_file(const std::string& path, const std::vector<scene::Document::Edit>& edits);

}  // namespace catena::app
