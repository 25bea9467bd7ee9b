#include "engine/app/tick_csv.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/numbers.h"

namespace catena::app {

void LinkColumns::add(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.push_back(name);
}

void LinkColumns::bind(const std::vector<std::string>& links) {
  link_of_.assign(names_.size(), -1);
  for (std::size_t c = 0; c < names_.size(); ++c)
    if (const auto found = std::find(links.begin(), links.end(), names_[c]); found != links.end())
      link_of_[c] = static_cast<int>(found - links.begin());
}

std::vector<std::string> link_names(const haptics::Program& program) {
  std::vector<std::string> names;
  for (const haptics::Link& link : program.links) names.push_back(link.name);
  return names;
}

std::vector<std::string> mode_names(const haptics::Program& program) {
  std::vector<std::string> names;
  for (const haptics::Mode& mode : program.modes) names.push_back(mode.name);
  return names;
}

void append_vector(std::string& line, const Vec3& v) {
  for (int a = 0; a < 3; ++a) {
    line += ',';
    append_text(line, v[a]);
  }
}

std::string tick_header(const LinkColumns& columns, bool turns) {
  std::string line = "t,probe_x,probe_y,probe_z";
  for (const std::string& name : columns.names()) {
    line += fmt::format(",{0}_x,{0}_y,{0}_z,{0}_active,{0}_status,{0}_evaluations,{0}_reason", name);
    if (turns) line += fmt::format(",{0}_qw,{0}_qx,{0}_qy,{0}_qz", name);
  }
  return line + ",force_x,force_y,force_z" + (turns ? ",torque_x,torque_y,torque_z\n" : "\n");
}

void append_tick(std::string& line, const LinkColumns& columns, const exchange::HapticState& state, bool turns) {
  append_text(line, state.t_s);
  append_vector(line, state.probe);
  for (std::size_t c = 0; c < columns.names().size(); ++c) {
    if (columns.link(c) < 0) {
      line += turns ? ",,,,,,,,,,," : ",,,,,,,";
      continue;
    }
    const exchange::LinkReport& link = state.links[static_cast<std::size_t>(columns.link(c))];
    append_vector(line, link.proxy);
    line += link.active ? ",1," : ",0,";
    line += exchange::status_word(link.status);
    line += ',';
    line += std::to_string(link.evaluations);
    line += ',';
    line += reason_word(link.reason);
    if (!turns) continue;
    for (const double part : {link.orientation.w, link.orientation.x, link.orientation.y, link.orientation.z}) {
      line += ',';
      append_text(line, part);
    }
  }
  append_vector(line, state.force_n);
  if (turns) append_vector(line, state.torque_nm);
  line += '\n';
}

std::string details_header(const LinkColumns& columns) {
  std::string line = "t,mode";
  for (const std::string& name : columns.names())
    line += fmt::format(
        ",{0}_gap,{0}_leaving,{0}_left,{0}_residual,{0}_stiffness,{0}_weight,{0}_force_x,{0}_force_y,{0}_force_z,{0}_energy,{0}_booked",
        name);
  return line;
}

void append_details(std::string& line, const LinkColumns& columns, const std::vector<std::string>& modes, double metres_per_unit,
                    const exchange::HapticState& state) {
  append_text(line, state.t_s);
  line += ',';
  const auto mode = static_cast<std::size_t>(state.mode);
  if (state.mode >= 0) line += mode < modes.size() ? modes[mode] : fmt::format("mode_{}", mode + 1);
  for (std::size_t c = 0; c < columns.names().size(); ++c) {
    if (columns.link(c) < 0) {
      line += ",,,,,,,,,,,";
      continue;
    }
    const exchange::LinkReport& link = state.links[static_cast<std::size_t>(columns.link(c))];
    const auto number = [&](double value) {
      line += ',';
      append_text(line, value);
    };
    number(link.gap);
    number(link.leaving);
    line += link.left ? ",1" : ",0";
    number(link.residual);
    number(link.stiffness_n_per_m);
    number(link.weight);
    append_vector(line, link.force_n);
    number(link.energy_j(metres_per_unit));
    number(link.booked_j);
  }
}

}  // namespace catena::app
