/// The widget CSV of `replay --widgets`: a row a tick, `t`, then for every widget
///   NAME_mode     away explore translate rotate turn hover drag
///   NAME_handle   -1: none; rake, ruler: 0, 1 its ends, 2 the whole; box: 0..5 faces -x +x -y +y -z +z, 6 the whole
///   NAME_held     bit i: the plane across the widget's axis i is active
///   NAME_x,y,z    points[0]: the centre, the place, the first end, the least corner
///   NAME_x2,y2,z2                            rake, box, ruler: the second end, the greatest corner
///   NAME_qw,qx,qy,qz, NAME_nx,ny,nz          cutting plane: its orientation and its normal
///   NAME_value                               isolevel: the field at the handle
/// World units; numbers read back exactly.
#pragma once
#include <array>
#include <string>

#include "engine/exchange/haptic_state.h"
#include "haptics/chain/program.h"

namespace catena::app {

std::string widget_header(const haptics::Program& program);
void append_widgets(std::string& line, const haptics::Program& program, const exchange::HapticState& state);

/// How many ticks every widget spent in every mode, and where it is at the end.
class WidgetUse {
 public:
  void add(const exchange::HapticState& state);
  /// "widgets": {NAME: {"ticks": {MODE: n, ..}, "position": [x, y, z]}, ..}; no widgets: empty.
  std::string json(const haptics::Program& program) const;
  /// A line a widget, for a person.
  std::string text(const haptics::Program& program) const;

 private:
  std::array<std::array<std::uint64_t, 7>, exchange::kMaxWidgets> ticks_{};
  std::array<Vec3, exchange::kMaxWidgets> at_{};
};

}  // namespace catena::app
