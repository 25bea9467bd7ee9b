/// The tick CSV and its details: one place for `replay` and `export`. NumberArray read back exactly.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "engine/base/haptic_state.h"
#include "haptics/chain/program.h"

namespace catena::app {

/// Which link stands in which columns. A recording may go on with a program of other links: those that it lacks are empty cells.
class LinkColumns {
 public:
  LinkColumns() = default;
  explicit LinkColumns(std::vector<std::string> names) : names_(std::move(names)) { bind(names_); }
  void add(const std::vector<std::string>& names);   ///< columns for links that have none yet
  void bind(const std::vector<std::string>& links);  ///< the links of the states that follow
  const std::vector<std::string>& names() const { return names_; }
  int link_at(std::size_t column) const { return column_links_[column]; }  ///< -1: none

 private:
  std::vector<std::string> names_;
  std::vector<int> column_links_;
};

std::vector<std::string> link_names(const haptics::HapticProgram& program);
std::vector<std::string> mode_names(const haptics::HapticProgram& program);

void append_vector(std::string& line, const Vec3& v);  ///< ",x,y,z"

/// t, the probe, every link's proxy, active, status, evaluations, reason, then the force, then every link's curve. Lines end with '\n'.
/// `turns`: the hand has an orientation, and so have the ticks: every link's as a quaternion, and the torque.
std::string tick_header(const LinkColumns& columns, bool turns = false);
void append_tick(std::string& line, const LinkColumns& columns, const HapticState& state, bool turns = false);

/// What every link tells beside its proxy: how far the hand is from leaving its feature, its share, its work. No line ends.
std::string details_header(const LinkColumns& columns);
void append_details(std::string& line, const LinkColumns& columns, const std::vector<std::string>& modes, double metres_per_unit,
                    const HapticState& state);

/// The widget CSV of `replay --widgets`: a row a tick, `t`, then for every widget
///   NAME_mode     away explore translate rotate turn hover drag
///   NAME_handle   -1: none; rake, ruler: 0, 1 its ends, 2 the whole; box: 0..5 faces -x +x -y +y -z +z, 6 the whole
///   NAME_held     bit i: the plane across the widget's axis i is active
///   NAME_x,y,z    points[0]: the centre, the place, the first end, the least corner
///   NAME_x2,y2,z2                            rake, box, ruler: the second end, the greatest corner
///   NAME_qw,qx,qy,qz, NAME_nx,ny,nz          cutting plane: its orientation and its normal
///   NAME_value                               isolevel: the field at the handle
/// World units; numbers read back exactly.
std::string widget_header(const haptics::HapticProgram& program);
void append_widgets(std::string& line, const haptics::HapticProgram& program, const HapticState& state);

/// How many ticks every widget spent in every mode, and where it is at the end.
class WidgetUsage {
 public:
  void add(const HapticState& state);
  /// "widgets": {NAME: {"ticks": {MODE: n, ..}, "position": [x, y, z]}, ..}; no widgets: empty.
  std::string to_json(const haptics::HapticProgram& program) const;
  /// A line a widget, for a person.
  std::string report(const haptics::HapticProgram& program) const;

 private:
  std::array<std::array<std::uint64_t, 7>, kMaxWidgets> ticks_{};
  std::array<Vec3, kMaxWidgets> last_positions_{};
};

}  // namespace catena::app
