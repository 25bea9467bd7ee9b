// SPDX-License-Identifier: MIT
/// catena render SCENE|FILE -o FILE.{png,exr,mp4,webm,gif} [--size WxH] [--quality Q] [--frames N --orbit DEG] ..
/// Defines the options; engine/app/render does the work.
#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/cli/command.h"
#include "engine/app/cli/options.h"
#include "engine/app/render/render_options.h"

namespace catena::app {

void add_render(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = program.add_subcommand("render", "a picture, offscreen");
  add_source(*command, "SOURCE", options->source, "a scene (.json) or a data file")->required();
  command
      ->add_option("-o,--output", options->output,
                   ".png, .exr (linear, premultiplied), or .mp4, .webm, .gif (needs ffmpeg); %03d in a name numbers the frames")
      ->required();
  command->add_option("--size", options->size, "WxH, up to 65536 each way; large pictures are drawn in tiles")->capture_default_str();
  command->add_option("--bits", options->bits, "of a .png: 8 or 16")->check(CLI::IsMember({8, 16}))->capture_default_str();
  command->add_option("--depth", options->depth,
                      "distance of the nearest opaque surface along the view axis: .exr, channel Z, inf for none");
  command->add_option("--ids", options->ids,
                      "the opaque object in each pixel: 16-bit grey .png, 0 for none; --stats and the file say which");
  command->add_option("--antialias", options->antialias, "N x N samples a pixel")->check(CLI::Range(1, 16))->capture_default_str();
  command->add_option("--tile", options->tile, "draw in tiles of so many samples each way (default: chosen by the size)")
      ->check(CLI::Range(8, 16384));
  command->add_option("--quality", options->quality,
                      "draft, balanced, reference, time=MS, error=E (RMSE, 1/255) or step=VOXELS (default: the scene's, or balanced)");
  options->targets.add_to(*command);
  add_stereo_options(*command, options->stereo);
  command->add_option("--frames", options->frames, "how many frames to draw and time (default: 1; with --camera its duration times --fps)")
      ->check(CLI::Range(1, kMaxFrames));
  command->add_option("--fps", options->fps, "frames a second of a video")->check(number_between(0.01, 1000))->capture_default_str();
  command->add_option("--orbit", options->orbit_deg, "turn by so many degrees over the frames");
  command->add_option("--elevation", options->elevation_deg, "raise the camera by so many degrees");
  command->add_option("--zoom", options->zoom, "enlarge the middle of the picture");
  command->add_option("--view", options->view, "look along +x, -x, +y, -y, +z, -z, or iso, at all that is drawn");
  command->add_flag("--fit", options->fit, "bring all that is drawn into the picture, from the same direction");
  command->add_option("--camera", options->camera, "key frames, CSV: t,px,py,pz,tx,ty,tz[,ux,uy,uz][,fovy]");
  command->add_option("--head", options->head_path,
                      "a tracked head before --screen, CSV: t,x,y,z, world units (default: the camera's position)");
  command->add_option("--animation-phase", options->animation_phase,
                      "phase of the animated bands of streamlines, 0 to 1; the frames add one period");
  command->add_option("--grid", options->grid, "of a data file that holds several: which field is shown");
  command->add_option("--step", options->step, "which step in time, of fields that have several")->check(CLI::Range(0, 1'000'000));
  command->add_option("--steps", options->steps, "steps in time FIRST:LAST or FIRST:LAST:STRIDE, a frame each");
  command->add_option("--probe", options->probe, "probe path, CSV: the cursor is drawn where the hand is at its end");
  command->add_flag("--play", options->play_probe, "the hand goes along --probe over the frames (default: its duration times --fps)");
  command->add_option("--field", options->fields, "replace a field: NAME=FILE[:GRID]")->allow_extra_args(false);
  options->colors.add_to(*command);
  command->add_option("--stats", options->stats, "figures, JSON");
  add_annotation_options(*command, options->annotate);
  command
      ->add_option("--gpu-memory", options->gpu_memory_mb, "MB of GPU memory to keep within; what does not fit is drawn coarser, and said")
      ->check(number_between(1, 1e9));
  command->add_flag("--validation", options->validation, "run with the Vulkan validation layers and count their messages");
  command->callback([&chosen, options] { chosen = [options] { return render_images(*options); }; });
}

}  // namespace catena::app
