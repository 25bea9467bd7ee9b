// SPDX-License-Identifier: MIT
/// catena render SCENE|FILE -o FILE.{png,exr,mp4,webm,gif} [--size WxH] [--quality Q] [--frames N --orbit DEG] [--shard I/N] ..
/// Defines the options; engine/app/render does the work.
#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/batch/shard.h"
#include "engine/app/cli/command.h"
#include "engine/app/cli/options.h"
#include "engine/app/render/render_options.h"

namespace catena::app {

void add_render(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = program.add_subcommand("render", "renders an image, a sequence of images or a video, without a window");
  add_source(*command, "SOURCE", options->source, "scene (.json) or data file")->type_name("FILE")->required();
  command
      ->add_option("-o,--output", options->output,
                   "image or video to write; .mp4, .webm and .gif need ffmpeg; %03d in the name numbers the frames")
      ->type_name("IMAGE")
      ->required();
  command->add_option("--size", options->size, "size of the image; large images are rendered in tiles")
      ->type_name("WxH")
      ->check(image_size_up_to(kMaxTiledPixels))
      ->capture_default_str();
  command->add_option("--bits", options->bits, "bits per channel of a .png")
      ->type_name("BITS")
      ->check(CLI::IsMember({8, 16}))
      ->capture_default_str();
  command
      ->add_option("--depth", options->depth,
                   "depth image to write: distance of the nearest opaque surface along the view axis, channel Z, inf for none")
      ->type_name("FILE.exr");
  command
      ->add_option("--ids", options->ids,
                   "id image to write: the opaque object of each pixel, 16-bit grey, 0 for none; --stats and the file name the objects")
      ->type_name("FILE.png");
  command
      ->add_option("--antialias", options->antialias,
                   "samples per pixel along each axis (default: 1, with contours antialiased from their neighbours; 1: no antialiasing)")
      ->type_name("N")
      ->check(CLI::Range(1, 16));
  command->add_option("--tile", options->tile, "size of a tile along each axis (default: chosen from the size)")
      ->type_name("SAMPLES")
      ->check(CLI::Range(8, 16384));
  command->add_option("--quality", options->quality, "target or settings of the rendering (default: the scene's, or balanced)")
      ->type_name("QUALITY");
  options->targets.add_to(*command);
  add_stereo_options(*command, options->stereo);
  command
      ->add_option("--frames", options->frames, "number of frames (default: 1; with --camera, --head or --play their duration times --fps)")
      ->type_name("FRAMES")
      ->check(CLI::Range(1, kMaxFrames));
  command->add_option("--fps", options->fps, "frames per second of a video and of camera paths")
      ->type_name("FPS")
      ->check(number_between(0.01, 1000))
      ->capture_default_str();
  command->add_option("--orbit", options->orbit_deg, "rotation of the camera about the target over all frames (default: 0)")
      ->type_name("DEG")
      ->check(accepted("finite"));
  command->add_option("--elevation", options->elevation_deg, "elevation of the camera above its direction in the scene (default: 0)")
      ->type_name("DEG")
      ->check(accepted("-90 to 90"));
  command->add_option("--zoom", options->zoom, "magnification about the centre of the image (default: 1)")
      ->type_name("FACTOR")
      ->check(accepted("0.001 to 1e6"));
  command->add_option("--view", options->view, "view along an axis, or iso, that fits the whole scene (default: the scene's camera)")
      ->type_name("VIEW");
  command->add_flag("--fit", options->fit, "fits the whole scene into the image, without turning the camera");
  CLI::Option* layout =
      command->add_option("--layout", options->layout, "ortho: axial, coronal and sagittal planes beside the 3D view")->type_name("LAYOUT");
  command
      ->add_option("--focus", options->focus,
                   "point that the planes of --layout ortho share (default: as saved in the scene, or the middle of the field)")
      ->type_name("X Y Z")
      ->expected(3)
      ->needs(layout);
  command->add_option("--camera", options->camera, "camera key frames: t,px,py,pz,tx,ty,tz[,ux,uy,uz][,fovy]")->type_name("CAMERA.csv");
  command
      ->add_option("--head", options->head_path,
                   "tracked head in front of --screen: t,x,y,z in world units (default: the camera's position)")
      ->type_name("HEAD.csv");
  command
      ->add_option("--animation-phase", options->animation_phase,
                   "phase of the animated bands of streamlines in the first frame; a sequence advances it by one period (default: 0)")
      ->type_name("PHASE")
      ->check(accepted("finite"));
  command->add_option("--grid", options->grid, "field of a data file to show (default: the first scalar field, or else the first field)")
      ->type_name("GRID");
  command->add_option("--step", options->step, "time step, counted from 0 (default: the scene's)")
      ->type_name("INDEX")
      ->check(CLI::Range(0, 1'000'000));
  command->add_option("--steps", options->steps, "time steps, one frame each")
      ->type_name("FIRST:LAST[:STRIDE]")
      ->check(accepted("from 0 on"));
  add_shard_option(*command, options->shard, "images");
  command->add_option("--probe", options->probe, "probe path; the image shows the cursor in the state of the last row")
      ->type_name("PROBE.csv");
  command->add_flag("--play", options->play_probe, "moves the probe along --probe over the frames");
  command->add_option("--field", options->fields, "replaces a field of the scene")->type_name("NAME=FILE[:GRID]")->allow_extra_args(false);
  options->colors.add_to(*command);
  command->add_option("--stats", options->stats, "statistics to write")->type_name("FILE.json");
  add_annotation_options(*command, options->annotate);
  command
      ->add_option(
          "--gpu-memory", options->gpu_memory_mb,
          "limit on GPU memory; data that does not fit is rendered at a lower resolution, with a note (default: the driver's limit)")
      ->type_name("MB")
      ->check(number_between(1, 1e9));
  command->add_flag("--validation", options->validation, "enables the Vulkan validation layers and counts their messages");
  command->callback([&chosen, options] { chosen = [options] { return render_images(*options); }; });
}

}  // namespace catena::app
