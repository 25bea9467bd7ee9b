// SPDX-License-Identifier: MIT
#include "engine/app/tuning/figures/figures.h"

#include "engine/base/numbers.h"
#include "haptics/build/build_program.h"

namespace catena::app {

TickSimulation::TickSimulation(const std::string& text)
    : state_(std::make_unique<haptics::ChainState>()), scratch_(std::make_unique<haptics::ChainScratch>()) {
  auto scene = scene::parse_scene(text, "figure");
  CATENA_ASSERT(static_cast<bool>(scene));
  auto program = haptics::build_program(*scene);
  CATENA_ASSERT(static_cast<bool>(program));
  program_ = *program;
}

std::string vector_to_json(const Vec3& v) { return "[" + to_text(v.x) + ", " + to_text(v.y) + ", " + to_text(v.z) + "]"; }

std::string make_figure_script(const std::string& about, std::string_view body) {
  return "# " + about + R"gp(
set datafile separator ','
set terminal pngcairo size 1200,750 font 'DejaVu Sans,13' linewidth 1.5
set border linewidth 1.2
set grid linecolor rgb '#bbbbbb'
)gp" + std::string(body);
}

}  // namespace catena::app
