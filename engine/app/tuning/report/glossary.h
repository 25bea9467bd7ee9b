// SPDX-License-Identifier: MIT
/// Glossary for the end of a report page: terms that a reader may not know. A page lists only the terms that it uses.
#pragma once
#include <string>
#include <vector>

namespace catena::app::tuning {

/// One term of the glossary.
struct GlossaryEntry {
  const char* term;
  const char* trigger;  ///< Text whose presence in a report means that the term is used; nullptr: listed in every report.
  const char* definition;
};

/// Returns all entries, in the order of the page.
inline const std::vector<GlossaryEntry>& report_glossary() {
  static const std::vector<GlossaryEntry> words{
      {"the data's own error", nullptr,
       "what lies between the samples of a grid is not known: the mean error of interpolating there, estimated from what every 2nd and "
       "every "
       "4th sample would have given. A setting that errs by less shows or feels the interpolation more exactly, not the thing itself."},
      {"error of the reference", nullptr,
       "errors are differences from the most exact result that could be had; this is how far that one may itself be off. Less cannot be "
       "told."},
      {"front", nullptr,
       "settings marked by a dot, the broad grey line of the plot: no other setting is at once cheaper and more exact. The others need not "
       "be "
       "looked at."},
      {"knee", "knee",
       "where the front bends: cheaper settings err by much more, dearer ones gain little for what they cost (both on logarithmic "
       "scales)."},
      {"L", " L", "the longest edge of the field's box in the world: an error of 1e-6 L is a millionth of it."},
      {"tick", " tick", "one round of the haptic loop: the place of the hand is read, the links move their proxies, a force is sent."},
      {"fetch", "fetch", "value and gradient of a field at one place."},
      {"selected", "selected", "the streamline is traced once, before the first tick, and the hand is held on that curve."},
      {"linear, euler, rk2, rk3, rk4", "rk2",
       "the streamline is integrated anew in each tick. linear: one straight step along the field, beside which the hand drifts (Eqs. 1-2 "
       "of "
       "the paper); euler to rk4: Runge-Kutta steps of order 1 to 4, as long as the hand's way in a tick."},
      {"rkf34, dp54", "rkf34",
       "Runge-Kutta-Fehlberg 3(4) and Dormand-Prince 5(4): they estimate their own error and shorten the step until it is below the "
       "tolerance, a part of L. A hand goes so little in a tick that the first step often is exact enough for several tolerances: these "
       "then are the same."},
      {"ticks that hold", "ticks that hold", "the part of the ticks in which the hand is inside and the surface holds the proxy."},
      {"1/255", "1/255",
       "errors of pictures are in steps of an 8-bit colour, over the pixels that show something: 1 is hardly seen, 10 is."},
      {"99.9 %", "99.9 %", "only one covered pixel of a thousand errs by more."},
      {"thin parts kept", "thin parts",
       "how much of the brightness of thin, bright parts (vessels, edges) is left: of all, and of the one that lost most."},
      {"flicker", "flicker", "how much the error of a pixel changes from picture to picture while the camera turns slowly: what boils."},
      {"exact, fast", "fast, step",
       "two ways of marching rays. Exact ones look up colour and opacity at every sample; fast ones have them integrated between two "
       "samples "
       "beforehand and may skip pixels."},
      {"step", "step", "the distance of two samples on a ray, in edges of the smallest voxel."},
      {"texels", "texel", "the voxels as they are kept on the graphics device."},
  };
  return words;
}

}  // namespace catena::app::tuning
