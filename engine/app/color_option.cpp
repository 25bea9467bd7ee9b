#include "engine/app/color_option.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/color_maps.h"

namespace catena::app {

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
