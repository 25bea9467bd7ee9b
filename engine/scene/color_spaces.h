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
#pragma once
#include "engine/base/vec.h"

namespace catena::scene {

enum class ColorSpace { rgb, hsv, hsv_wrap, lab, diverging };

/// The colour at t, 0 (a) to 1 (b); components within 0..1.
Vec3 between_colors(ColorSpace space, const Vec3& a, const Vec3& b, double t);

Vec3 lab_from_srgb(const Vec3& rgb);
Vec3 srgb_from_lab(const Vec3& lab);
Vec3 msh_from_lab(const Vec3& lab);
Vec3 lab_from_msh(const Vec3& msh);

}  // namespace catena::scene
