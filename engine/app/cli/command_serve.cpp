// SPDX-License-Identifier: MIT
/// catena serve SOURCE [--port N] [--address A]: shows the scene in a browser.
#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/options.h"
#include "engine/app/server/serve.h"
#include "engine/scene/follow_files.h"

namespace catena::app {

namespace {

const std::string kServedQuality = "time=50";

struct ServeArguments {
  std::string source, grid, address = "127.0.0.1", size = "1024x768", quality, frame_ancestor;
  std::vector<std::string> fields, names;
  int port = 8642;
  double seconds = 0, gpu_memory_mb = 0;
  bool until_stdin_ends = false, follow = false;
  RealtimeChoice realtime;
  AnnotationOptions annotate;
};

Outcome start_serving(const ServeArguments& given) {
  ServeArguments o = given;
  CATENA_TRY(const ImageSize size, parse_image_size(o.size, 4096));
  ServeOptions options;
  options.grid = o.grid;
  CATENA_TRY(options.overrides, parse_field_overrides(o.fields));
  options.adjust_scene = [annotations = o.annotate, follow = o.follow](scene::Scene& scene) {
    if (follow) scene::start_following(scene);
    return add_annotations(scene, annotations);
  };
  CATENA_TRY(scene::Scene scene,
             o.follow ? open_followed_scene(o.source, o.fields, o.grid, o.seconds) : open_scene(o.source, o.fields, {}, o.grid));
  options.source = o.source;
  options.follow = o.follow;
  CATENA_CHECK(options.adjust_scene(scene));
  const std::string& own = scene.quality.empty() ? kServedQuality : scene.quality;
  CATENA_TRY(options.quality, parse_quality(o.quality.empty() ? own : o.quality));
  options.has_fixed_quality = is_fixed_quality(o.quality.empty() ? scene.quality : o.quality);
  options.exit_with_stdin = o.until_stdin_ends;
  options.haptic_options.device = "mouse";
  options.haptic_options.field_options = o.fields;
  options.haptic_options.realtime = o.realtime.options();
  options.server.address = o.address;
  options.server.port = static_cast<std::uint16_t>(o.port);
  options.server.host_names = o.names;
  options.server.frame_ancestor = o.frame_ancestor;
  options.width = size.width;
  options.height = size.height;
  options.gpu_memory = static_cast<std::uint64_t>(1e6 * o.gpu_memory_mb);
  options.seconds = o.seconds;
  return serve(std::move(options));
}

}  // namespace

void add_serve(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<ServeArguments>();
  CLI::App* command = program.add_subcommand("serve", "the scene in a browser, here or through `ssh -L`: orbit, and the mouse as the hand");
  add_source(*command, "SOURCE", options->source, "a scene (.json) or a data file")->required();
  command->add_option("--grid", options->grid, "of a data file that holds several: which field is shown");
  command->add_option("--port", options->port, "to listen at; 0: any that is free")->check(CLI::Range(0, 65535))->capture_default_str();
  command->add_option("--address", options->address, "to listen at, in numbers; 0.0.0.0 lets other machines in, without encryption")
      ->capture_default_str();
  command->add_option("--name", options->names, "what browsers may call this machine, beside localhost and addresses in numbers")
      ->allow_extra_args(false);
  command->add_option("--frame-ancestor", options->frame_ancestor,
                      "a page's origin whose frames may show this one, such as http://127.0.0.1:8888");
  command->add_option("--field", options->fields, "replace a field: NAME=FILE[:GRID]")->allow_extra_args(false);
  command->add_option("--size", options->size, "of the picture before a page says its own, WxH")->capture_default_str();
  command->add_option("--quality", options->quality,
                      "time=MS, error=E (RMSE, 1/255), draft, balanced, reference or step=VOXELS, of a picture at rest. Default: the "
                      "scene's, or else time=50");
  command
      ->add_option("--gpu-memory", options->gpu_memory_mb, "MB of GPU memory to keep within; what does not fit is drawn coarser, and said")
      ->check(number_between(1, 1e9));
  command->add_option("--seconds", options->seconds, "end after so long; default: until Ctrl-C")->check(number_at_least(0));
  command->add_flag("--follow", options->follow, "steps in time that a running program adds are shown as they come, once they are whole");
  command->add_flag("--exit-with-stdin", options->until_stdin_ends, "end when the standard input does: with the program at its other end");
  add_annotation_options(*command, options->annotate);
  add_realtime_options(*command, options->realtime);
  command->callback([&chosen, options] { chosen = [options] { return start_serving(*options); }; });
}

}  // namespace catena::app
