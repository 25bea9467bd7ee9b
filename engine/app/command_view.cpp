/// catena view SCENE|FILE [--device NAME]: the interactive window.
#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/command.h"
#include "engine/app/size_option.h"
#include "engine/app/viewer/viewer.h"
#include "engine/base/output_file.h"

namespace catena::app {

namespace {

struct Options {
  std::string source, device = "mouse", size = "1024x768", screenshot;
  std::vector<std::string> fields;
  int frames = 0;
};

Outcome open_window(const Options& o, int& exit_code) {
  CATENA_TRY(const Size size, parse_size(o.size));
  ViewOptions options;
  CATENA_TRY(options.scene, open_scene(o.source, o.fields));
  if (!o.screenshot.empty()) CATENA_CHECK(check_output(o.screenshot, inputs_of(options.scene)));
  options.device = o.device;
  options.width = size.width;
  options.height = size.height;
  options.frames = o.frames;
  options.screenshot = o.screenshot;
  exit_code = view(std::move(options));
  return Done{};
}

}  // namespace

void add_view(CLI::App& program, Work& chosen, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("view", "an interactive window: orbit, and the mouse as the hand");
  command->add_option("SOURCE", options->source, "a scene (.json) or a data file")->required();
  command->add_option("--device", options->device, "what holds the probe")->check(CLI::IsMember({"mouse"}))->capture_default_str();
  command->add_option("--field", options->fields, "replace a field: NAME=FILE[:GRID]")->allow_extra_args(false);
  command->add_option("--size", options->size, "of the window, WxH")->capture_default_str();
  command->add_option("--frames", options->frames, "quit after so many frames")->check(CLI::NonNegativeNumber);
  command->add_option("--screenshot", options->screenshot, "write the last frame here, .png");
  command->callback([&chosen, &exit_code, options] { chosen = [&exit_code, options] { return open_window(*options, exit_code); }; });
}

}  // namespace catena::app
