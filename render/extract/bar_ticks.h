/// Private to this room: nice values along a scalar bar and how they are written. Pure, any thread.
///   values   of engine/base/ticks.h, about `count` of them
///   texts    with the decimals that the step needs; where numbers are very large or small a common factor "x 10^n" is taken out.
///            A format of the user's ("%.2f") is taken as it is, without a factor.
#pragma once
#include <string>
#include <vector>

#include "render/frame/overlay_items.h"

namespace catena::render {

struct BarScale {
  std::vector<BarTick> ticks;
  std::string factor;
};
BarScale bar_scale(double lo, double hi, int count, const std::string& format);

}  // namespace catena::render
