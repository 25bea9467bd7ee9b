/// Options that write over the picture of a scene or a bare file: --title TEXT, --scalar-bar, --orientation-marker.
#pragma once
#include <string>

#include "engine/base/result.h"
#include "engine/scene/scene.h"

namespace CLI {
class App;
}

namespace catena::app {

struct AnnotateOptions {
  std::string title;
  bool scalar_bar = false, orientation_marker = false;
};
void add_annotate_options(CLI::App& command, AnnotateOptions& options);

/// Adds them to what the scene has; a scalar bar for the first thing that has colours, unless the scene has bars already.
Outcome annotate(scene::Scene& scene, const AnnotateOptions& options);

}  // namespace catena::app
