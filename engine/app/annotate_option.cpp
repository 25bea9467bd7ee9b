#include "engine/app/annotate_option.h"

#include <CLI/CLI.hpp>

namespace catena::app {

void add_annotate_options(CLI::App& command, AnnotateOptions& options) {
  command.add_option("--title", options.title, "text at the top of the picture");
  command.add_flag("--scalar-bar", options.scalar_bar, "the colours of the first volume or coloured streamlines, with their values");
  command.add_flag("--orientation-marker", options.orientation_marker, "the world's axes in a corner");
}

Outcome annotate(scene::Scene& scene, const AnnotateOptions& options) {
  scene::Annotations& all = scene.annotations;
  if (!options.title.empty()) all.title = options.title;
  if (options.orientation_marker && !all.orientation_marker) all.orientation_marker.emplace();
  if (!options.scalar_bar || !all.scalar_bars.empty()) return Done{};
  const auto bar = scene::first_scalar_bar(scene.world);
  if (!bar) return Error{"--scalar-bar: nothing here has colours; a volume or streamlines with \"color_by\" were expected"};
  all.scalar_bars.push_back(*bar);
  return Done{};
}

}  // namespace catena::app
