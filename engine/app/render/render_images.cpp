// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/app/cli/command.h"
#include "engine/app/cli/options.h"
#include "engine/app/haptics/probe_playback.h"
#include "engine/app/haptics/signal_handlers.h"
#include "engine/app/render/frame_stats.h"
#include "engine/app/render/outputs.h"
#include "engine/app/render/render_options.h"
#include "engine/app/tuning/plan/tune.h"
#include "engine/base/clock.h"
#include "engine/base/console.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/io/field_cache.h"
#include "engine/scene/time_steps.h"
#include "haptics/build/build_program.h"
#include "render/extract/extract.h"
#include "render/extract/extract_internal.h"

namespace catena::app {

namespace {

constexpr int kMaxTiledPixels = 65536;  // in each direction

template <class T>
T machine(Result<T> result) {
  if (!result) throw MachineFailure{result.error().message};
  return std::move(*result);
}

/// Prints a line about the image: to standard output, or to standard error if the image goes to standard output.
void say(std::FILE* to, const std::string& line) {
  if (to == stderr) return print_line(line);
  std::fputs((sanitize_for_terminal(line) + "\n").c_str(), to);
  std::fflush(to);
}

/// Renders frames of one scene and passes their bands to the outputs.
class Frames {
 public:
  Frames(scene::Scene& scene, const RenderOptions& options, const CameraMotion& motion, ProbePlayback& hand, ImageSize size,
         std::vector<int> steps)
      : scene_(scene), options_(options), motion_(motion), hand_(hand), size_(size), steps_(std::move(steps)) {}

  Result<render::FramePacket> packet(int frame) {
    if (!steps_.empty()) {
      scene::set_step(scene_, steps_[static_cast<std::size_t>(frame) % steps_.size()]);
    }
    scene_.animation_phase = options_.animation_phase + static_cast<double>(frame) / motion_.frames();
    hand_.seek(scene_, options_.play_probe && motion_.frames() > 1 ? static_cast<double>(frame) / (motion_.frames() - 1) : 1);
    CATENA_TRY(render::FramePacket packet, render::make_frame(scene_, size_.width, size_.height));
    if (!steps_.empty() && frame + 1 < motion_.frames())
      field::prefetch(scene::prefetch_requests(scene_, steps_[static_cast<std::size_t>(frame + 1) % steps_.size()]));
    // the camera is fixed while the probe moves or time steps change
    if (!base_view_ || (!options_.play_probe && steps_.empty())) base_view_ = packet.view, base_bounds_ = render::packet_bounds(packet);
    const render::View view = motion_.view_at(*base_view_, base_bounds_, static_cast<double>(size_.width) / size_.height, frame);
    render::set_view(scene_, view, packet);
    CATENA_CHECK(render::check_screen_view(packet, scene_.stereo));
    return packet;
  }

  /// Returns milliseconds from the start of extraction to the fence (of all tiles). Without outputs nothing is read back.
  Result<double> draw(int frame, Outputs* outputs) {
    if (!interrupt_) interrupt_.emplace(std::vector{SIGINT, SIGTERM, SIGHUP});
    const std::int64_t start = now_ns();
    CATENA_TRY(const render::FramePacket next, packet(frame));
    const double extract_ms = ms_since(start);
    Outcome stopped = Done{};
    bool interrupted = false;
    const auto take = [&](const render::Band& band) -> Outcome {
      interrupted = interrupt_->is_requested();
      if (interrupted) return Error{"interrupted"};
      if (band.height == 0) {
        if (progress != nullptr) progress->update(++tiles_done_);
        return Done{};
      }
      if (first_ms == 0) first_ms = ms_since_process_start();
      return stopped = outputs->write(band);
    };
    if (outputs != nullptr) CATENA_CHECK(outputs->begin_frame(frame));
    const auto ms = render::render_tiled(*renderer, next, settings, plan, wants, outputs != nullptr ? take : decltype(nothing_)());
    CATENA_CHECK(stopped);
    if (interrupted || interrupt_->is_requested()) throw MachineFailure{"interrupted: nothing half-written was kept"};
    if (!ms) throw MachineFailure{ms.error().message};
    if (outputs != nullptr) CATENA_CHECK(outputs->end_frame());
    return extract_ms + ms->wall_ms;
  }

  std::unique_ptr<render::Renderer> renderer;
  render::RenderSettings settings;
  render::TilePlan plan;
  render::BandChannels wants;
  ProgressLine* progress = nullptr;
  double first_ms = 0;  ///< from process start to the first pixels on the host

 private:
  scene::Scene& scene_;
  const RenderOptions& options_;
  const CameraMotion& motion_;
  ProbePlayback& hand_;
  ImageSize size_;
  std::vector<int> steps_;  ///< time steps by frame; empty: the step is fixed
  std::optional<render::View> base_view_;
  Bounds base_bounds_;
  std::optional<InterruptHandler> interrupt_;  // active while rendering
  double tiles_done_ = 0;
  std::function<Outcome(const render::Band&)> nothing_;
};

constexpr double kBalancedError = 2;  // 1/255: hardly visible next to the reference image
constexpr double kConverged = 1;      // 1/255: upper bound of the error of a setting used as a reference

/// Part of an image that is measured: all of it, or the middle tile of one that is large or supersampled.
struct Sample {
  render::FramePacket packet;
  double share = 1;  ///< fraction of the image's samples
};
Sample sample_of(const Frames& frames, const render::FramePacket& packet) {
  const render::TilePlan& plan = frames.plan;
  const bool whole = std::max(plan.samples_x(), plan.samples_y()) <= frames.renderer->max_image_side() &&
                     std::uint64_t(plan.samples_x()) * plan.samples_y() <= render::kMaxUntiledSamples;
  if (plan.antialias == 1 && (plan.count() == 1 || whole)) return {packet};
  const render::TileArea middle = plan.area(plan.columns() / 2, plan.rows() / 2);
  return {render::make_tile_packet(packet, plan, middle),
          double(middle.render_width) * middle.render_height / (double(plan.samples_x()) * plan.samples_y())};
}

/// Chooses the settings that meet the quality goal.
render::QualityChoice choose_settings(Frames& frames, const render::FramePacket& packet, render::QualityGoal goal) {
  const Sample sample = sample_of(frames, packet);
  if (goal.kind == render::QualityGoal::Kind::time) goal.value *= sample.share;
  ProgressLine progress("choosing how to draw", 1);
  return machine(render::choose_quality(*frames.renderer, sample.packet, goal, [&progress](double done) { progress.update(done); }));
}

/// Size of the finished image. Stereo views in one image are rendered without tiles.
Result<ImageSize> picture_size(const RenderOptions& o, const scene::Stereo& stereo, const ImageSize& size) {
  if (render::stereo_view_count(stereo) < 2) return size;
  const std::string mode = "with " + std::to_string(render::stereo_view_count(stereo)) + " views in one picture";
  if (!o.depth.empty() || !o.ids.empty())
    return Error{(o.depth.empty() ? "--ids: " : "--depth: ") + mode + " it would be one view's; --stereo left or right was expected"};
  if (o.antialias > 1 || o.tile > 0)
    return Error{(o.tile > 0 ? "--tile: " : "--antialias: ") + mode + " it is drawn in one piece; --stereo left or right was expected"};
  CATENA_CHECK(check_packed_size(stereo, size));
  const auto packed = render::packed_size(render::stereo_packing(stereo), render::stereo_view_count(stereo), size.width, size.height);
  return ImageSize{static_cast<std::uint32_t>(packed.width), static_cast<std::uint32_t>(packed.height)};
}

/// Checks that every step of --steps has a frame and an output to store it.
Outcome check_frames(const RenderOptions& o, const std::vector<int>& steps) {
  const int count = static_cast<int>(steps.size());
  if (count < 2) return Done{};
  if (o.frames < count) return Error{fmt::format("--frames {}: fewer than the {} steps of --steps {}", o.frames, count, o.steps)};
  if (!takes_all_frames(o) && !o.output.starts_with("/dev/"))
    return Error{fmt::format("{}: one picture for {} steps; %03d in its name, or a video, was expected", o.output, count)};
  return Done{};
}

/// Rejects steps beyond the last one of the longest field. Steps inside data files are known only after the fields are loaded.
Outcome check_steps(const scene::Scene& scene, const RenderOptions& o, const std::vector<int>& steps) {
  const std::string option = steps.empty() ? fmt::format("--step {}", o.step) : "--steps " + o.steps;
  return check_step(steps.empty() ? o.step : steps.back(), scene::step_count(scene) - 1, option, o.source);
}

}  // namespace

Outcome render_images(const RenderOptions& given) {
  RenderOptions o = given;
  CATENA_TRY(const std::vector<int> steps, parse_steps(o.steps));
  if (!steps.empty() && o.step >= 0) return Error{"--step: goes without --steps"};
  if (!steps.empty() && o.frames == 0) o.frames = static_cast<int>(steps.size());
  CATENA_CHECK(check_frames(o, steps));
  CATENA_TRY(const ImageSize size, parse_image_size(o.size, kMaxTiledPixels));
  if (!std::isfinite(o.animation_phase)) return Error{"--animation-phase: expected a finite number"};
  if (o.play_probe && o.probe.empty()) return Error{"--play: there is no path to go along; --probe PATH.csv was expected"};
  ProbePath path;
  if (o.play_probe) {
    CATENA_TRY(path, read_probe_samples(o.probe));
  }
  CATENA_TRY(const CameraMotion motion, CameraMotion::make(o, o.play_probe ? path.back().t_s - path.front().t_s : 0));
  CATENA_TRY(const scene::NamedColors colors, o.colors.to_named_colors());
  const std::int64_t load_start = now_ns();
  CATENA_TRY(scene::Scene scene, open_scene(o.source, o.fields, colors, o.grid, steps.empty() ? o.step : steps.front()));
  if (o.step >= 0 || !steps.empty()) scene::set_step(scene, steps.empty() ? o.step : steps.front());
  CATENA_CHECK(add_annotations(scene, o.annotate));
  CATENA_CHECK(o.stereo.apply(scene.stereo));
  CATENA_TRY(const ImageSize picture, picture_size(o, scene.stereo, size));
  const std::string quality = !o.quality.empty() ? o.quality : scene.quality.empty() ? "balanced" : scene.quality;
  CATENA_TRY(Quality wanted, parse_quality(quality));
  IoConflictChecker files(scene);
  files.add_input(o.probe);
  files.add_input(o.camera);
  files.add_input(o.head_path);
  ImageFormat shape{picture.width, picture.height, scene.background.transparent, o.bits, o.fps, {}};
  CATENA_CHECK(check_outputs(o, shape, motion.frames(), files));
  std::FILE* const words = uses_standard_output(o) ? stderr : stdout;

  if (o.targets.is_given() && o.probe.empty())
    return Error{"--max-proxy-error and --max-tick-us: nothing is felt here; --probe PATH.csv was expected beside them"};
  if (!o.probe.empty())
    CATENA_CHECK(plan::tune_links(scene, o.targets.resolve(scene), 1000, o.fields, [&](const std::string& line) { say(words, line); }));
  // the chain is validated as well, so that a rendered scene also works with haptics
  CATENA_TRY(const std::shared_ptr<const haptics::HapticProgram> program, haptics::build_program(scene));
  if (o.probe.empty()) {
    path = make_resting_path(scene);
  } else if (!o.play_probe) {
    CATENA_TRY(path, read_probe_samples(o.probe));
  }
  ProbePlayback hand(program, std::move(path));
  Frames frames(scene, o, motion, hand, size, steps);
  CATENA_TRY(const render::FramePacket packet, frames.packet(0));
  CATENA_CHECK(check_steps(scene, o, steps));
  if (is_scene_file(o.source)) print_scene_notes(scene);
  if (const Outcome drawable = render::check_ray_items(packet); !drawable) return Error{o.source + ": " + drawable.error().message};
  if (!o.ids.empty() && packet.objects.size() > 65535)
    return Error{o.ids + ": the scene has " + std::to_string(packet.objects.size()) + " objects; 16 bits hold 65535"};
  if (quality == "balanced" && render::uses_raycast(packet)) wanted.goal = {render::QualityGoal::Kind::error, kBalancedError};
  FrameStats stats;
  stats.load_ms = ms_since(load_start);
  stats.cpu_bytes = loaded_data_bytes(scene);
  stats.objects = packet.objects;
  shape.object_legend = objects_json(packet.objects);

  render::vk::DeviceOptions device;
  device.validation = o.validation;
  device.memory_budget_bytes = static_cast<std::uint64_t>(1e6 * o.gpu_memory_mb);
  frames.renderer = machine(render::Renderer::create(device));
  frames.settings = wanted.settings;
  frames.wants = required_band_channels(o);
  const auto antialias = static_cast<std::uint32_t>(o.antialias), tile = static_cast<std::uint32_t>(o.tile);
  frames.plan = render::stereo_view_count(scene.stereo) > 1
                    ? render::TilePlan{size.width, size.height, 1, size.width, size.height, 0}
                    : render::plan_tiles(size.width, size.height, antialias, tile, wanted.goal || wanted.settings.fast,
                                         frames.renderer->max_image_side());
  const auto choose_for = [&](const char* which, bool once) {
    wanted.goal->single_image = once;
    const std::int64_t start = now_ns();
    const render::QualityChoice choice = choose_settings(frames, packet, *wanted.goal);
    stats.settings_search_ms += ms_since(start);
    frames.settings = choice.settings;
    stats.estimated_rmse = choice.estimated_rmse;
    say(words, fmt::format("quality {}{}: {}, error about {:.2f}/255{}", quality, which, describe(frames.settings), choice.estimated_rmse,
                           choice.goal_reached ? "" : " (nothing reached the goal: the nearest was taken)"));
    return choice.is_empty;
  };
  if (wanted.goal) {
    if (choose_for("", true))
      print_message(
          "note: nothing of the scene is in the picture: it is transparent where the camera looks, or the camera looks elsewhere");
  }
  if (quality == "reference") {
    stats.estimated_rmse = machine(render::half_step_difference(*frames.renderer, sample_of(frames, packet).packet, frames.settings));
    if (*stats.estimated_rmse > kConverged)
      print_message(
          fmt::format("note: reference has not converged here: half its step changes the picture by {:.2g}/255, since opacity "
                      "rises within a step. --quality step=0.02 is nearer to the truth",
                      *stats.estimated_rmse));
  }
  stats.quality_mode = wanted.goal ? quality + ": " + describe(frames.settings) : quality;
  stats.tiles = frames.plan.count();
  stats.device = frames.renderer->stats().device;

  Outputs outputs(o, shape);
  const bool more = motion.frames() > 1 && (takes_all_frames(o) || o.stats.empty());
  {
    const double parts = frames.plan.count() * (more ? double(motion.frames()) : 1.0);
    ProgressLine progress("render", parts);
    frames.progress = parts > 1 ? &progress : nullptr;
    CATENA_TRY(const double first, frames.draw(0, &outputs));
    stats.first_frame_ms = frames.first_ms;
    stats.downsampled_grids = frames.renderer->stats().downsampled_grids;
    for (const render::GridDownsampling& coarser : stats.downsampled_grids) print_line(coarser.message());
    print_scene_notes(scene);
    say(words, fmt::format("{}: {}x{}, {}{}, on {}", o.output, picture.width, picture.height, describe_contents(packet),
                           stats.tiles > 1 ? fmt::format(", {} tiles", stats.tiles) : "", stats.device));
    stats.frame_ms.push_back(first);
    // render the first image before the search for settings of the sequence
    if (motion.frames() > 1 && wanted.goal && wanted.goal->kind == render::QualityGoal::Kind::error && render::uses_raycast(packet))
      choose_for(" of the sequence", false);
    for (int k = 1; k < motion.frames(); ++k) {
      CATENA_TRY(const double ms, frames.draw(k, takes_all_frames(o) ? &outputs : nullptr));
      stats.frame_ms.push_back(ms);
    }
    frames.progress = nullptr;
  }
  if (!o.stats.empty() || motion.frames() > 1)
    say(words, fmt::format("frame {:.1f} ms (median of {})", stats.median_ms(), stats.frame_ms.size()));

  CATENA_CHECK(outputs.finish());
  stats.encode_ms = outputs.ms_per_frame();
  const render::RenderStats gpu = frames.renderer->stats();
  stats.driver = gpu.driver;
  stats.residency_ms = gpu.residency_ms;
  stats.gpu_bytes = gpu.gpu_bytes;
  stats.gpu_budget_bytes = gpu.gpu_budget;
  stats.validation_messages = gpu.validation_messages;
  for (const std::string& note : gpu.warnings) print_message(note);
  for (const std::string& text : frames.renderer->validation_texts()) print_line("validation: " + text);
  if (o.stats.empty()) return outputs.commit();
  CATENA_TRY(OutputFile json, OutputFile::open(o.stats));
  json.write(stats.to_json());
  CATENA_CHECK(json.finish());
  CATENA_CHECK(outputs.commit());
  return json.commit();
}

}  // namespace catena::app
