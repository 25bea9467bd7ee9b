#include "engine/app/widget_csv.h"

#include <fmt/core.h>

#include "engine/app/tick_csv.h"
#include "engine/base/numbers.h"

namespace catena::app {

namespace {

using widget::Kind;

bool has_two_points(Kind kind) { return kind == Kind::rake || kind == Kind::box || kind == Kind::ruler; }

template <class F>
void each_use(const haptics::Program& program, const std::array<std::array<std::uint64_t, 7>, exchange::kMaxWidgets>& ticks, const F& f) {
  for (std::size_t i = 0; i < program.widget_names.size(); ++i) {
    std::string modes;
    for (std::size_t m = 0; m < ticks[i].size(); ++m)
      if (ticks[i][m] > 0) modes += f.mode(exchange::mode_word(static_cast<exchange::WidgetMode>(m)), ticks[i][m], modes.empty());
    f.widget(i, modes);
  }
}

}  // namespace

std::string widget_header(const haptics::Program& program) {
  std::string line = "t";
  for (std::size_t i = 0; i < program.widgets.size(); ++i) {
    const Kind kind = program.widgets[i].kind;
    line += fmt::format(",{0}_mode,{0}_handle,{0}_held,{0}_x,{0}_y,{0}_z", program.widget_names[i]);
    if (has_two_points(kind)) line += fmt::format(",{0}_x2,{0}_y2,{0}_z2", program.widget_names[i]);
    if (kind == Kind::cutting_plane) line += fmt::format(",{0}_qw,{0}_qx,{0}_qy,{0}_qz,{0}_nx,{0}_ny,{0}_nz", program.widget_names[i]);
    if (kind == Kind::isolevel) line += fmt::format(",{0}_value", program.widget_names[i]);
  }
  return line + "\n";
}

void append_widgets(std::string& line, const haptics::Program& program, const exchange::HapticState& state) {
  append_text(line, state.t_s);
  for (std::size_t i = 0; i < program.widgets.size(); ++i) {
    const Kind kind = program.widgets[i].kind;
    const exchange::WidgetReport& w = state.widgets[i];
    line += fmt::format(",{},{},{}", exchange::mode_word(w.mode), static_cast<int>(w.handle), static_cast<int>(w.held));
    append_vector(line, w.pose.points[0]);
    if (has_two_points(kind)) append_vector(line, w.pose.points[1]);
    if (kind == Kind::cutting_plane) {
      const Quat& q = w.pose.orientation;
      for (const double part : {q.w, q.x, q.y, q.z}) {
        line += ',';
        append_text(line, part);
      }
      append_vector(line, rotate(q, {0.0, 0.0, 1.0}));
    }
    if (kind == Kind::isolevel) {
      line += ',';
      append_text(line, w.value);
    }
  }
  line += '\n';
}

void WidgetUse::add(const exchange::HapticState& state) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(state.widget_count); ++i) {
    ++ticks_[i][static_cast<std::size_t>(state.widgets[i].mode)];
    at_[i] = state.widgets[i].pose.points[0];
  }
}

std::string WidgetUse::json(const haptics::Program& program) const {
  struct Writer {
    const haptics::Program& program;
    const std::array<Vec3, exchange::kMaxWidgets>& at;
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
  each_use(program, ticks_, Writer{program, at_, out});
  return out.empty() ? out : "\"widgets\": {" + out + "}";
}

std::string WidgetUse::text(const haptics::Program& program) const {
  struct Writer {
    const haptics::Program& program;
    const std::array<Vec3, exchange::kMaxWidgets>& at;
    std::string& out;
    std::string mode(const char* word, std::uint64_t n, bool) const { return fmt::format(" {} {}", word, n); }
    void widget(std::size_t i, const std::string& modes) const {
      out += fmt::format("  {}:{}; at {:.4g} {:.4g} {:.4g}\n", program.widget_names[i], modes, at[i].x, at[i].y, at[i].z);
    }
  };
  std::string out;
  each_use(program, ticks_, Writer{program, at_, out});
  return out;
}

}  // namespace catena::app
