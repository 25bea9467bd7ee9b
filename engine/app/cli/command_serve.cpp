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

constexpr int kMaxServedSize = 4096;  // pixels on each axis

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
  CATENA_TRY(const ImageSize size, parse_image_size(o.size, kMaxServedSize));
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
  CLI::App* command = program.add_subcommand("serve", "shows a scene in a browser, on this or another machine");
  add_source(*command, "SOURCE", options->source, "scene (.json) or data file")->type_name("FILE")->required();
  command->add_option("--grid", options->grid, "field of a data file to show (default: the first scalar field, or else the first field)")
      ->type_name("GRID");
  command->add_option("--port", options->port, "TCP port; 0: any free port")
      ->type_name("PORT")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_option("--address", options->address, "numeric address to listen on; 0.0.0.0 admits other machines, without encryption")
      ->type_name("ADDRESS")
      ->capture_default_str();
  command->add_option("--name", options->names, "host name that browsers may use, in addition to localhost and numeric addresses")
      ->type_name("HOST")
      ->allow_extra_args(false);
  command->add_option("--frame-ancestor", options->frame_ancestor, "origin of pages whose frames may show this one")->type_name("URL");
  command->add_option("--field", options->fields, "replaces a field of the scene")->type_name("NAME=FILE[:GRID]")->allow_extra_args(false);
  command->add_option("--size", options->size, "size of the image until a page requests its own")
      ->type_name("WxH")
      ->check(image_size_up_to(kMaxServedSize))
      ->capture_default_str();
  command
      ->add_option("--quality", options->quality,
                   "target or settings of the rendering of an image at rest (default: the scene's, or time=50)")
      ->type_name("QUALITY");
  command
      ->add_option(
          "--gpu-memory", options->gpu_memory_mb,
          "limit on GPU memory; data that does not fit is rendered at a lower resolution, with a note (default: the driver's limit)")
      ->type_name("MB")
      ->check(number_between(1, 1e9));
  command->add_option("--seconds", options->seconds, "duration (default: until Ctrl-C)")->type_name("S")->check(number_at_least(0));
  command->add_flag("--follow", options->follow, "shows each new time step of a running program when its file is complete");
  command->add_flag("--exit-with-stdin", options->until_stdin_ends,
                    "ends when standard input ends, so that the server ends with the program that started it");
  add_annotation_options(*command, options->annotate);
  add_realtime_options(*command, options->realtime);
  command->callback([&chosen, options] { chosen = [options] { return start_serving(*options); }; });
}

}  // namespace catena::app
