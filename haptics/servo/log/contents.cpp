// SPDX-License-Identifier: MIT
#include "haptics/servo/log/contents.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "engine/base/hash.h"
#include "engine/field/bricks/paged_grid.h"
#include "haptics/servo/log/format.h"

namespace catena::haptics::log {

// If an assertion fails, one of these structs has changed: write and read the new fields, describe them in format.h and raise kVersion.
static_assert(sizeof(DeviceLimits) == 88 && sizeof(Coupling) == 56);

namespace {

// Calls `each` for the numbers in the order of the format; used for both directions.
template <class P, class F>
void each_number(P& p, const F& each) {
  for (auto* v : {&p.limits.max_stiffness_n_per_m, &p.limits.max_rotational_stiffness_nm_per_rad, &p.limits.max_force_n,
                  &p.limits.max_torque_nm, &p.limits.slew_n_per_s, &p.limits.ramp_in_s, &p.limits.ramp_out_s, &p.limits.damping_ns_per_m,
                  &p.limits.delay_s, &p.limits.max_added_damping_ns_per_m})
    each(*v);
  each(p.limits.max_late_ticks);
  each(p.limits.passivity_control);
  for (auto* v : {&p.coupling.stiffness_n_per_m, &p.coupling.damping_ns_per_m, &p.coupling.max_force_n, &p.coupling.ramp_s,
                  &p.coupling.rotational_stiffness_nm_per_rad, &p.coupling.rotational_damping_nms_per_rad})
    each(*v);
  each(p.coupling.method);
  each(p.meters_per_unit);
  for (int a = 0; a < 3; ++a) each(p.workspace_origin[a]);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) each(p.workspace_rotation[c][r]);
}

template <class W, class F>
void each_pose_number(W& w, const F& each) {
  for (auto& point : w.pose.points)
    for (int a = 0; a < 3; ++a) each(point[a]);
  for (auto* v : {&w.pose.orientation.w, &w.pose.orientation.x, &w.pose.orientation.y, &w.pose.orientation.z, &w.value}) each(*v);
}

struct PutNumber {
  ByteWriter& out;
  void operator()(const double& v) const { out.put(v); }
  void operator()(const int& v) const { out.put(static_cast<std::int32_t>(v)); }
  void operator()(const bool& v) const { out.put(static_cast<std::uint8_t>(v)); }
  void operator()(const CouplingMethod& v) const { out.put(static_cast<std::uint8_t>(v)); }
};

struct GetNumber {
  ByteReader& in;
  bool& good;
  void operator()(double& v) const { v = in.get<double>(); }
  void operator()(int& v) const { v = in.get<std::int32_t>(); }
  void operator()(bool& v) const {
    const auto byte = in.get<std::uint8_t>();
    good = good && byte <= 1;
    v = byte == 1;
  }
  void operator()(CouplingMethod& v) const {
    const auto byte = in.get<std::uint8_t>();
    good = good && byte <= static_cast<std::uint8_t>(CouplingMethod::linear);
    v = static_cast<CouplingMethod>(byte);
  }
};

/// Hash of the record layouts that must agree for the bytes of a state to have the same meaning.
std::uint64_t state_layout() {
  Fnv1a layout;
  for (const std::size_t size : {sizeof(ChainState), sizeof(LinkState), sizeof(Ramp), sizeof(UnaccountedEnergy), sizeof(PassivityState),
                                 sizeof(AlignmentState), sizeof(SingleProxyState), std::size_t{kMaxLinks}})
    layout.add(static_cast<std::uint64_t>(size));
  layout.add_bytes(__VERSION__, sizeof __VERSION__);
  return layout.value;
}

}  // namespace

std::vector<std::string> LogProgram::link_names() const {
  std::vector<std::string> names;
  for (const Link& link : links) names.push_back(link.name);
  return names;
}

std::vector<std::string> LogProgram::widget_names() const {
  std::vector<std::string> names;
  for (const Widget& widget : widgets) names.push_back(widget.name);
  return names;
}

std::string LogGap::description() const {
  const std::string which =
      ticks == 1 ? fmt::format("tick {} is", first_tick) : fmt::format("ticks {} to {} are", first_tick, first_tick + ticks - 1);
  return which + (cause == Cause::damaged ? " lost: the log is damaged at this point" : " lost: the disk was too slow");
}

LogProgram to_log_program(const HapticProgram& program, std::optional<std::string> scene_text) {
  LogProgram out;
  out.epoch = program.epoch;
  out.scene_text = std::move(scene_text);
  out.limits = program.limits;
  out.coupling = program.coupling;
  out.meters_per_unit = program.meters_per_unit;
  out.workspace_origin = program.workspace_origin;
  out.workspace_rotation = program.workspace_rotation;
  for (const haptics::Link& link : program.links) out.links.push_back({link.name, link.spec_hash});
  for (const Mode& mode : program.modes) out.modes.push_back(mode.name);
  for (std::size_t i = 0; i < program.widgets.size(); ++i) {
    const widget::Spec& spec = program.widgets[i];
    out.widgets.push_back({program.widget_names[i], spec.revision, spec.pose, spec.value});
  }
  for (const auto& grid : program.paged_grids) out.paged_grids.push_back(grid->version());
  return out;
}

std::string to_bytes(const LogHeader& h) {
  ByteWriter out;
  for (const std::string* text : {&h.scene_path, &h.working_folder, &h.scene_text}) out.put_string(*text);
  out.put(static_cast<std::uint32_t>(h.fields.size()));
  for (const std::string& field : h.fields) out.put_string(field);
  out.put_string(h.device);
  out.put_string(h.catena_version);
  out.put(h.rate_hz);
  out.put(h.started_unix_ns);
  if (!h.about.empty() || !h.plugins.empty()) out.put_string(h.about);
  if (!h.plugins.empty()) out.put(static_cast<std::uint32_t>(h.plugins.size()));
  for (const LogPlugin& plugin : h.plugins) {
    out.put_string(plugin.file);
    out.put(plugin.hash);
    out.put(static_cast<std::uint32_t>(plugin.types.size()));
    for (const std::string& type : plugin.types) out.put_string(type);
  }
  return std::move(out.bytes());
}

std::optional<LogHeader> parse_header(std::string_view bytes) {
  ByteReader in(bytes);
  LogHeader h;
  for (std::string* text : {&h.scene_path, &h.working_folder, &h.scene_text}) *text = in.get_string();
  const auto fields = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < fields && in.is_ok(); ++i) h.fields.push_back(in.get_string());
  h.device = in.get_string();
  h.catena_version = in.get_string();
  h.rate_hz = in.get<double>();
  h.started_unix_ns = in.get<std::int64_t>();
  if (!in.at_end()) h.about = in.get_string();
  const auto plugins = in.at_end() ? 0 : in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < plugins && in.is_ok(); ++i) {
    LogPlugin& plugin = h.plugins.emplace_back();
    plugin.file = in.get_string();
    plugin.hash = in.get<std::uint64_t>();
    const auto types = in.get<std::uint32_t>();
    for (std::uint32_t k = 0; k < types && in.is_ok(); ++k) plugin.types.push_back(in.get_string());
  }
  if (!in.at_end()) return std::nullopt;
  return h;
}

std::string to_bytes(const LogProgram& p) {
  ByteWriter out;
  out.put(p.epoch);
  out.put(p.first_tick);
  out.put(static_cast<std::uint8_t>(p.is_known));
  out.put(static_cast<std::uint8_t>(p.scene_text.has_value()));
  out.put_string(p.scene_text.value_or(std::string()));
  each_number(p, PutNumber{out});
  out.put(static_cast<std::uint32_t>(p.links.size()));
  for (const LogProgram::Link& link : p.links) {
    out.put_string(link.name);
    out.put(link.spec_hash);
  }
  out.put(static_cast<std::uint32_t>(p.modes.size()));
  for (const std::string& mode : p.modes) out.put_string(mode);
  out.put(static_cast<std::uint32_t>(p.widgets.size()));
  for (const LogProgram::Widget& w : p.widgets) {
    out.put_string(w.name);
    out.put(w.revision);
    each_pose_number(w, PutNumber{out});
  }
  return std::move(out.bytes());
}

std::optional<LogProgram> parse_program(std::string_view bytes) {
  ByteReader in(bytes);
  LogProgram p;
  p.epoch = in.get<std::uint64_t>();
  p.first_tick = in.get<std::uint64_t>();
  const auto known = in.get<std::uint8_t>(), own_text = in.get<std::uint8_t>();
  bool good = known <= 1 && own_text <= 1;
  p.is_known = known == 1;
  std::string text = in.get_string();
  if (own_text == 1) p.scene_text = std::move(text);
  each_number(p, GetNumber{in, good});
  const auto links = in.get<std::uint32_t>();
  good = good && links <= kMaxLinks;
  for (std::uint32_t i = 0; i < links && good && in.is_ok(); ++i) {
    std::string name = in.get_string();
    p.links.push_back({std::move(name), in.get<std::uint64_t>()});
  }
  const auto modes = in.get<std::uint32_t>();
  good = good && modes <= kMaxModes;
  for (std::uint32_t i = 0; i < modes && good && in.is_ok(); ++i) p.modes.push_back(in.get_string());
  const auto widgets = in.get<std::uint32_t>();
  good = good && widgets <= kMaxWidgets;
  for (std::uint32_t i = 0; i < widgets && good && in.is_ok(); ++i) {
    LogProgram::Widget w;
    w.name = in.get_string();
    w.revision = in.get<std::uint32_t>();
    each_pose_number(w, GetNumber{in, good});
    p.widgets.push_back(std::move(w));
  }
  if (!good || !in.at_end()) return std::nullopt;
  return p;
}

std::string to_bytes(const ChainState& state) {
  ByteWriter out;
  out.put(state.ticks);
  out.put(state_layout());
  out.put_bytes(&state, sizeof state);
  return std::move(out.bytes());
}

std::optional<LogState> parse_state(std::string_view bytes) {
  ByteReader in(bytes);
  LogState out;
  out.tick = in.get<std::uint64_t>();
  const bool own = in.get<std::uint64_t>() == state_layout();
  if (!in.is_ok() || out.tick == 0 || out.tick == ~std::uint64_t{0}) return std::nullopt;
  if (!own) return out;
  const char* from = in.read_bytes(sizeof(ChainState));
  if (from == nullptr || !in.at_end()) return std::nullopt;
  out.chain.emplace();
  std::memcpy(&*out.chain, from, sizeof(ChainState));
  if (out.chain->ticks != out.tick) return std::nullopt;
  return out;
}

std::string to_bytes(const LogGap& gap) {
  ByteWriter out;
  out.put(gap.first_tick);
  out.put(gap.ticks);
  return std::move(out.bytes());
}

std::optional<LogGap> parse_gap(std::string_view bytes) {
  ByteReader in(bytes);
  LogGap gap;
  gap.first_tick = in.get<std::uint64_t>();
  gap.ticks = in.get<std::uint64_t>();
  if (!in.at_end() || gap.ticks == 0) return std::nullopt;
  return gap;
}

std::string to_bytes(const LogBricks& bricks) {
  ByteWriter out;
  out.put(bricks.first_tick);
  for (const std::vector<LogBrick>* list : {&bricks.left, &bricks.added}) {
    out.put(static_cast<std::uint32_t>(list->size()));
    for (const LogBrick& brick : *list) {
      out.put(brick.grid);
      out.put(brick.number);
    }
  }
  return std::move(out.bytes());
}

std::optional<LogBricks> parse_bricks(std::string_view bytes) {
  ByteReader in(bytes);
  LogBricks out;
  out.first_tick = in.get<std::uint64_t>();
  for (std::vector<LogBrick>* list : {&out.left, &out.added}) {
    const auto count = in.get<std::uint32_t>();
    for (std::uint32_t i = 0; i < count && in.is_ok(); ++i) {
      const auto grid = in.get<std::uint32_t>();
      list->push_back({grid, in.get<std::uint64_t>()});
    }
    if (!std::ranges::is_sorted(*list)) return std::nullopt;
  }
  if (!in.at_end()) return std::nullopt;
  return out;
}

std::string to_bytes(const LogEnd& end) {
  ByteWriter out;
  for (const std::uint64_t v : {end.ticks, end.lost, end.last_tick, end.state_hash}) out.put(v);
  return std::move(out.bytes());
}

std::optional<LogEnd> parse_end(std::string_view bytes) {
  ByteReader in(bytes);
  LogEnd end;
  for (std::uint64_t* v : {&end.ticks, &end.lost, &end.last_tick, &end.state_hash}) *v = in.get<std::uint64_t>();
  if (!in.at_end()) return std::nullopt;
  return end;
}

}  // namespace catena::haptics::log
