/// Colour maps by name: for volumes, lines, slices and the legends beside them. Display (sRGB) values.
///   viridis, inferno, magma, plasma   N. Smith, S. van der Walt, 2015
///   cividis                           J. Nunez, C. Anderton, R. Renslow, PLoS ONE 13(7), 2018: the same to the colour-blind
///   cool-warm                         K. Moreland, ISVC 2009: computed, Msh (80, 1.08, -1.1) over white to (80, 1.08, 0.5)
///   grey                              black to white
///   dusk                              Catena's own, from blue over green to ivory: what volumes without colours have
/// Each name also with "_r": reversed. Piecewise linear; of the published 256 entries no component is further off than
/// 0.90/255; cool-warm: 0.3/255 at eight of its author's 33 points. Pure functions, any thread.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/vec.h"
#include "engine/scene/components.h"

namespace catena::scene {

using ColorPoint = TransferFunction::ColorPoint;

inline constexpr std::string_view kDefaultLineColorMap = "viridis";
inline constexpr std::string_view kDefaultVolumeColorMap = "dusk";

/// Without the reversed ones.
const std::vector<std::string_view>& color_map_names();
bool is_color_map(std::string_view name);
/// For messages: `"virids" is no colour map; one of viridis, ..., or one of them with "_r", was expected (did you mean ...?)`.
std::string unknown_color_map_message(std::string_view name);

/// The map from lo to hi, even on the scale of `linear_below`, values rising strictly, colours as they are at both ends; its middle colour
/// alone where lo is not below hi. The name must be one (is_color_map); lo and hi finite.
std::vector<ColorPoint> make_color_map(std::string_view name, double lo, double hi, double linear_below = 0);

/// Whether a map can lie between them: fields hold floats, so they are two rising floats.
bool is_color_range(double lo, double hi);

/// The words of ValueMapping::Kind, in its order.
inline constexpr std::string_view kMappingNames[] = {"linear", "log", "symlog"};
inline std::string_view to_string(ValueMapping::Kind kind) { return kMappingNames[static_cast<int>(kind)]; }

/// `linear_below` of engine/base/symlog_scale.h, of values shown from lo to hi: 0 of a linear mapping, lo of a logarithmic one.
double linear_below(const ValueMapping& mapping, double lo, double hi);
/// The same of a transfer function with its colours, by all of its points.
double linear_below(const TransferFunction& transfer);
/// Why the mapping cannot show values from lo to hi, for messages; empty: it can. `what` these are called.
std::string mapping_error(const ValueMapping& mapping, double lo, const std::string& what);
/// The same of the values of the data, from `lo` on, as an error of the item that states the mapping.
Outcome check_mapping(const json::Node& item, const ValueMapping& mapping, double lo);
/// Of values from `lo` on that are shown by `by`, unless it says its own range.
Outcome check_mapping(const ColorBy& by, double lo);

/// What shows values that reach from lo to hi: the table if there is one, else the map, or `fallback`, over its range or lo..hi. Between
/// its points it is linear on the scale of its mapping.
std::vector<ColorPoint> make_color_points(const std::vector<ColorPoint>& table, const NamedColors& named, double lo, double hi,
                                          std::string_view fallback = kDefaultLineColorMap);
/// The same with more points, so that it is linear between them in the value: to 1/2048.
std::vector<ColorPoint> make_color_table(const std::vector<ColorPoint>& table, const NamedColors& named, double lo, double hi,
                                         std::string_view fallback = kDefaultLineColorMap);

/// Colours between two colours, each in the space that its author chose. Components are display (sRGB) values, 0 to 1.
///   rgb        the components themselves
///   hsv        hue, saturation and value; the hue does not pass red
///   hsv_wrap   the same, the hue goes the shorter way round
///   lab        CIELAB of a D65 white
///   diverging  Msh, CIELAB in polar form: M = |Lab|, s = acos(L / M), h = atan2(b, a). Between two saturated colours of
///              different hue an unsaturated white, M = max(M1, M2, 88), is put halfway; a hue towards it turns with the length:
///              h +- s sqrt(M_white^2 - M^2) / (M sin s)
/// A colour too bright for the screen is divided by its greatest component, as VTK does.
/// K. Moreland, "Diverging color maps for scientific visualization", ISVC 2009, section 5. Pure functions, any thread.
enum class ColorSpace { rgb, hsv, hsv_wrap, lab, diverging };

/// The colour at t, 0 (a) to 1 (b); components within 0..1.
Vec3 interpolate_colors(ColorSpace space, const Vec3& a, const Vec3& b, double t);

Vec3 lab_from_srgb(const Vec3& rgb);
Vec3 srgb_from_lab(const Vec3& lab);
Vec3 msh_from_lab(const Vec3& lab);
Vec3 lab_from_msh(const Vec3& msh);

}  // namespace catena::scene
