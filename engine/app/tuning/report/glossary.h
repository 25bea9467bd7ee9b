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
      {"discretization error", nullptr,
       "mean interpolation error between the samples of a grid, estimated from the results with every 2nd and every 4th sample. A setting "
       "with a smaller error reproduces the interpolation more accurately, but not the measured object."},
      {"error of the reference", nullptr,
       "estimated error of the most accurate result, against which all errors are measured. Smaller errors cannot be resolved."},
      {"front", nullptr,
       "Pareto front: settings marked by a dot, and the broad grey line of the plot. No other setting is both cheaper and more accurate."},
      {"knee", "knee",
       "point where the front bends: cheaper settings have much larger errors, and more expensive ones gain little accuracy for their cost "
       "(on logarithmic scales)."},
      {"L", " L", "longest edge of the field's box, world units: an error of 1e-6 L is a millionth of this length."},
      {"tick", " tick", "one cycle of the haptic loop: the device position is read, the links move their proxies, a force is sent."},
      {"fetch", "fetch", "evaluation of the value and the gradient of a field at one point."},
      {"selected", "selected", "the streamline is traced once, before the first tick, and the proxy moves on this curve."},
      {"linear, euler, rk2, rk3, rk4", "rk2",
       "the streamline is integrated anew in each tick. linear: one straight step along the field, so that the proxy drifts off the line "
       "(Eqs. 1-2 of the paper); euler to rk4: Runge-Kutta steps of order 1 to 4, as long as the probe's motion in a tick."},
      {"rkf34, dp54", "rkf34",
       "Runge-Kutta-Fehlberg 3(4) and Dormand-Prince 5(4): methods that estimate their error and shorten the step until the error is below "
       "the tolerance, a fraction of L. The motion in a tick is so short that the first step is often accurate enough for several "
       "tolerances, which then give the same result."},
      {"ticks that hold", "ticks that hold", "fraction of the ticks in which the probe is inside and the surface holds the proxy."},
      {"1/255", "1/255",
       "unit of image errors: one step of an 8-bit colour, over the covered pixels. An error of 1 is hardly visible, one of 10 is "
       "visible."},
      {"99.9 %", "99.9 %", "error that only one covered pixel in a thousand exceeds."},
      {"thin parts kept", "thin parts",
       "fraction of the brightness of thin, bright parts (vessels, edges) that is retained: of all parts, and of the part with the largest "
       "loss."},
      {"flicker", "flicker", "change of a pixel's error from image to image while the camera turns slowly."},
      {"exact, fast", "fast, step",
       "two kinds of rays. Exact rays evaluate colour and opacity at every sample; fast rays use values that were integrated between two "
       "samples beforehand, and may skip pixels."},
      {"step", "step", "distance between two samples on a ray, in edges of the smallest voxel."},
      {"texels", "texel", "voxels as they are stored on the graphics device."},
  };
  return words;
}

}  // namespace catena::app::tuning
