/// What kind of data a scalar grid holds, from what its file says and what its values look like, so that a file without a scene is shown as
/// a specialist would show it. Off the tick, any thread; the same grid always gives the same answer.
///
/// TrialResult on at most about a million voxels in blocks of 8^3 that are spread over the box, those of invalid cells and those beyond
/// the display range (engine/field/field_display_range.h) left out. The background b is the fullest of 256 bins over the values if it holds
/// over 5 % of them and lies in the lowest fifth of the range, else the lowest value; the foreground is what is 2 % of the range or more
/// away from it. What the file says is a label map and holds whole numbers is one. Else the order is that of the rules, and the first that
/// holds is the kind:
///   level set    the file says so; or values of both signs, and in 90 % of the places the gradient is 0.95 to 1.05 long (world units)
///   CT           the unit is HU; or no value is below -5000, and 5 % of the values lie from -1100 to -850 (air) and 5 % from -150 to 200
///                (soft tissue), in Hounsfield units
///   label map    whole numbers, 2 to 2048 different ones, and 60 % of all neighbours in the foreground are equal, along every axis
///   solid        90 % of the values are in the lowest or the highest tenth of the range, 2 % at least in either; or 60 % of all
///                neighbours in the foreground are equal
///   cloud        of no patient (engine/io/volume/units.h), without a mask and without values below 0; 60 % are exactly the lowest value
///   angiogram    0.02 to 4 % of the values are bright (in the upper seven tenths of the way from b to the 99.99 percentile), and the
///                foreground is rough: second differences of neighbours are 0.6 times the first ones or more, on average
///   MR           of a patient, and as rough
///   simulation   what is left: smooth, dense values that mean a quantity everywhere
#pragma once
#include <string>
#include <string_view>

#include "engine/field/grid/grid.h"
#include "engine/io/volume/units.h"

namespace catena::scene {

enum class DataKind { level_set, ct, label_map, solid, angiogram, mr, cloud, simulation };

struct ScalarStats {
  // what the file says
  bool is_level_set = false, is_hounsfield = false, is_patient_space = false, has_mask = false, is_label_map = false;
  // the values
  double lo = 0, hi = 0;                 ///< the 0.1 and the 99.9 percentile
  double mean = 0;                       ///< of the values, those outside lo..hi taken for its ends
  double background = 0;                 ///< b
  double threshold = 0;                  ///< between background and foreground, by N. Otsu, IEEE Trans. SMC 9(1), 1979
  bool is_integral = false;              ///< all
  int distinct_values = 0;               ///< different values, counted up to 2049
  double background_share = 0;           ///< of the values: within 2 % of the range from b
  double empty_share = 0;                ///< of the values: exactly the lowest value
  double air_share = 0, soft_share = 0;  ///< of the values: between -1100 and -850, between -150 and 200
  double plateau_share = 0;              ///< of the values: in the lowest or the highest tenth; 0 where either holds less than 2 %
  double bright_share = 0;               ///< of the values: in the upper seven tenths
  double min_value = 0;                  ///< the lowest value of all samples
  // neighbours
  double equal_share = 0;     ///< of neighbours in the foreground, along the axis where it is least
  double region_share = 0;    ///< of neighbours of which one at least is in the foreground: as large as regions hang together
  double roughness = 0;       ///< of the foreground: mean |second difference| by mean |first difference|; white noise: 1.7
  double distance_share = 0;  ///< of the places that are not flat: those whose gradient is about 1 long
};

ScalarStats compute_scalar_stats(const field::ScalarGrid& grid, const field::Units& units);
DataKind classify_scalar(const ScalarStats& facts);

/// "a CT", "a label map", ...
std::string_view to_string(DataKind kind);
/// What made it that kind: "31 % of the values are air near -1000".
std::string explain_kind(DataKind kind, const ScalarStats& facts);

}  // namespace catena::scene
