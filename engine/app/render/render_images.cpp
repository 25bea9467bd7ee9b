// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "engine/app/cli/command.h"
#include "engine/app/render/frame_stats.h"
#include "engine/app/render/frames.h"
#include "engine/app/render/option_checks.h"
#include "engine/app/tuning/choose/tune.h"
#include "engine/base/clock.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/scene/time_steps.h"
#include "haptics/build/build_program.h"

namespace catena::app {

namespace {

constexpr double kBalancedError = 2;  // 1/255: hardly visible next to the reference image
constexpr double kConverged = 1;      // 1/255: upper bound of the error of a setting used as a reference

template <class T>
T machine(Result<T> result) {
  if (!result) throw MachineFailure{result.error().message};
  return std::move(*result);
}

/// One run of `catena render`, in four steps that are called in order.
class RenderRun {
 public:
  explicit RenderRun(const RenderOptions& options) : o_(options) {}

  /// Checks the options, opens the scene, and decides what is asked for: size, frames, quality, outputs.
  Outcome resolve();
  /// Whether no frame belongs to the shard.
  bool is_empty() const { return frame_list_.empty(); }
  /// Prints that no frame belongs to the shard.
  void report_empty() const { say(empty_shard_message(shard_, static_cast<std::size_t>(motion_->frames()), "images")); }
  /// Tunes the links, extracts the first frame, and creates the renderer.
  Outcome prepare();
  /// Chooses the settings, renders all frames and passes them to the outputs.
  Outcome draw();
  /// Finishes the outputs, prints what was done and writes the statistics.
  Outcome report();

 private:
  /// Prints a line about the image: to standard output, or to standard error if the image goes to standard output.
  void say(const std::string& line) const;
  /// Measures settings on a frame and takes those that meet the goal. `single_image`: for one image rather than for a sequence. Returns
  /// whether nothing of the scene is in the picture.
  bool choose_settings(bool single_image);
  /// Whether every frame is drawn, rather than the first one.
  bool draws_sequence() const { return motion_->frames() > 1 && (takes_all_frames(o_) || o_.stats.empty()); }

  /// Chooses the settings of a frame that is about to be drawn, if it has other ones than the frame before.
  void choose_frame_settings(int frame);

  RenderOptions o_;
  Shard shard_;
  std::vector<int> frame_list_;  ///< The frames to draw, of this shard
  bool has_settings_ = false, has_sequence_settings_ = false;
  std::vector<int> steps_;  ///< Time steps by frame; empty: the step is fixed.
  ImageSize size_{}, output_size_{};
  ProbePath path_;
  std::optional<CameraMotion> motion_;
  std::optional<scene::Scene> scene_;
  std::string quality_name_;
  Quality quality_;
  ImageFormat format_;
  std::optional<ProbePlayback> probe_;
  std::optional<Frames> frames_;
  render::FramePacket first_;  ///< The first frame.
  std::optional<Outputs> outputs_;
  FrameStats stats_;
};

void RenderRun::say(const std::string& line) const {
  if (uses_standard_output(o_)) return print_line(line);
  std::fputs((sanitize_for_terminal(line) + "\n").c_str(), stdout);
  std::fflush(stdout);
}

Outcome RenderRun::resolve() {
  CATENA_TRY(const std::optional<Shard> shard, parse_shard(o_.shard));
  if (shard) {
    shard_ = *shard;
    CATENA_CHECK(check_shard_outputs(o_));
    if (!o_.stats.empty()) o_.stats = part_path(o_.stats, shard_);
  }
  CATENA_TRY(steps_, parse_steps(o_.steps));
  if (!steps_.empty() && o_.step >= 0) return Error{"--step: excludes --steps"};
  if (!steps_.empty() && o_.frames == 0) o_.frames = static_cast<int>(steps_.size());
  CATENA_CHECK(check_frames(o_, steps_));
  CATENA_TRY(size_, parse_image_size(o_.size, kMaxTiledPixels));
  if (!o_.layout.empty()) {
    if (o_.layout != "ortho") return Error{"--layout " + in_quotes(o_.layout) + ": ortho was expected"};
    size_ = {std::max(1u, size_.width / 2), std::max(1u, size_.height / 2)};
  }
  if (!std::isfinite(o_.animation_phase)) return Error{"--animation-phase: expected a finite number"};
  if (o_.play_probe && o_.probe.empty()) return Error{"--play: there is no probe path; --probe PATH.csv was expected"};
  if (o_.play_probe) {
    CATENA_TRY(path_, read_probe_samples(o_.probe));
  }
  CATENA_TRY(motion_, CameraMotion::make(o_, o_.play_probe ? path_.back().t_s - path_.front().t_s : 0));
  CATENA_TRY(const scene::FileColors colors, o_.colors.to_file_colors());
  const std::int64_t load_start = now_ns();
  const int first_step = steps_.empty() ? o_.step : steps_.front();
  CATENA_TRY(scene_, open_scene(o_.source, o_.fields, colors, o_.grid, first_step));
  if (o_.step >= 0 || !steps_.empty()) scene::set_step(*scene_, first_step);
  CATENA_CHECK(add_annotations(*scene_, o_.annotate));
  CATENA_CHECK(o_.stereo.apply(scene_->stereo));
  CATENA_TRY(output_size_, picture_size(o_, scene_->stereo, size_));
  quality_name_ = !o_.quality.empty() ? o_.quality : scene_->quality.empty() ? "balanced" : scene_->quality;
  CATENA_TRY(quality_.path, parse_path_quality(quality_name_));
  if (quality_.path) {
    CATENA_CHECK(check_path_tracing(o_, *scene_));
    scene_->illumination.look = scene::Look::lit;
  } else {
    CATENA_TRY(quality_, parse_quality(quality_name_));
  }
  if (shard) CATENA_CHECK(check_shard_settings(o_, *scene_, quality_name_, quality_));
  IoConflictChecker files(*scene_);
  files.add_input(o_.probe);
  files.add_input(o_.camera);
  files.add_input(o_.head_path);
  format_ = {output_size_.width, output_size_.height, scene_->background.transparent, o_.bits, o_.fps, {}};
  CATENA_CHECK(check_outputs(o_, format_, motion_->frames(), files));
  if (o_.targets.is_given() && o_.probe.empty())
    return Error{"--max-proxy-error and --max-tick-us: there is no probe path; --probe PATH.csv was expected"};
  for (const std::size_t frame : shard_.items(static_cast<std::size_t>(motion_->frames()))) frame_list_.push_back(static_cast<int>(frame));
  stats_.load_ms = ms_since(load_start);
  return Done{};
}

Outcome RenderRun::prepare() {
  const std::int64_t load_start = now_ns();
  if (!o_.probe.empty())
    CATENA_CHECK(tuning::tune_links(*scene_, o_.targets.resolve(*scene_), 1000, o_.fields, [&](const std::string& line) { say(line); }));
  // the chain is validated as well, so that a rendered scene also works with haptics
  CATENA_TRY(const std::shared_ptr<const haptics::HapticProgram> program, haptics::build_program(*scene_));
  if (o_.probe.empty()) {
    path_ = make_resting_path(*scene_);
  } else if (!o_.play_probe) {
    CATENA_TRY(path_, read_probe_samples(o_.probe));
  }
  probe_.emplace(program, std::move(path_));
  frames_.emplace(*scene_, o_, *motion_, *probe_, size_, steps_);
  frames_->shard = shard_;
  frames_->needs_full_resolution = o_.shard && !steps_.empty();
  CATENA_TRY(first_, frames_->packet(0));
  CATENA_CHECK(check_steps(*scene_, o_, steps_));
  if (is_scene_file(o_.source)) print_scene_notes(*scene_);
  if (const Outcome drawable = render::check_ray_items(first_); !drawable) return Error{o_.source + ": " + drawable.error().message};
  if (!o_.ids.empty() && first_.objects.size() > 65535)
    return Error{o_.ids + ": the scene has " + std::to_string(first_.objects.size()) +
                 " objects; at most 65535 were expected, which 16 bits can number"};
  if (quality_name_ == "balanced" && render::uses_raycast(first_)) quality_.goal = {render::QualityGoal::Kind::error, kBalancedError};
  if (o_.shard && o_.gpu_memory_mb > 0 && quality_.goal)
    return Error{
        "--shard: with --gpu-memory, the search for settings depends on the images before; --quality draft, reference or step=VOXELS was "
        "expected"};
  stats_.load_ms += ms_since(load_start);
  stats_.cpu_bytes = loaded_data_bytes(*scene_);
  stats_.objects = first_.objects;
  format_.object_legend = objects_json(first_.objects);

  render::vk::DeviceOptions device;
  device.validation = o_.validation;
  device.memory_budget_bytes = static_cast<std::uint64_t>(1e6 * o_.gpu_memory_mb);
  frames_->renderer = machine(render::Renderer::create(device));
  frames_->settings = quality_.settings;
  frames_->channels = required_band_channels(o_);
  frames_->path = quality_.path;
  frames_->smooth_edges = o_.antialias == 0 && o_.tile == 0;
  const auto antialias = static_cast<std::uint32_t>(std::max(1, o_.antialias)), tile = static_cast<std::uint32_t>(o_.tile);
  frames_->plan = render::stereo_view_count(scene_->stereo) > 1 || !o_.layout.empty()
                      ? render::TilePlan{size_.width, size_.height, 1, size_.width, size_.height, 0}
                      : render::plan_tiles(size_.width, size_.height, antialias, tile, quality_.goal || quality_.settings.fast,
                                           frames_->renderer->max_image_side());
  return Done{};
}

bool RenderRun::choose_settings(bool single_image) {
  render::QualityGoal goal = *quality_.goal;
  goal.single_image = single_image;
  const Frames::Sample sample = frames_->sample_of(first_);
  if (goal.kind == render::QualityGoal::Kind::time) goal.value *= sample.share;
  const std::int64_t start = now_ns();
  render::QualityChoice choice;
  {
    ProgressLine progress("choosing the quality", 1);
    // errors are measured on the bricks that the image shows
    render::RenderSettings complete = render::draft_settings();
    complete.waits_for_pages = true;
    complete.shows_finest_pages = quality_.settings.shows_finest_pages;
    if (std::ranges::any_of(sample.packet.volumes, [](const render::VolumeItem& item) { return item.paged != nullptr; }))
      machine(frames_->renderer->draw(sample.packet, complete));
    choice = machine(render::choose_quality(*frames_->renderer, sample.packet, goal, [&progress](double done) { progress.update(done); }));
  }
  stats_.settings_search_ms += ms_since(start);
  frames_->settings = choice.settings;
  frames_->settings.shows_finest_pages = quality_.settings.shows_finest_pages;
  stats_.estimated_rmse = choice.estimated_rmse;
  say(fmt::format("quality {}{}: {}, error about {:.2f}/255{}", quality_name_, single_image ? "" : " of the sequence",
                  describe(frames_->settings), choice.estimated_rmse,
                  choice.goal_reached ? "" : " (no settings reach the goal: the nearest are used)"));
  return choice.is_empty;
}

void RenderRun::choose_frame_settings(int frame) {
  if (!quality_.goal) return;
  // the first image has settings of its own; those of the others suit a sequence, if they are found by the error of rays
  const bool by_error = quality_.goal->kind == render::QualityGoal::Kind::error;
  const bool for_sequence = frame > 0 && by_error && render::uses_raycast(first_);
  if (for_sequence ? has_sequence_settings_ : has_settings_) return;
  const bool is_empty = choose_settings(!for_sequence);
  if (is_empty && !has_settings_)
    print_message("note: the image shows nothing of the scene: the scene is transparent there, or is outside the view");
  has_settings_ = true;
  has_sequence_settings_ = has_sequence_settings_ || for_sequence;
}

Outcome RenderRun::draw() {
  choose_frame_settings(frame_list_.front());
  if (quality_name_ == "reference") {
    stats_.estimated_rmse = machine(render::half_step_difference(*frames_->renderer, frames_->sample_of(first_).packet, frames_->settings));
    if (*stats_.estimated_rmse > kConverged)
      print_message(
          fmt::format("note: reference has not converged: half the step changes the image by {:.2g}/255, because the opacity "
                      "changes within a step; --quality step=0.02 is more accurate",
                      *stats_.estimated_rmse));
  }
  stats_.quality_mode = quality_.goal ? quality_name_ + ": " + describe(frames_->settings) : quality_name_;
  stats_.tiles = frames_->plan.count();
  stats_.device = frames_->renderer->stats().device;

  outputs_.emplace(o_, format_);
  const double parts = frames_->plan.count() * (draws_sequence() ? double(frame_list_.size()) : 1.0);
  ProgressLine progress("render", parts);
  frames_->progress = parts > 1 ? &progress : nullptr;
  CATENA_TRY(const double first_ms, frames_->draw(frame_list_.front(), &*outputs_));
  stats_.first_frame_ms = frames_->first_ms;
  stats_.downsampled_grids = frames_->renderer->stats().downsampled_grids;
  for (const render::GridDownsampling& coarser : stats_.downsampled_grids) print_line(coarser.message());
  if (const render::PagingStats bricks = frames_->renderer->paging(); bricks.finest_level > 0 || bricks.resident < bricks.visible)
    print_line(bricks.message());
  if (!frames_->path_summary.empty()) say("quality " + quality_name_ + ": " + frames_->path_summary);
  print_scene_notes(*scene_);
  say(fmt::format("{}: {}x{}, {}{}, on {}", o_.output, output_size_.width, output_size_.height, describe_contents(first_),
                  stats_.tiles > 1 ? fmt::format(", {} tiles", stats_.tiles) : "", quality_.path ? "the processor" : stats_.device));
  stats_.frame_ms.push_back(first_ms);
  for (const int frame : std::span(frame_list_).subspan(1)) {
    choose_frame_settings(frame);
    CATENA_TRY(const double ms, frames_->draw(frame, takes_all_frames(o_) ? &*outputs_ : nullptr));
    stats_.frame_ms.push_back(ms);
  }
  frames_->progress = nullptr;
  return Done{};
}

Outcome RenderRun::report() {
  if (!o_.stats.empty() || motion_->frames() > 1)
    say(fmt::format("frame {:.1f} ms (median of {})", stats_.median_ms(), stats_.frame_ms.size()));
  CATENA_CHECK(outputs_->finish());
  stats_.encode_ms = outputs_->ms_per_frame();
  const render::RenderStats gpu = frames_->renderer->stats();
  stats_.driver = gpu.driver;
  stats_.residency_ms = gpu.residency_ms;
  stats_.gpu_bytes = gpu.gpu_bytes;
  stats_.gpu_budget_bytes = gpu.gpu_budget;
  stats_.validation_messages = gpu.validation_messages;
  for (const std::string& note : gpu.warnings) print_message(note);
  for (const std::string& text : frames_->renderer->validation_texts()) print_line("validation: " + text);
  if (o_.stats.empty()) return outputs_->commit();
  CATENA_TRY(OutputFile json, OutputFile::open(o_.stats));
  json.write(stats_.to_json());
  CATENA_CHECK(json.finish());
  CATENA_CHECK(outputs_->commit());
  return json.commit();
}

}  // namespace

Outcome render_images(const RenderOptions& options) {
  RenderRun run(options);
  CATENA_CHECK(run.resolve());
  if (run.is_empty()) {
    run.report_empty();
    return Done{};
  }
  CATENA_CHECK(run.prepare());
  CATENA_CHECK(run.draw());
  return run.report();
}

}  // namespace catena::app
