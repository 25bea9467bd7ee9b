/// catena render SCENE|FILE -o FILE.png [--size WxH] [--quality Q] [--frames N --orbit DEG] [--probe PATH.csv] [--stats FILE.json]
///   [--colormap NAME] [--range LO HI]
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/app/color_option.h"
#include "engine/app/command.h"
#include "engine/app/felt_cursor.h"
#include "engine/app/frame_stats.h"
#include "engine/app/size_option.h"
#include "engine/base/clock.h"
#include "engine/base/numbers.h"
#include "engine/base/output_file.h"
#include "haptics/extract/extract.h"
#include "render/extract/extract.h"
#include "render/frame/camera.h"
#include "render/passes/quality.h"
#include "render/vk/picture.h"

namespace catena::app {

namespace {

constexpr int kUnreportedFrames = 3;

struct Options {
  std::string source, output, size = "1024x768", quality, stats, probe;
  std::vector<std::string> fields;
  int frames = 1;
  double orbit_deg = 0, phase = 0;
  bool validation = false;
  ColorOption colors;
};

/// Settings, or a goal that they have yet to be measured for.
struct Quality {
  render::RenderSettings settings;
  std::optional<render::QualityGoal> goal;
};

Result<Quality> quality_of(const std::string& quality) {
  using Kind = render::QualityGoal::Kind;
  if (quality == "draft") return Quality{render::draft_settings(), {}};
  if (quality == "balanced") return Quality{render::balanced_settings(), {}};
  if (quality == "reference") return Quality{render::reference_settings(), {}};
  for (const auto& [prefix, kind] : {std::pair{"error=", Kind::error}, std::pair{"time=", Kind::time}}) {
    if (!quality.starts_with(prefix)) continue;
    const auto value = parse_double(quality.substr(std::string_view(prefix).size()));
    if (value && std::isfinite(*value) && *value > 0) return Quality{render::balanced_settings(), render::QualityGoal{kind, *value}};
    return Error{"--quality " + quality + ": expected a positive number of " + (kind == Kind::error ? "1/255" : "milliseconds")};
  }
  if (quality.starts_with("step=")) {
    const auto step = parse_double(quality.substr(5));
    if (step && std::isfinite(*step) && *step >= 0.01 && *step <= 100) {
      render::RenderSettings settings;
      settings.step_voxels = *step;
      return Quality{settings, {}};
    }
    return Error{"--quality " + quality + ": expected a step of 0.01 to 100 voxels"};
  }
  return Error{"--quality " + quality + ": expected draft, balanced, reference, time=MS, error=E or step=VOXELS"};
}

// "turn_%03d.png" names every picture of an orbit; a plain name is the first picture.
bool has_number_pattern(const std::string& path, std::size_t& at, std::size_t& length, int& width) {
  at = path.find('%');
  if (at == std::string::npos) return false;
  std::size_t k = at + 1;
  width = 0;
  while (k < path.size() && path[k] >= '0' && path[k] <= '9' && width < 100) width = 10 * width + (path[k++] - '0');
  if (k >= path.size() || path[k] != 'd') return false;
  length = k + 1 - at;
  return true;
}

std::string numbered(const std::string& path, int frame) {
  std::size_t at = 0, length = 0;
  int width = 0;
  if (!has_number_pattern(path, at, length, width)) return path;
  return path.substr(0, at) + fmt::format("{:0{}}", frame, width) + path.substr(at + length);
}

// turns the camera about the vertical axis through its target
void orbit(render::View& view, double degrees) {
  const double angle = degrees * 3.14159265358979323846 / 180;
  const Vec3 axis = direction(view.up);
  const auto turn = [&](const Vec3& v) {
    return v * std::cos(angle) + cross(axis, v) * std::sin(angle) + axis * (dot(axis, v) * (1 - std::cos(angle)));
  };
  view.position = view.target + turn(view.position - view.target);
}

// "1 volume, 3 streamlines, the cursor"
std::string what_is_drawn(const render::FramePacket& packet) {
  std::string text;
  const auto add = [&](std::size_t count, const char* one, const char* many) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, count == 1 ? one : many);
  };
  add(packet.volumes.size(), "volume", "volumes");
  add(packet.isosurfaces.size(), "isosurface", "isosurfaces");
  add(packet.meshes.size(), "mesh", "meshes");
  add(packet.tubes.size(), "streamline", "streamlines");
  add(packet.cursors.size(), "cursor", "cursors");
  return text.empty() ? "nothing" : text;
}

Outcome render_pictures(const Options& o) {
  CATENA_TRY(const Size size, parse_size(o.size));
  if (!std::isfinite(o.phase)) return Error{"--phase: expected a finite number"};
  if (!std::isfinite(o.orbit_deg)) return Error{"--orbit: expected a finite angle in degrees"};
  if (!o.output.ends_with(".png") && !o.output.starts_with("/dev/")) return Error{o.output + ": expected an output that ends in .png"};
  CATENA_TRY(const scene::NamedColors colors, o.colors.named());
  const std::int64_t load_start = now_ns();
  CATENA_TRY(scene::Scene scene, open_scene(o.source, o.fields, colors));
  const std::string quality = !o.quality.empty() ? o.quality : scene.quality.empty() ? "balanced" : scene.quality;
  CATENA_TRY(const Quality wanted, quality_of(quality));
  render::RenderSettings settings = wanted.settings;
  std::vector<std::string> inputs = inputs_of(scene);
  if (!o.probe.empty()) inputs.push_back(o.probe);
  CATENA_CHECK(check_output(o.output, inputs));
  if (!o.stats.empty()) CATENA_CHECK(check_output(o.stats, inputs));
  if (!o.stats.empty() && same_file(o.stats, o.output)) return Error{o.stats + ": --stats and -o name one file: expected two"};

  // the chain is checked with the picture: one scene, two senses
  CATENA_TRY(const std::shared_ptr<const haptics::Program> program, haptics::extract_program(scene));
  CATENA_CHECK(place_cursor(scene, *program, o.probe));
  CATENA_TRY(render::FramePacket packet, render::extract_frame(scene, size.width, size.height));
  FrameStats stats;
  stats.load_ms = ms_since(load_start);
  stats.cpu_bytes = field_bytes(scene);

  auto renderer = render::Renderer::create({.validation = o.validation, .choose = {}, .surface = {}});
  if (!renderer) throw MachineFailure{renderer.error().message};
  const bool every = numbered(o.output, 0) != o.output;
  const auto draw = [&](int frame, std::vector<double>* times) -> Outcome {
    const std::int64_t start = now_ns();
    scene.phase = o.phase + static_cast<double>(frame) / std::max(1, o.frames);
    CATENA_TRY(render::FramePacket next, render::extract_frame(scene, size.width, size.height));
    orbit(next.view, o.orbit_deg * frame / std::max(1, o.frames));
    const Outcome drawn = (*renderer)->draw(next, settings);
    if (!drawn) throw MachineFailure{drawn.error().message};
    if (times != nullptr) times->push_back(ms_since(start));
    return Done{};
  };
  const auto read_back = [&]() -> render::Picture {
    auto picture = (*renderer)->read_back();
    if (!picture) throw MachineFailure{picture.error().message};
    return std::move(*picture);
  };

  if (wanted.goal) {
    const auto choice = render::choose_quality(**renderer, packet, *wanted.goal);
    if (!choice) throw MachineFailure{choice.error().message};
    settings = choice->settings;
    stats.estimated_rmse = choice->estimated_rmse;
    fmt::print("quality {}: {}, error about {:.2f}/255{}\n", quality, describe(settings), choice->estimated_rmse,
               choice->reached ? "" : " (nothing reached the goal: the nearest was taken)");
  }
  stats.quality_mode = wanted.goal ? quality + ": " + describe(settings) : quality;

  // the first picture, from process start to pixels on the host
  CATENA_CHECK(draw(0, nullptr));
  const render::Picture first = read_back();
  stats.first_frame_ms = ms_since_process_start();
  stats.device = (*renderer)->stats().device;
  fmt::print("{}: {}x{}, {}, on {}\n", o.output, size.width, size.height, what_is_drawn(packet), stats.device);

  // the reported frames come after a few unreported ones
  const bool transparent = packet.background[3] < 1;
  Progress progress("render", o.frames);
  if (!o.stats.empty() || o.frames > 1) {
    for (int k = 1; k < kUnreportedFrames; ++k) CATENA_CHECK(draw(0, nullptr));
    for (int k = 0; k < o.frames; ++k) {
      CATENA_CHECK(draw(k, &stats.frame_ms));
      if (every) CATENA_CHECK(render::write_png(numbered(o.output, k), read_back(), transparent));
      progress.at(k + 1);
    }
    fmt::print("frame {:.1f} ms (median of {})\n", stats.median_ms(), stats.frame_ms.size());
  }

  std::int64_t encode_start = now_ns();
  const auto finish = [&](const std::string& path) -> Outcome {
    encode_start = now_ns();
    if (!every) CATENA_CHECK(render::write_png(path, first, transparent));
    stats.encode_ms = ms_since(encode_start);
    return Done{};
  };
  const render::RenderStats gpu = (*renderer)->stats();
  stats.driver = gpu.driver;
  stats.mirror_ms = gpu.mirror_ms;
  stats.gpu_bytes = gpu.gpu_bytes;
  stats.validation_messages = gpu.validation_messages;
  for (const std::string& text : (*renderer)->validation_texts()) fmt::print(stderr, "validation: {}\n", text);
  if (o.stats.empty()) return finish(o.output);
  CATENA_TRY(OutputFile json, OutputFile::open(o.stats));
  CATENA_CHECK(finish(o.output));
  json.write(stats.json());
  const Outcome kept = json.commit();
  if (!kept && !o.output.starts_with("/dev/") && !every) std::remove(o.output.c_str());
  return kept;
}

}  // namespace

void add_render(CLI::App& program, Work& chosen) {
  auto options = std::make_shared<Options>();
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
  options->colors.add_to(*command);
  command->add_option("--stats", options->stats, "figures, JSON");
  command->add_flag("--validation", options->validation, "run with the Vulkan validation layers and count their messages");
  command->callback([&chosen, options] { chosen = [options] { return render_pictures(*options); }; });
}

}  // namespace catena::app
