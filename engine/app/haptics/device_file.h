/// "--device-file FILE.json": the settings of a device as an object of their own, with the keys of a scene's "device" (docs/scene.md). They
/// take its place in whichever scene is shown, so that what belongs to the thing on the desk is said once. A file that is not there yet
/// says nothing; it is made when there is something to keep. Errors: "FILE:LINE: what; what was expected". Frame thread.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/scene/document.h"

namespace catena::app {

/// In place of the scene's own; nothing where `path` is empty or not there.
Outcome apply_device_file(const std::string& path, scene::Scene& scene);

/// Those values, and all else as it is; whole or not at all.
Outcome write_device_file(const std::string& path, const std::vector<scene::Document::Edit>& edits);

}  // namespace catena::app
