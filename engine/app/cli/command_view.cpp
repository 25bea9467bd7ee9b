// SPDX-License-Identifier: MIT
/// catena view SCENE|FILE [--device NAME] [--seconds S] [--servo-stats FILE.json]: the interactive window.
#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/options.h"
#include "engine/app/haptics/device_file.h"
#include "engine/app/tuning/choose/tune.h"
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
  ColorOptions colors;
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
  CATENA_TRY(options.colors, o.colors.to_file_colors());
  CATENA_TRY(options.overrides, parse_field_overrides(o.fields));
  options.apply_overrides = [annotations = o.annotate, stereo = o.stereo, device = o.device_file,
                             follow = o.follow](scene::Scene& scene) -> Outcome {
    if (follow) scene::start_following(scene);
    CATENA_CHECK(add_annotations(scene, annotations));
    CATENA_CHECK(apply_device_file(device, scene));
    return stereo.apply(scene.stereo);
  };
  {
    if (o.source.empty() && !o.grid.empty()) return Error{"--grid: a SOURCE was expected: a data file that contains the grid"};
    if (o.source.empty() && !o.fields.empty()) return Error{"--field: a SOURCE was expected: a scene whose field is replaced"};
    if (o.source.empty() && options.colors.is_given())
      return Error{"the options of colours: a SOURCE was expected: the data file that they apply to"};
    if (o.source.empty() && o.follow) return Error{"--follow: a SOURCE was expected: a scene or data file to follow"};
    options.early = {size.width, size.height, static_cast<std::uint64_t>(1e6 * o.gpu_memory_mb), o.headset ? "" : o.source, nullptr};
    CATENA_TRY(scene::Scene scene, options.early.show_during([&]() -> Result<scene::Scene> {
      if (o.source.empty()) return scene::Scene();
      return o.follow ? open_followed_scene(o.source, o.fields, o.grid, o.seconds) : open_scene(o.source, o.fields, options.colors, o.grid);
    }));
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
  CLI::App* command = program.add_subcommand("view", "opens the interactive window");
  add_source(*command, "SOURCE", options->source, "scene (.json) or data file (default: a welcome page with the recent files)")
      ->type_name("FILE");
  command
      ->add_option("--device", options->device,
                   "mouse, or a haptic device, whose forces are off until F is pressed; the mouse replaces a missing device (default: the "
                   "scene's, or mouse)")
      ->type_name("DEVICE");
  command
      ->add_option("--device-file", options->device_file,
                   "device settings that replace the scene's \"device\"; the registration of the device in a headset's room is saved there")
      ->type_name("FILE.json");
  command
      ->add_option("--head", options->head,
                   "tracked head in front of --screen: a table t,x,y,z in world units, or a device (default: the mouse)")
      ->type_name("HEAD.csv|DEVICE");
  command->add_option("--grid", options->grid, "field of a data file to show (default: the first scalar field, or else the first field)")
      ->type_name("GRID");
  command->add_option("--field", options->fields, "replaces a field of the scene")->type_name("NAME=FILE[:GRID]")->allow_extra_args(false);
  command->add_option("--size", options->size, "size of the window")
      ->type_name("WxH")
      ->check(image_size_up_to(kMaxImageSize))
      ->capture_default_str();
  command
      ->add_option("--quality", options->quality,
                   "target or settings of a still image; an image takes time=MS or 50 ms while something moves (default: the scene's, "
                   "or time=50)")
      ->type_name("QUALITY");
  options->colors.add_to(*command);
  options->targets.add_to(*command);
  command
      ->add_option(
          "--gpu-memory", options->gpu_memory_mb,
          "limit on GPU memory; data that does not fit is rendered at a lower resolution, with a note (default: the driver's limit)")
      ->type_name("MB")
      ->check(number_between(1, 1e9));
  command
      ->add_option("--shaders", options->shaders,
                   "folder of shaders to use; changes there are compiled at once (default: the built-in ones)")
      ->type_name("SHADERS");
  add_stereo_options(*command, options->stereo);
  command->add_option("--frames", options->frames, "number of frames after which the window closes; 0: never (default: 0)")
      ->type_name("FRAMES")
      ->check(number_between(0, std::numeric_limits<int>::max()));
  command
      ->add_option("--seconds", options->seconds,
                   "renders continuously, and closes the window after this many seconds; 0: neither (default: 0)")
      ->type_name("S")
      ->check(number_at_least(0));
  command->add_option("--screenshot", options->screenshot, "image of the last frame to write")->type_name("FILE.png");
  command->add_option("--screenshot-ui", options->window_screenshot, "image of the last frame with the panels to write")
      ->type_name("FILE.png");
  command->add_flag("--follow", options->follow, "shows each new time step of a running program when its file is complete");
  command->add_flag("--xr", options->headset, "also shows the scene in a headset (OpenXR); the window mirrors one view");
  command->add_flag("--no-panels", options->no_panels, "starts without the panels; Tab shows them");
  command->add_option("--frame-stats", options->frame_stats, "table of frame times to write, with histograms")->type_name("FILE.json");
  command->add_option("--servo-stats", options->servo_stats, "statistics of the servo to write: ticks, missed deadlines, histograms")
      ->type_name("FILE.json");
  command->add_option("--record", options->record, "recording of every tick to write, for replay --log, export and info")
      ->type_name("FILE.catlog");
  command->add_option("--firmware", options->firmware, "firmware image of the vendor, sent to a Falcon without firmware")
      ->type_name("FIRMWARE");
  add_annotation_options(*command, options->annotate);
  add_realtime_options(*command, options->realtime);
  command->callback([&chosen, &exit_code, options] { chosen = [&exit_code, options] { return open_window(*options, exit_code); }; });
}

}  // namespace catena::app
