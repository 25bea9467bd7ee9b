// SPDX-License-Identifier: MIT
#include "engine/app/cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/base/console.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/opacity_presets.h"
#include "engine/scene/time_steps.h"

namespace catena::app {

CLI::Option* add_source(CLI::App& command, const std::string& name, std::string& source, const std::string& help) {
  return command.add_option_function<std::vector<std::string>>(
      name,
      [&source](const std::vector<std::string>& files) {
        if (files.size() > 1)
          for (const char* single : {".json", ".catlog"})
            for (const std::string& file : files)
              if (has_extension(file, single))
                throw CLI::ValidationError(
                    file + ": several files were given; a single scene or recording, or the data files of one series, were expected");
        const auto one = scene::make_pattern(files);
        if (!one) throw CLI::ValidationError(one_line(one.error().message));
        source = *one;
      },
      help + "; several files of one series are its time steps");
}

void add_annotation_options(CLI::App& command, AnnotationOptions& options) {
  command.add_option("--title", options.title, "title at the top of the image")->type_name("TEXT");
  command.add_flag("--scalar-bar", options.scalar_bar, "shows a scalar bar of the first volume or of the first coloured streamlines");
  command.add_flag("--orientation-marker", options.orientation_marker, "shows the world axes in a corner");
}

Outcome add_annotations(scene::Scene& scene, const AnnotationOptions& options) {
  scene::Annotations& all = scene.annotations;
  if (!options.title.empty()) all.title = options.title;
  if (options.orientation_marker && !all.orientation_marker) all.orientation_marker.emplace();
  if (!options.scalar_bar || !all.scalar_bars.empty()) return Done{};
  const auto bar = scene::first_scalar_bar(scene.entities);
  if (!bar)
    return Error{
        "--scalar-bar: nothing in the scene is coloured by values; a volume or streamlines with \"color_by\" were expected (with a data "
        "file, --colormap NAME)"};
  all.scalar_bars.push_back(*bar);
  return Done{};
}

void HapticTargetOptions::add_to(CLI::App& command) {
  CLI::Option* error =
      command
          .add_option(
              "--max-proxy-error", max_proxy_error,
              "maximum distance of a streamline link's proxy from its line; the fastest settings within it are used (default: the scene's)")
          ->type_name("ERROR")
          ->check(number_above_zero());
  command
      .add_option("--max-tick-us", max_tick_us,
                  "maximum time of a tick; the most accurate settings of streamline links within it are used (default: the scene's)")
      ->type_name("US")
      ->check(number_above_zero())
      ->excludes(error);
}

scene::TuningTargets HapticTargetOptions::resolve(const scene::Scene& scene) const {
  scene::TuningTargets targets = scene.tuning;
  if (is_given()) targets.max_proxy_error = max_proxy_error, targets.max_tick_us = max_tick_us;
  return targets;
}

void ColorOptions::add_to(CLI::App& command) {
  command
      .add_option("--colormap", colormap, "colour map of a data file; catena info --colormaps lists them (default: chosen from the data)")
      ->type_name("COLORMAP");
  command
      .add_option("--range", range, "range of values that the colours and the opacity of a data file cover (default: the display range)")
      ->type_name("LO HI")
      ->check(accepted("LO < HI"))
      ->expected(2);
  command.add_option("--mapping", mapping, "scale of the colours and of the opacity of a data file (default: linear)")
      ->type_name("WORD")
      ->check(accepted("{linear,log,symlog}"));
  command
      .add_option("--linear-below", linear_below,
                  "for --mapping symlog: maximum magnitude of the values that are mapped linearly (default: a thousandth of the maximum)")
      ->type_name("VALUE")
      ->check(accepted("> 0"));
  command
      .add_option("--threshold", threshold,
                  "range of the values of a data file that are shown, two ranges LO,HI,LO,HI, or a single T for magnitudes of at least T "
                  "(default: all values)")
      ->type_name("LO,HI");
  command
      .add_option("--label-opacity", label_opacities,
                  "opacity of labels of a label map, 0 to 1; LABELS: a number, a range A-B, or a name, in which * stands for any letters")
      ->type_name("LABELS=OPACITY")
      ->allow_extra_args(false);
  command.add_flag("--symmetric", is_symmetric, "makes the range of the colours symmetric about 0");
  command
      .add_option("--over", overlay,
                  "data file drawn over the data file: labels, or a statistic, of which the strong values of either sign are shown; "
                  "the options of colours apply to it")
      ->type_name("FILE");
  command
      .add_option("--stretch", stretch,
                  "factors by which the image of a data file is stretched along x, y and z (default: 1,1,1 unless the axes' voxels differ "
                  "a lot)")
      ->type_name("FX,FY,FZ");
  CLI::Option* pairs =
      command
          .add_option(
              "--opacity", opacity,
              "opacities of a volume of a data file: pairs of a value, in the data's unit, and an alpha over the smallest voxel edge")
          ->type_name("V,A,V,A...");
  std::string presets = "colours and opacities for a kind of data: ";
  for (const scene::OpacityPreset& one : scene::opacity_presets()) presets += (presets.ends_with(": ") ? "" : ", ") + std::string(one.name);
  command.add_option("--preset", preset, presets)->type_name("PRESET")->excludes(pairs);
}

namespace {

/// Returns the numbers of a list with commas; empty if a word is no finite number.
std::vector<double> parse_numbers(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream list(text);
  for (std::string word; std::getline(list, word, ',');) {
    const auto number = parse_double(word);
    if (!number || !std::isfinite(*number)) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

Result<Threshold> parse_threshold(const std::string& text) {
  std::vector<double> bounds = parse_numbers(text);
  if (bounds.size() == 1 && bounds[0] > 0 && bounds[0] < scene::kMaxSize)
    bounds = {-scene::kMaxSize, -bounds[0], bounds[0], scene::kMaxSize};
  const bool rises = std::ranges::is_sorted(bounds) && !(bounds.size() == 4 && bounds[1] == bounds[2]);
  if (!rises || (bounds.size() != 2 && bounds.size() != 4))
    return Error{one_line("--threshold " + text +
                          ": a range LO,HI with LO <= HI, two rising ranges LO,HI,LO,HI, or a single number above 0 was expected")};
  Threshold threshold;
  for (std::size_t i = 0; i < bounds.size(); i += 2) threshold.push_back({bounds[i], bounds[i + 1]});
  return threshold;
}

}  // namespace

Result<scene::FileColors> ColorOptions::to_file_colors() const {
  scene::FileColors colors;
  CATENA_TRY(colors.named, to_named_colors());
  if (!preset.empty() && scene::find_opacity_preset(preset) == nullptr) {
    const auto names = scene::opacity_preset_names();
    return Error{one_line("--preset: " + in_quotes(preset) + " is not a preset; one of " + join_words(names) + " was expected" +
                          suggestion(preset, names))};
  }
  colors.preset = preset;
  for (const std::string& request : label_opacities) {
    const std::size_t equals = request.rfind('=');
    const auto alpha = equals == std::string::npos ? std::nullopt : parse_double(request.substr(equals + 1));
    if (!alpha || !(*alpha >= 0 && *alpha <= 1) || equals == 0)
      return Error{one_line("--label-opacity " + request + ": LABELS=OPACITY with an opacity from 0 to 1 was expected")};
    colors.label_opacities.push_back({request.substr(0, equals), *alpha});
  }
  if (!stretch.empty()) {
    const std::vector<double> factors = parse_numbers(stretch);
    const bool valid =
        factors.size() == 3 && std::ranges::all_of(factors, [](double f) { return f >= scene::kMinSize && f <= scene::kMaxSize; });
    if (!valid) return Error{one_line("--stretch " + stretch + ": three factors above 0, such as 1,1,0.01, were expected")};
    colors.stretch = Vec3(factors[0], factors[1], factors[2]);
  }
  colors.is_symmetric = is_symmetric;
  colors.overlay = overlay;
  if (is_symmetric && colors.named.range) return Error{"--symmetric: the range is given by --range; one of the two was expected"};
  if (opacity.empty()) return colors;
  const std::vector<double> numbers = parse_numbers(opacity);
  const Error refused{
      one_line("--opacity " + opacity + ": pairs of a rising value and an alpha from 0 to 1, such as 40,0,80,0.2,300,0.8, were expected")};
  if (numbers.size() < 4 || numbers.size() % 2 != 0) return refused;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    const double value = numbers[i], alpha = numbers[i + 1];
    if (!(alpha >= 0 && alpha <= 1) || (i > 0 && !(value > numbers[i - 2]))) return refused;
    colors.opacities.push_back({value, std::min(alpha, scene::TransferFunction::OpacityPoint::kMaxAlpha)});
  }
  return colors;
}

Result<scene::NamedColors> ColorOptions::to_named_colors() const {
  scene::NamedColors colors;
  if (!colormap.empty() && !scene::is_color_map(colormap))
    return Error{one_line("--colormap: " + scene::unknown_color_map_message(colormap))};
  colors.map = colormap;
  if (const std::string_view warning = scene::color_map_warning(colormap); !warning.empty()) print_message(std::string(warning));
  if (!mapping.empty()) {
    const auto word = std::ranges::find(scene::kMappingNames, mapping);
    if (word == std::end(scene::kMappingNames))
      return Error{one_line("--mapping " + in_quotes(mapping) + ": linear, log or symlog was expected")};
    colors.mapping.kind = static_cast<scene::ValueMapping::Kind>(word - std::begin(scene::kMappingNames));
  }
  if (!linear_below.empty()) {
    const auto size = parse_double(linear_below);
    if (!size || !(*size > 0) || colors.mapping.kind != scene::ValueMapping::Kind::symlog)
      return Error{one_line("--linear-below " + linear_below + ": a value above 0 together with --mapping symlog was expected")};
    colors.mapping.linear_below = *size;
  }
  if (!threshold.empty()) {
    CATENA_TRY(colors.threshold, parse_threshold(threshold));
  }
  if (range.empty()) return colors;
  const auto lo = parse_double(range[0]), hi = parse_double(range[1]);
  if (!lo || !hi || !scene::is_color_range(*lo, *hi))
    return Error{one_line("--range " + range[0] + " " + range[1] + ": two increasing numbers LO HI were expected")};
  colors.range = {*lo, *hi};
  if (const std::string problem = scene::mapping_error(colors.mapping, *lo, "--range"); !problem.empty())
    return Error{one_line("--range " + range[0] + " " + range[1] + ": " + problem)};
  return colors;
}

}  // namespace catena::app
