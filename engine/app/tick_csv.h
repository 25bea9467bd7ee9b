/// The tick CSV and its details: one place for `replay` and `export`. Numbers read back exactly.
#pragma once
#include <string>
#include <vector>

#include "engine/exchange/haptic_state.h"
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
  int link(std::size_t column) const { return link_of_[column]; }  ///< -1: none

 private:
  std::vector<std::string> names_;
  std::vector<int> link_of_;
};

std::vector<std::string> link_names(const haptics::Program& program);
std::vector<std::string> mode_names(const haptics::Program& program);

void append_vector(std::string& line, const Vec3& v);  ///< ",x,y,z"

/// t, the probe, every link's proxy, active, status, evaluations, then the force. Lines end with '\n'.
/// `turns`: the hand has an orientation, and so have the ticks: every link's as a quaternion, and the torque.
std::string tick_header(const LinkColumns& columns, bool turns = false);
void append_tick(std::string& line, const LinkColumns& columns, const exchange::HapticState& state, bool turns = false);

/// What every link tells beside its proxy: how far the hand is from leaving its feature, its share, its work. No line ends.
std::string details_header(const LinkColumns& columns);
void append_details(std::string& line, const LinkColumns& columns, const std::vector<std::string>& modes, double metres_per_unit,
                    const exchange::HapticState& state);

}  // namespace catena::app
