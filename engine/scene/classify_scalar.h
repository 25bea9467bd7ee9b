// SPDX-License-Identifier: MIT
/// Kind of data in a scalar grid, from its file's metadata and its values, so that a data file without a scene is shown as a specialist
/// would show it. Off the tick, any thread; deterministic.
///
/// Evaluated on at most about a million voxels, in blocks of 8^3 spread over the box, without invalid cells and without values beyond the
/// display range (engine/field/field_display_range.h). The background b is the center of the fullest of 256 bins over lo..hi if that bin
/// holds over 5 % of the values and lies in the lowest fifth of the range, else lo; the foreground is everything at least 2 % of the range
/// away from b. The rules are tested in this order, and the first that holds determines the kind:
///   label map    the file is marked as a label map, and the values are integers, at least 2 different ones
///   level set    the file is marked as one; or values of both signs, and a gradient magnitude of 0.95 to 1.05 (world units) at 90 % of the
///                points that have a gradient
///   CT           the unit is HU; or no value is below -5000, 5 % of the values lie from -1100 to -850 (air) and 5 % from -150 to 200
///                (soft tissue), in Hounsfield units
///   label map    integers, 2 to 2048 different ones; 60 % of the neighbor pairs in the foreground are equal along every axis, and
///                40 % of the pairs with at least one voxel in the foreground
///   statistic    in patient space, not integers, values of both signs: at least 5 % of the values other than 0 have either sign, as in
///                a map of t or z values
///   solid        90 % of the values are in the lowest or the highest tenth of the range, at least 2 % in each; or not integers and
///                60 % of the neighbor pairs in the foreground are equal along every axis
///   cloud        not in patient space (engine/io/volume/units.h), no mask, no values below 0; 60 % of the values are the lowest value
///   decades      rough, no values below 0, and not in patient space; the values spread over powers of ten: the 84 or the 16 percentile is
///   a
///                factor e or more from the median, the 99.99 percentile a factor 10 or more, as in turbulence or a density of matter
///   inclusions   rough, and not in patient space; few values are bright, as in an angiogram, and the others have two levels: Otsu's
///   threshold among
///                them explains at least 90 % of their variance, as in a plastic body with metal parts
///   angiogram    0.02 to 4 % of the values are bright (in the upper seven tenths of the range from b to the 99.99 percentile), and the
///                foreground is rough: the mean second difference of neighbors is at least 0.6 times the mean first difference
///   MR           in patient space, and as rough
///   two phases   noisy: the foreground's roughness is 1.2 or more (white noise 1.7), but values two voxels apart have a correlation of 0.3
///                or more, and Otsu's threshold explains at least 70 % of the variance, as in micro-CT of a porous or a composite material
///   simulation   everything else: smooth, dense values of a quantity
#pragma once
#include <string>
#include <string_view>

#include "engine/field/grid/grid.h"
#include "engine/io/volume/units.h"

namespace catena::scene {

/// Kind of data in a scalar grid; the rules are at the top of this file.
enum class DataKind { level_set, ct, label_map, statistic, solid, decades, inclusions, angiogram, mr, cloud, two_phases, simulation };

/// Metadata and statistics from which the kind is derived.
struct ScalarStats {
  // From the file.
  bool is_level_set = false, is_hounsfield = false, is_patient_space = false, has_mask = false, is_label_map = false;
  // Statistics of the values. Shares are fractions from 0 to 1.
  double lo = 0, hi = 0;                 ///< 0.1 and 99.9 percentile
  double mean = 0;                       ///< Mean of the values, each clamped to lo..hi
  double background = 0;                 ///< Background b, see the top of this file
  double threshold = 0;                  ///< Threshold between background and foreground by N. Otsu, IEEE Trans. SMC 9(1), 1979
  bool is_integral = false;              ///< All values are integers
  int distinct_values = 0;               ///< Number of different values, counted up to 2049
  double background_share = 0;           ///< Share of the values within 2 % of the range of b
  double empty_share = 0;                ///< Share of the values equal to the lowest one
  double air_share = 0, soft_share = 0;  ///< Share of the values from -1100 to -850; from -150 to 200
  double plateau_share = 0;              ///< Share of the values in the lowest or highest tenth; 0 if either holds less than 2 %
  double bright_share = 0;               ///< Share of the values in the upper seven tenths from b to the 99.99 percentile
  double min_value = 0;                  ///< Lowest of all samples
  double negative_share = 0;             ///< Share of the values below 0 among the values other than 0
  double strong_magnitude = 0;           ///< 95 percentile of the magnitudes of the values other than 0
  double low = 0, median = 0, high = 0;  ///< 16, 50 and 84 percentile
  double brightest = 0;                  ///< 99.99 percentile
  double separation = 0;                 ///< Variance between the two classes of Otsu's threshold / variance of all values
  double body_threshold = 0;             ///< Otsu's threshold among the values that are not bright
  double body_separation = 0;            ///< Separation of that threshold
  // Statistics of neighboring voxels.
  double equal_share = 0;     ///< Share of equal pairs among the pairs in the foreground, along the axis with the least
  double region_share = 0;    ///< Share of equal foreground pairs among the pairs with at least one voxel in the foreground
  double roughness = 0;       ///< Foreground: mean |second difference| / mean |first difference|; white noise: 1.7
  double correlation = 0;     ///< Correlation of values two voxels apart along x; white noise: 0
  double distance_share = 0;  ///< Share of the points with a gradient at which its magnitude is 0.95 to 1.05
};

/// Samples the grid. A grid without any finite value gives only the flags from the file.
ScalarStats compute_scalar_stats(const field::ScalarGrid& grid, const field::Units& units);
/// Returns the kind by the first rule that holds.
DataKind classify_scalar(const ScalarStats& facts);

/// Returns the kind with its article: "a CT", "a label map", ...
std::string_view to_string(DataKind kind);
/// Returns the reason for the kind, for messages: "31 % of the values are air near -1000".
std::string explain_kind(DataKind kind, const ScalarStats& facts);

}  // namespace catena::scene
