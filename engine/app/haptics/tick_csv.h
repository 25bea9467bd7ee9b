// SPDX-License-Identifier: MIT
/// Writers of the tick CSV, the details CSV and the widget CSV, shared by `replay` and `export`. Numbers read back exactly.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "engine/base/haptic_state.h"
#include "haptics/chain/program.h"

namespace catena::app {

/// Assignment of links to columns. A recording may continue with a program that has other links; cells of links that it lacks are empty.
class LinkColumns {
 public:
  LinkColumns() = default;
  explicit LinkColumns(std::vector<std::string> names) : names_(std::move(names)) { bind(names_); }
  void add(const std::vector<std::string>& names);   ///< Adds columns for links that have none
  void bind(const std::vector<std::string>& links);  ///< Sets the links of the states that follow
  const std::vector<std::string>& names() const { return names_; }
  int link_at(std::size_t column) const { return column_links_[column]; }  ///< Index of the link in a column; -1: none

 private:
  std::vector<std::string> names_;
  std::vector<int> column_links_;
};

/// Names of the program's links, in their order.
std::vector<std::string> link_names(const haptics::HapticProgram& program);
/// Names of the program's modes, in their order.
std::vector<std::string> mode_names(const haptics::HapticProgram& program);

void append_vector(std::string& line, const Vec3& v);  ///< Appends ",x,y,z"

/// The header and one row of the tick CSV: t, the probe; for every link its proxy, active, status, evaluations, reason; then the force,
/// then every link's curve. Lines end with '\n'. `turns`: the device has an orientation: adds every link's orientation as a quaternion, and
/// the torque.
std::string tick_header(const LinkColumns& columns, bool turns = false);
void append_tick(std::string& line, const LinkColumns& columns, const HapticState& state, bool turns = false);

/// The header and one row of the details CSV: t, mode, left_out; for every link its gap, release ratio, whether it released, residual,
/// stiffness, weight, force contribution and work. No line ends. `modes`: names of the modes; `metres_per_unit`: device meters per world
/// unit.
std::string details_header(const LinkColumns& columns);
void append_details(std::string& line, const LinkColumns& columns, const std::vector<std::string>& modes, double metres_per_unit,
                    const HapticState& state);

/// The header and one row of the widget CSV of `replay --widgets`: one row per tick, `t`, then for every widget
///   NAME_mode     away explore translate rotate turn hover drag
///   NAME_handle   -1: none; rake, ruler: 0, 1 the ends, 2 the whole; box: 0..5 faces -x +x -y +y -z +z, 6 the whole
///   NAME_held     bit i: the plane perpendicular to the widget's axis i is active
///   NAME_x,y,z    points[0]: the center, the position, the first end, the minimum corner
///   NAME_x2,y2,z2                            rake, box, ruler: the second end, the maximum corner
///   NAME_qw,qx,qy,qz, NAME_nx,ny,nz          cutting plane: orientation and normal
///   NAME_value                               isolevel: the field's value at the handle
/// World units; numbers read back exactly.
std::string widget_header(const haptics::HapticProgram& program);
void append_widgets(std::string& line, const haptics::HapticProgram& program, const HapticState& state);

/// Counts the ticks of every widget in every mode, and stores its last position.
class WidgetUsage {
 public:
  /// Counts one tick.
  void add(const HapticState& state);
  /// The counts as a JSON member, "widgets": {NAME: {"ticks": {MODE: n, ..}, "position": [x, y, z]}, ..}; empty if there are no widgets.
  std::string to_json(const haptics::HapticProgram& program) const;
  /// A human-readable report, one line per widget.
  std::string report(const haptics::HapticProgram& program) const;

 private:
  std::array<std::array<std::uint64_t, 7>, kMaxWidgets> ticks_{};
  std::array<Vec3, kMaxWidgets> last_positions_{};
};

}  // namespace catena::app
