/// catena render SCENE|FILE -o FILE.png [--size WxH] [--quality Q] [--frames N --orbit DEG] [--probe PATH.csv] [--stats FILE.json]
/// Its options; the work is in engine/app/render.
#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/command.h"
#include "engine/app/render/options.h"

namespace catena::app {

void add_render(CLI::App& program, Work& chosen) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = program.add_subcommand("render", "a picture, offscreen");
  command->add_option("SOURCE", options->source, "a scene (.json) or a data file")->required();
  command->add_option("-o,--output", options->output, "the picture, .png; %03d in the name numbers the frames")->required();
  command->add_option("--size", options->size, "WxH")->capture_default_str();
  command->add_option("--quality", options->quality,
                      "draft, balanced, reference, time=MS, error=E (RMSE, 1/255) or step=VOXELS (default: the scene's, or balanced)");
  command->add_option("--frames", options->frames, "how many frames to draw and time")->check(CLI::Range(1, 100000))->capture_default_str();
  command->add_option("--orbit", options->orbit_deg, "turn by so many degrees over the frames");
  command->add_option("--phase", options->phase, "where the pulses of streamlines are, 0 to 1; the frames add one round");
  command->add_option("--probe", options->probe, "probe path, CSV: the cursor is drawn where the hand is at its end");
  command->add_option("--field", options->fields, "replace a field: NAME=FILE[:GRID]")->allow_extra_args(false);
  command->add_option("--stats", options->stats, "figures, JSON");
  command->add_flag("--validation", options->validation, "run with the Vulkan validation layers and count their messages");
  command->callback([&chosen, options] { chosen = [options] { return render_pictures(*options); }; });
}

}  // namespace catena::app
