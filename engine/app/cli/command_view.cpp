// SPDX-License-Identifier: MIT
/// catena view SCENE|FILE [--device NAME] [--seconds S] [--servo-stats FILE.json]: the interactive window.
#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/options.h"
#include "engine/app/haptics/device_file.h"
#include "engine/app/tuning/plan/tune.h"
#include "engine/app/viewer/viewer.h"
#include "engine/scene/follow_files.h"
#include "haptics/device/registry.h"

namespace catena::app {

namespace {

const std::string kQuality = "time=50";

struct ViewArguments {
  std::string source, grid, device, device_file, head, size = "1024x768", quality, shaders, screenshot, window_screenshot, servo_stats,
                                                       frame_stats, record, firmware;
  HapticTargetOptions targets;
  std::vector<std::string> fields;
  int frames = 0;
  double seconds = 0, gpu_memory_mb = 0;
  bool no_panels = false, headset = false, follow = false;
  RealtimeChoice realtime;
  AnnotationOptions annotate;
  StereoOptions stereo;
};

/// Returns the inputs and outputs of the whole run that the command line and the scene name.
IoConflictChecker files_of(const ViewArguments& o, const scene::Scene& scene) {
  IoConflictChecker files(scene);
  files.add_device_files(o.device);
  files.add_device_files(o.head);
  if (!haptics::is_device_type(haptics::parse_device_type(o.head))) files.add_input(o.head);
  files.add_input(o.firmware);
  files.add_input(o.device_file);
  files.add_input_folder(o.shaders);
  files.add_output("--screenshot", o.screenshot);
  files.add_output("--screenshot-ui", o.window_screenshot);
  files.add_output("--servo-stats", o.servo_stats);
  files.add_output("--frame-stats", o.frame_stats);
  files.add_output("--record", o.record);
  return files;
}

Outcome open_window(const ViewArguments& given, int& exit_code) {
  ViewArguments o = given;
  CATENA_TRY(const ImageSize size, parse_image_size(o.size));
  ViewOptions options;
  options.grid_name = o.grid;
  CATENA_TRY(options.overrides, parse_field_overrides(o.fields));
  options.apply_overrides = [annotations = o.annotate, stereo = o.stereo, device = o.device_file,
                             follow = o.follow](scene::Scene& scene) -> Outcome {
    if (follow) scene::start_following(scene);
    CATENA_CHECK(add_annotations(scene, annotations));
    CATENA_CHECK(apply_device_file(device, scene));
    return stereo.apply(scene.stereo);
  };
  {
    if (o.source.empty() && !o.grid.empty()) return Error{"--grid: there is no data file that holds it, expected a SOURCE"};
    if (o.source.empty() && !o.fields.empty()) return Error{"--field: there is no scene whose field it could replace, expected a SOURCE"};
    if (o.source.empty() && o.follow) return Error{"--follow: there is nothing to follow, expected a SOURCE"};
    CATENA_TRY(scene::Scene scene, o.source.empty() ? Result<scene::Scene>(scene::Scene())
                                   : o.follow       ? open_followed_scene(o.source, o.fields, o.grid, o.seconds)
                                                    : open_scene(o.source, o.fields, {}, o.grid));
    options.source = o.source;
    options.follow_time_steps = o.follow;
    if (!o.source.empty()) CATENA_CHECK(options.apply_overrides(scene));
    CATENA_CHECK(files_of(o, scene).check(/*keeps_scene=*/true));
    options.has_explicit_quality = !o.quality.empty();
    const std::string& own = scene.quality.empty() ? kQuality : scene.quality;
    CATENA_TRY(options.quality, parse_quality(options.has_explicit_quality ? o.quality : own));
    options.tuning.scene_target = scene.tuning;
    options.tuning.target = o.targets.resolve(scene);
    if (options.has_explicit_quality) options.tuning.target.set_image_targets(scene::image_targets(o.quality));
    options.tuning.has_fixed_quality = is_fixed_quality(options.has_explicit_quality ? o.quality : scene.quality);
  }
  options.gpu_memory = static_cast<std::uint64_t>(1e6 * o.gpu_memory_mb);
  options.shader_folder = o.shaders;
  options.haptic_options = {o.device, o.firmware, o.record, o.fields, o.realtime.options()};
  options.max_seconds = o.seconds;
  options.servo_stats = o.servo_stats;
  options.frame_stats = o.frame_stats;
  options.width = size.width;
  options.height = size.height;
  options.max_frames = o.frames;
  options.show_panels = !o.no_panels;
  options.use_headset = options.haptic_options.use_xr_controller = o.headset;
  options.device_file = o.device_file;
  options.head_source = o.head;
  options.screenshot = o.screenshot;
  options.ui_screenshot = o.window_screenshot;
  exit_code = run_viewer(std::move(options));
  return Done{};
}

}  // namespace

void add_view(CLI::App& program, CommandAction& chosen, int& exit_code) {
  auto options = std::make_shared<ViewArguments>();
  CLI::App* command = program.add_subcommand("view", "an interactive window: orbit, and the mouse as the hand");
  add_source(*command, "SOURCE", options->source, "a scene (.json) or a data file (without it the window says how to begin)");
  command->add_option(
      "--device", options->device,
      "what holds the probe: mouse, or a haptic device (its forces are off until F). Default: the scene's, or else the mouse, "
      "which also steps in for what is not plugged in");
  command->add_option(
      "--device-file", options->device_file,
      "the device's settings, as of a scene's \"device\", in its place; where it stands in a headset's room is written there");
  command->add_option(
      "--head", options->head,
      "a tracked head before --screen: CSV, t,x,y,z, world units, played by time; or a device (default: the mouse moves it)");
  command->add_option("--grid", options->grid, "of a data file that holds several: which field is shown");
  command->add_option("--field", options->fields, "replace a field: NAME=FILE[:GRID]")->allow_extra_args(false);
  command->add_option("--size", options->size, "of the window, WxH")->capture_default_str();
  command->add_option(
      "--quality", options->quality,
      "time=MS, error=E (RMSE, 1/255), draft, balanced, reference or step=VOXELS, of a picture at rest; while something moves "
      "it comes within MS or 50 ms. Default: the scene's, or else time=50");
  options->targets.add_to(*command);
  command
      ->add_option("--gpu-memory", options->gpu_memory_mb, "MB of GPU memory to keep within; what does not fit is drawn coarser, and said")
      ->check(number_between(1, 1e9));
  command->add_option("--shaders", options->shaders, "the folder of shaders to draw with, watched: what changes there is compiled at once");
  add_stereo_options(*command, options->stereo);
  command->add_option("--frames", options->frames, "quit after so many frames")->check(number_between(0, std::numeric_limits<int>::max()));
  command->add_option("--seconds", options->seconds, "draw all the time, and quit after so long")->check(number_at_least(0));
  command->add_option("--screenshot", options->screenshot, "write the last frame here, .png");
  command->add_option("--screenshot-ui", options->window_screenshot, "the same with the panels over it, .png");
  command->add_flag("--follow", options->follow, "steps in time that a running program adds are shown as they come, once they are whole");
  command->add_flag("--xr", options->headset, "show it in a headset (OpenXR), too: the window mirrors one eye");
  command->add_flag("--no-panels", options->no_panels, "begin without the panels (Tab shows them)");
  command->add_option("--frame-stats", options->frame_stats, "how long the pictures took, histograms, JSON");
  command->add_option("--servo-stats", options->servo_stats, "the servo's ticks, missed deadlines, histograms, JSON");
  command->add_option("--record", options->record, "every tick, .catlog (replay --log, export, info read it)");
  command->add_option("--firmware", options->firmware, "falcon: the vendor's image, sent when the device has none");
  add_annotation_options(*command, options->annotate);
  add_realtime_options(*command, options->realtime);
  command->callback([&chosen, &exit_code, options] { chosen = [&exit_code, options] { return open_window(*options, exit_code); }; });
}

}  // namespace catena::app
