// SPDX-License-Identifier: MIT
#include "engine/app/haptics/tick_csv.h"

#include <fmt/core.h>
#include <algorithm>

#include "engine/base/numbers.h"

namespace catena::app {

void LinkColumns::add(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.push_back(name);
}

void LinkColumns::bind(const std::vector<std::string>& links) {
  column_links_.assign(names_.size(), -1);
  for (std::size_t c = 0; c < names_.size(); ++c)
    if (const auto found = std::find(links.begin(), links.end(), names_[c]); found != links.end())
      column_links_[c] = static_cast<int>(found - links.begin());
}

std::vector<std::string> link_names(const haptics::HapticProgram& program) {
  std::vector<std::string> names;
  for (const haptics::Link& link : program.links) names.push_back(link.name);
  return names;
}

std::vector<std::string> mode_names(const haptics::HapticProgram& program) {
  std::vector<std::string> names;
  for (const haptics::Mode& mode : program.modes) names.push_back(mode.name);
  return names;
}

void append_vector(std::string& line, const Vec3& v) {
  for (int a = 0; a < 3; ++a) {
    line += ',';
    append_number(line, v[a]);
  }
}

std::string tick_header(const LinkColumns& columns, bool turns) {
  std::string line = "t,probe_x,probe_y,probe_z";
  for (const std::string& name : columns.names()) {
    line += fmt::format(",{0}_x,{0}_y,{0}_z,{0}_active,{0}_status,{0}_evaluations,{0}_reason", name);
    if (turns) line += fmt::format(",{0}_qw,{0}_qx,{0}_qy,{0}_qz", name);
  }
  line += turns ? ",force_x,force_y,force_z,torque_x,torque_y,torque_z" : ",force_x,force_y,force_z";
  for (const std::string& name : columns.names()) line += fmt::format(",{}_curve", name);
  return line + "\n";
}

void append_tick(std::string& line, const LinkColumns& columns, const HapticState& state, bool turns) {
  append_number(line, state.t_s);
  append_vector(line, state.probe);
  for (std::size_t c = 0; c < columns.names().size(); ++c) {
    if (columns.link_at(c) < 0) {
      line += turns ? ",,,,,,,,,,," : ",,,,,,,";
      continue;
    }
    const LinkReport& link = state.links[static_cast<std::size_t>(columns.link_at(c))];
    append_vector(line, link.proxy);
    line += link.active ? ",1," : ",0,";
    line += to_string(link.status);
    line += ',';
    line += std::to_string(link.evaluations);
    line += ',';
    line += to_string(link.sample_status);
    if (!turns) continue;
    for (const double part : {link.orientation.w, link.orientation.x, link.orientation.y, link.orientation.z}) {
      line += ',';
      append_number(line, part);
    }
  }
  append_vector(line, state.force_n);
  if (turns) append_vector(line, state.torque_nm);
  for (std::size_t c = 0; c < columns.names().size(); ++c) {
    line += ',';
    if (columns.link_at(c) < 0) continue;
    const std::int32_t curve = state.links[static_cast<std::size_t>(columns.link_at(c))].curve;
    if (curve != kUnknownCurve) line += std::to_string(curve);
  }
  line += '\n';
}

std::string details_header(const LinkColumns& columns) {
  std::string line = "t,mode,left_out";
  for (const std::string& name : columns.names())
    line += fmt::format(
        ",{0}_gap,{0}_release_ratio,{0}_released,{0}_residual,{0}_stiffness,{0}_weight,{0}_force_x,{0}_force_y,{0}_force_z,{0}_energy,{0}_"
        "accounted",
        name);
  return line;
}

void append_details(std::string& line, const LinkColumns& columns, const std::vector<std::string>& modes, double metres_per_unit,
                    const HapticState& state) {
  append_number(line, state.t_s);
  line += ',';
  const auto mode = static_cast<std::size_t>(state.mode);
  if (state.mode >= 0) line += mode < modes.size() ? modes[mode] : fmt::format("mode_{}", mode + 1);
  line += ',';
  append_number(line, state.omitted_work_j);
  for (std::size_t c = 0; c < columns.names().size(); ++c) {
    if (columns.link_at(c) < 0) {
      line += ",,,,,,,,,,,";
      continue;
    }
    const LinkReport& link = state.links[static_cast<std::size_t>(columns.link_at(c))];
    const auto number = [&](double value) {
      line += ',';
      append_number(line, value);
    };
    number(link.gap);
    number(link.release_ratio);
    line += link.released ? ",1" : ",0";
    number(link.residual);
    number(link.stiffness_n_per_m);
    number(link.weight);
    append_vector(line, link.force_n);
    number(link.energy_j(metres_per_unit));
    number(link.accounted_j);
  }
}

namespace {

bool has_two_points(widget::Kind kind) { return kind == widget::Kind::rake || kind == widget::Kind::box || kind == widget::Kind::ruler; }

template <class F>
void each_use(const haptics::HapticProgram& program, const std::array<std::array<std::uint64_t, 7>, kMaxWidgets>& ticks, const F& f) {
  for (std::size_t i = 0; i < program.widget_names.size(); ++i) {
    std::string modes;
    for (std::size_t m = 0; m < ticks[i].size(); ++m)
      if (ticks[i][m] > 0) modes += f.mode(to_string(static_cast<WidgetMode>(m)), ticks[i][m], modes.empty());
    f.widget(i, modes);
  }
}

}  // namespace

std::string widget_header(const haptics::HapticProgram& program) {
  std::string line = "t";
  for (std::size_t i = 0; i < program.widgets.size(); ++i) {
    const widget::Kind kind = program.widgets[i].kind;
    line += fmt::format(",{0}_mode,{0}_handle,{0}_held,{0}_x,{0}_y,{0}_z", program.widget_names[i]);
    if (has_two_points(kind)) line += fmt::format(",{0}_x2,{0}_y2,{0}_z2", program.widget_names[i]);
    if (kind == widget::Kind::cutting_plane)
      line += fmt::format(",{0}_qw,{0}_qx,{0}_qy,{0}_qz,{0}_nx,{0}_ny,{0}_nz", program.widget_names[i]);
    if (kind == widget::Kind::isolevel) line += fmt::format(",{0}_value", program.widget_names[i]);
  }
  return line + "\n";
}

void append_widgets(std::string& line, const haptics::HapticProgram& program, const HapticState& state) {
  append_number(line, state.t_s);
  for (std::size_t i = 0; i < program.widgets.size(); ++i) {
    const widget::Kind kind = program.widgets[i].kind;
    const WidgetReport& w = state.widgets[i];
    line += fmt::format(",{},{},{}", to_string(w.mode), static_cast<int>(w.handle), static_cast<int>(w.active_planes));
    append_vector(line, w.pose.points[0]);
    if (has_two_points(kind)) append_vector(line, w.pose.points[1]);
    if (kind == widget::Kind::cutting_plane) {
      const Quat& q = w.pose.orientation;
      for (const double part : {q.w, q.x, q.y, q.z}) {
        line += ',';
        append_number(line, part);
      }
      append_vector(line, rotate(q, {0.0, 0.0, 1.0}));
    }
    if (kind == widget::Kind::isolevel) {
      line += ',';
      append_number(line, w.value);
    }
  }
  line += '\n';
}

void WidgetUsage::add(const HapticState& state) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(state.widget_count); ++i) {
    ++ticks_[i][static_cast<std::size_t>(state.widgets[i].mode)];
    last_positions_[i] = state.widgets[i].pose.points[0];
  }
}

std::string WidgetUsage::to_json(const haptics::HapticProgram& program) const {
  struct Writer {
    const haptics::HapticProgram& program;
    const std::array<Vec3, kMaxWidgets>& at;
    std::string& out;
    std::string mode(const char* word, std::uint64_t n, bool first) const {
      return fmt::format("{}\"{}\": {}", first ? "" : ", ", word, n);
    }
    void widget(std::size_t i, const std::string& modes) const {
      out += fmt::format("{}\n    \"{}\": {{\"ticks\": {{{}}}, \"position\": [{}, {}, {}]}}", out.empty() ? "" : ",",
                         program.widget_names[i], modes, to_text(at[i].x), to_text(at[i].y), to_text(at[i].z));
    }
  };
  std::string out;
  each_use(program, ticks_, Writer{program, last_positions_, out});
  return out.empty() ? out : "\"widgets\": {" + out + "}";
}

std::string WidgetUsage::report(const haptics::HapticProgram& program) const {
  struct Writer {
    const haptics::HapticProgram& program;
    const std::array<Vec3, kMaxWidgets>& at;
    std::string& out;
    std::string mode(const char* word, std::uint64_t n, bool) const { return fmt::format(" {} {}", word, n); }
    void widget(std::size_t i, const std::string& modes) const {
      out += fmt::format("  {}:{}; at {:.4g} {:.4g} {:.4g}\n", program.widget_names[i], modes, at[i].x, at[i].y, at[i].z);
    }
  };
  std::string out;
  each_use(program, ticks_, Writer{program, last_positions_, out});
  return out;
}

}  // namespace catena::app
