#include "engine/app/options.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/color_maps.h"

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
  if (!bar)
    return Error{
        "--scalar-bar: nothing here has colours; a volume or streamlines with \"color_by\" were expected (--colormap NAME makes a data "
        "file one)"};
  all.scalar_bars.push_back(*bar);
  return Done{};
}

void ColorOption::add_to(CLI::App& command) {
  command.add_option("--colormap", map, "colour map of a data file (catena info --colormaps lists them); lines show their speed by it");
  command.add_option("--range", range, "the values between which a data file's colours, and a volume's opacity, lie: LO HI")->expected(2);
}

Result<scene::NamedColors> ColorOption::named() const {
  scene::NamedColors colors;
  if (!map.empty() && !scene::is_color_map(map)) return Error{one_line("--colormap: " + scene::not_a_color_map(map))};
  colors.map = map;
  if (range.empty()) return colors;
  const auto lo = parse_double(range[0]), hi = parse_double(range[1]);
  if (!lo || !hi || !scene::is_color_range(*lo, *hi))
    return Error{one_line("--range " + range[0] + " " + range[1] + ": two rising numbers LO HI were expected")};
  colors.range = {*lo, *hi};
  return colors;
}

}  // namespace catena::app
