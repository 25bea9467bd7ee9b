#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/app/command.h"
#include "engine/app/felt_cursor.h"
#include "engine/app/frame_stats.h"
#include "engine/app/render/describe.h"
#include "engine/app/render/numbering.h"
#include "engine/app/render/options.h"
#include "engine/app/render/quality_words.h"
#include "engine/app/size_option.h"
#include "engine/base/clock.h"
#include "engine/base/output_file.h"
#include "haptics/extract/extract.h"
#include "render/extract/extract.h"
#include "render/frame/camera.h"
#include "render/vk/picture.h"

namespace catena::app {

namespace {

constexpr int kUnreportedFrames = 3;

// turns the camera about the vertical axis through its target
void orbit(render::View& view, double degrees) {
  const double angle = degrees * 3.14159265358979323846 / 180;
  const Vec3 axis = direction(view.up);
  const auto turn = [&](const Vec3& v) {
    return v * std::cos(angle) + cross(axis, v) * std::sin(angle) + axis * (dot(axis, v) * (1 - std::cos(angle)));
  };
  view.position = view.target + turn(view.position - view.target);
}

}  // namespace

Outcome render_pictures(const RenderOptions& o) {
  CATENA_TRY(const Size size, parse_size(o.size));
  if (!std::isfinite(o.phase)) return Error{"--phase: expected a finite number"};
  if (!std::isfinite(o.orbit_deg)) return Error{"--orbit: expected a finite angle in degrees"};
  if (!o.output.ends_with(".png") && !o.output.starts_with("/dev/")) return Error{o.output + ": expected an output that ends in .png"};
  const std::int64_t load_start = now_ns();
  CATENA_TRY(scene::Scene scene, open_scene(o.source, o.fields));
  const std::string quality = !o.quality.empty() ? o.quality : scene.quality.empty() ? "balanced" : scene.quality;
  CATENA_TRY(const Quality wanted, parse_quality(quality));
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
  const bool every = is_numbered(o.output);
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

}  // namespace catena::app
