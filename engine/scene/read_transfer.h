/// Colours and opacities of the scene file, inside this room only. An object that colours by values takes
///   "color"     a table [[value, r, g, b], ...], or the name of a colour map (color_maps.h)
///   "range"     [lo, hi], the values between which a named map lies; without it those of the data
///   "transfer"  instead of both: a file, relative to the scene's. Either an object with a volume's keys, or ParaView's
///               exported colour map (read_paraview.cpp). "range" beside it lays its tables anew, from their own ends to lo..hi
/// and a volume, or a transfer file, besides
///   "opacity" with "opacity_unit", or "extinction", and "gradient_opacity": [[gradient, factor], ...], field units per world
///   unit, 0 <= factor <= 1, which multiplies the extinction.
/// Errors name the file, the scene's or the transfer file, and the line.
#pragma once
#include <string>

#include "engine/base/json.h"
#include "engine/scene/components.h"

namespace catena::scene {

struct ColorScale {
  std::vector<TransferFunction::ColorPoint> colors;
  NamedColors named;  ///< where `colors` is empty
};

/// "color", "range" and "transfer" of an object.
Result<ColorScale> read_color_scale(const std::string& scene_path, const json::Node& object);
/// The keys of a volume.
Result<TransferFunction> read_transfer(const std::string& scene_path, const json::Node& object);

/// A transfer file's text; `path` is for the messages.
Result<TransferFunction> parse_transfer(std::string_view text, const std::string& path);
/// ParaView's colour map: an array of one object with "RGBPoints".
Result<TransferFunction> read_paraview_map(const json::Node& root);

}  // namespace catena::scene
