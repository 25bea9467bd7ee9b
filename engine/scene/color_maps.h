// SPDX-License-Identifier: MIT
/// Color maps by name, for volumes, lines, slices and their scalar bars. Display (sRGB) values.
///   viridis, inferno, magma, plasma   N. Smith, S. van der Walt, 2015
///   cividis                           J. Nunez, C. Anderton, R. Renslow, PLoS ONE 13(7), 2018: the same with color vision deficiency
///   cool-warm                         K. Moreland, ISVC 2009: computed, Msh (80, 1.08, -1.1) over white to (80, 1.08, 0.5)
///   turbo                             A. Mikhailov, Google AI blog, 2019
///   hot, jet                          as in Matplotlib
///   grey                              black to white
///   dusk                              Catena's own, from blue over green to ivory: the default of volumes
/// Each name with the suffix "_r" is the reversed map. Piecewise linear: no component of the published 256 entries is off by more than
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

/// Returns the names of all maps, without the reversed ones.
const std::vector<std::string_view>& color_map_names();
/// Returns whether there is a map of that name, with or without "_r".
bool is_color_map(std::string_view name);
/// Returns a warning, one clause, for a map whose lightness misleads; empty: none.
std::string_view color_map_warning(std::string_view name);
/// Returns an error message that quotes the unknown name, lists the known ones and suggests the most similar one.
std::string unknown_color_map_message(std::string_view name);

/// Returns the map stretched over lo..hi, uniform on the scale of `linear_below` (engine/base/symlog_scale.h), values strictly rising. If
/// lo is not below hi: one point with the map's middle color. Precondition: the name is known (is_color_map); lo and hi are finite.
std::vector<ColorPoint> make_color_map(std::string_view name, double lo, double hi, double linear_below = 0);

/// Returns whether a color map can span lo..hi: fields hold floats, so both must be floats with lo < hi.
bool is_color_range(double lo, double hi);

/// Values of the scene key "mapping", in the order of ValueMapping::Kind.
inline constexpr std::string_view kMappingNames[] = {"linear", "log", "symlog"};
inline std::string_view to_string(ValueMapping::Kind kind) { return kMappingNames[static_cast<int>(kind)]; }

/// Returns the `linear_below` of engine/base/symlog_scale.h for values shown from lo to hi: 0 for a linear mapping, lo for a logarithmic
/// one, else that of the mapping or its default.
double linear_below(const ValueMapping& mapping, double lo, double hi);
/// Returns the `linear_below` of a transfer function whose colors are set; lo and hi are the minimum and maximum value of all its points.
double linear_below(const TransferFunction& transfer);
/// Returns an error message when the mapping cannot show values that start at `lo`, else an empty string. `what` names the values.
std::string mapping_error(const ValueMapping& mapping, double lo, const std::string& what);
/// Checks that the mapping can show data whose minimum is `lo`; the Error has the position of `item`, which states the mapping.
Outcome check_mapping(const json::Node& item, const ValueMapping& mapping, double lo);
/// Checks the mapping of values colored by `by`, whose minimum is `lo`; always succeeds if `by` has a color table or a range.
Outcome check_mapping(const ColorBy& by, double lo);

/// Returns the color points for values from lo to hi: the table if it is not empty; else the named map, or `fallback`, over the named range
/// or else lo..hi. Between the points colors are linear on the scale of the mapping.
std::vector<ColorPoint> make_color_points(const std::vector<ColorPoint>& table, const NamedColors& named, double lo, double hi,
                                          std::string_view fallback = kDefaultLineColorMap);
/// Returns the points of make_color_points() and additional ones, so that linear interpolation in the value is accurate to 1/2048.
std::vector<ColorPoint> make_color_table(const std::vector<ColorPoint>& table, const NamedColors& named, double lo, double hi,
                                         std::string_view fallback = kDefaultLineColorMap);

/// Color space in which two colors are interpolated. Components are display (sRGB) values, 0 to 1.
///   rgb        the components themselves
///   hsv        hue, saturation and value; the hue does not cross red
///   hsv_wrap   hue, saturation and value; the hue changes along the shorter arc of the hue circle
///   lab        CIELAB with D65 white
///   diverging  Msh, CIELAB in polar form: M = |Lab|, s = acos(L / M), h = atan2(b, a). Between two saturated colors of
///              different hue an unsaturated white, M = max(M1, M2, 88), is inserted halfway; the hue of white is turned by
///              the length: h +- s sqrt(M_white^2 - M^2) / (M sin s)
/// A color outside the sRGB gamut is divided by its maximum component, as in VTK.
/// K. Moreland, "Diverging color maps for scientific visualization", ISVC 2009, section 5. Pure functions, any thread.
enum class ColorSpace { rgb, hsv, hsv_wrap, lab, diverging };

/// Returns the color at t, from 0 (a) to 1 (b); components within 0..1.
Vec3 interpolate_colors(ColorSpace space, const Vec3& a, const Vec3& b, double t);

/// Conversions between display sRGB, CIELAB (D65) and Msh. srgb_from_lab maps out-of-gamut colors to components within 0..1.
Vec3 lab_from_srgb(const Vec3& rgb);
Vec3 srgb_from_lab(const Vec3& lab);
Vec3 msh_from_lab(const Vec3& lab);
Vec3 lab_from_msh(const Vec3& msh);

}  // namespace catena::scene
