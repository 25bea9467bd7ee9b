// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "engine/app/cli/command.h"
#include "engine/app/cli/json_writer.h"
#include "engine/app/tuning/predict/cost.h"
#include "engine/base/text.h"
#include "haptics/build/build_program.h"
#include "render/extract/extract.h"

namespace catena::app {
namespace {

constexpr std::uint32_t kWidth = 1024, kHeight = 768;

std::string bytes_text(const std::optional<double>& bytes) { return bytes ? format_bytes(*bytes) : "-"; }

std::string time_text(const std::optional<double>& ms) {
  if (!ms) return "-";
  return *ms >= 1 || *ms == 0 ? fmt::format("{:.1f} ms", *ms)
         : *ms >= 1e-3        ? fmt::format("{:.2f} us", 1e3 * *ms)
                              : fmt::format("{:.0f} ns", 1e6 * *ms);
}

void print_table(const CostTable& table, bool measure) {
  fmt::print("{:8}{:20}{:44}{:>12}{:>12}", "", "", "", "bytes", "expected");
  fmt::print("{}\n", measure ? fmt::format("{:>12}{:>12}", "bytes", "measured") : "");
  for (const CostRow& row : table) {
    fmt::print("{:8}{:20}{:44}{:>12}{:>12}", row.stage, sanitize_for_terminal(row.name), sanitize_for_terminal(row.work),
               bytes_text(row.expected.bytes), time_text(row.expected.ms));
    fmt::print("{}\n", measure ? fmt::format("{:>12}{:>12}", bytes_text(row.measured.bytes), time_text(row.measured.ms)) : "");
  }
}

void print_json(const std::string& path, const CostTable& table) {
  std::vector<std::string> rows;
  for (const CostRow& row : table) {
    JsonObject out;
    out.add("part", row.stage).add("name", row.name).add("work", row.work);
    out.add("expected_bytes", row.expected.bytes).add("expected_ms", row.expected.ms);
    out.add("measured_bytes", row.measured.bytes).add("measured_ms", row.measured.ms);
    rows.push_back(out.text());
  }
  fmt::print("{}\n", JsonObject().add("kind", "cost").add("file", path).add_raw("rows", json_array(rows)).text());
}

}  // namespace

Outcome print_costs(const std::string& path, bool json, bool measure) {
  CATENA_TRY(scene::Scene scene, open_scene(path));
  CATENA_TRY(const std::shared_ptr<const haptics::HapticProgram> program, haptics::build_program(scene));
  CATENA_TRY(const render::FramePacket packet, render::make_frame(scene, kWidth, kHeight));
  CostTable table;
  CATENA_CHECK(add_load_costs(path, scene, measure, table));
  CATENA_CHECK(add_shape_costs(scene, packet, measure, table));
  if (const Outcome drawn = add_frame_costs(packet, measure, table); !drawn) throw MachineFailure{drawn.error().message};
  table.push_back({"create", "widgets", std::to_string(program->widgets.size()), {}, {}});
  table.push_back({"create", "devices", scene.device ? "1, only in view and feel" : "0", {}, {}});
  add_tick_costs(scene, *program, measure, table);
  if (json)
    print_json(path, table);
  else
    print_table(table, measure);
  return Done{};
}

}  // namespace catena::app
