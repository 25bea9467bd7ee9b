// SPDX-License-Identifier: MIT
/// Command-line options that several commands share: numbers, --size, --stereo, annotations, colors, real time.
///
/// Numeric options such as --rate and --seconds are finite numbers within bounds. CLI11's own checks let "nan" through, print bounds of 309
/// digits, and read an empty value as 0 after them: use refuse_empty_numbers().
#pragma once
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/cli/option_types.h"
#include "engine/app/haptics/haptic_device_setup.h"
#include "engine/base/numbers.h"
#include "engine/base/result.h"
#include "engine/base/text.h"
#include "engine/scene/components.h"
#include "engine/scene/scene.h"
#include "engine/scene/stereo.h"
#include "render/extract/extract_internal.h"

namespace catena::app {

/// Adds a positional option that takes one file, or several files of one series in any order, which become the pattern that denotes them
/// (engine/scene/time_steps.h).
CLI::Option* add_source(CLI::App& command, const std::string& name, std::string& source, const std::string& help);

/// States the accepted values of an option for `--help` and the reference, "> 0" or "{on,off}", and accepts all: the command checks them.
inline CLI::Validator accepted(const std::string& values) {
  return CLI::Validator([](const std::string&) { return std::string(); }, values);
}

/// As above, for words listed as "mono, left or right".
inline CLI::Validator accepted_words(std::string words) {
  if (const auto at = words.rfind(" or "); at != std::string::npos) words.replace(at, 4, ", ");
  return accepted("{" + words + "}");
}

/// Accepts a finite number from `minimum` to `max_size`.
inline CLI::Validator number_between(double minimum, double maximum) {
  const bool bounded = maximum < std::numeric_limits<double>::max();
  return CLI::Validator(
      [minimum, maximum, bounded](const std::string& text) -> std::string {
        const auto value = parse_double(text);
        if (value && *value >= minimum && *value <= maximum) return {};
        const std::string range = bounded ? "from " + to_text(minimum) + " to " + to_text(maximum) : "of at least " + to_text(minimum);
        return in_quotes(text) + " is out of range; a finite number " + range + " was expected";
      },
      bounded ? to_text(minimum) + " to " + to_text(maximum) : ">= " + to_text(minimum));
}

/// Accepts a finite number of at least `minimum`.
inline CLI::Validator number_at_least(double minimum) { return number_between(minimum, std::numeric_limits<double>::max()); }

/// Accepts a finite number above 0.
inline CLI::Validator number_above_zero() {
  return CLI::Validator(
      [](const std::string& text) -> std::string {
        const auto value = parse_double(text);
        if (value && *value > 0 && *value <= std::numeric_limits<double>::max()) return {};
        return in_quotes(text) + " is out of range; a finite number above 0 was expected";
      },
      "> 0");
}

/// Makes all numeric options of `command` report an empty value before any other check. Call after all options of `command` are added.
inline void refuse_empty_numbers(CLI::App& command) {
  for (CLI::Option* option : command.get_options([](const CLI::Option* o) { return o->get_expected_min() > 0; })) {
    const OptionType* type = find_option_type(option->get_type_name());
    if (type == nullptr || !type->is_number) continue;
    option->transform(CLI::Validator(
        [](std::string& text) -> std::string { return text.empty() ? "the value is empty; a number was expected" : ""; }, ""));
  }
}

/// Maximum values of --size WxH, pixels on each axis.
inline constexpr std::uint32_t kMaxImageSize = 16384;  ///< for an image that is rendered in one piece
inline constexpr int kMaxTiledPixels = 65536;          ///< for an image that is rendered in tiles

/// States the accepted values of --size.
inline CLI::Validator image_size_up_to(int max_size) {
  return accepted("1x1 to " + std::to_string(max_size) + "x" + std::to_string(max_size));
}

/// Size of an image, pixels.
struct ImageSize {
  std::uint32_t width = 1024, height = 768;
};

/// Parses --size WxH. `max_size`: maximum of width and height, pixels.
inline Result<ImageSize> parse_image_size(const std::string& text, int max_size = kMaxImageSize) {
  const auto x = text.find('x');
  if (x != std::string::npos) {
    const auto width = parse_integer(text.substr(0, x)), height = parse_integer(text.substr(x + 1));
    if (width && height && *width >= 1 && *height >= 1 && *width <= max_size && *height <= max_size)
      return ImageSize{static_cast<std::uint32_t>(*width), static_cast<std::uint32_t>(*height)};
  }
  return Error{"--size " + text + ": expected WIDTHxHEIGHT, each 1 to " + std::to_string(max_size) + ", such as 1024x768"};
}

/// The options --stereo MODE, --eye-separation S, --zero-parallax F and --screen NAME, which override the scene.
struct StereoOptions {
  std::string mode, screen;
  std::optional<double> separation, zero_parallax;

  /// Applies the given options to the scene's stereo settings. Error: an unknown mode or screen, or a distance out of range.
  Outcome apply(scene::Stereo& stereo) const {
    if (!mode.empty()) {
      const auto known = scene::parse_stereo_mode(mode);
      if (!known) return Error{"--stereo " + mode + ": expected " + scene::stereo_mode_names()};
      stereo.mode = *known;
    }
    if (separation) {
      if (!(*separation >= 0) || !std::isfinite(*separation))
        return Error{"--eye-separation: expected a finite number of at least 0, world units"};
      stereo.separation = separation;
    }
    if (zero_parallax) {
      if (!(*zero_parallax > 0) || !std::isfinite(*zero_parallax))
        return Error{"--zero-parallax: expected a finite number above 0, world units"};
      stereo.zero_parallax = zero_parallax;
    }
    if (!screen.empty()) {
      std::vector<std::string_view> names;
      for (const scene::DisplayScreen& one : stereo.screens) {
        if (one.name == screen) stereo.screen_index = names.size();
        names.push_back(one.name);
      }
      if (!stereo.screen_index)
        return Error{"--screen " + screen + ": expected one of the scene's screens: " +
                     (names.empty() ? "it has none" : join_words(names)) + suggestion(screen, names)};
    }
    return Done{};
  }
};

/// Error if the packed image of all stereo views is larger than kMaxImageSize.
inline Outcome check_packed_size(const scene::Stereo& stereo, const ImageSize& size) {
  const auto packed = render::packed_size(render::stereo_packing(stereo), render::stereo_view_count(stereo), size.width, size.height);
  if (packed.width >= 1 && packed.height >= 1 && packed.width <= kMaxImageSize && packed.height <= kMaxImageSize) return Done{};
  return Error{"--size " + std::to_string(size.width) + "x" + std::to_string(size.height) + ": with " +
               std::to_string(render::stereo_view_count(stereo)) + " views " + std::string(scene::to_string(stereo.mode)) +
               " the image has " + std::to_string(packed.width) + "x" + std::to_string(packed.height) + " pixels; 1 to " +
               std::to_string(kMaxImageSize) + " along each axis were expected"};
}

/// Adds the stereo options to a command.
inline void add_stereo_options(CLI::App& command, StereoOptions& choice) {
  command
      .add_option("--stereo", choice.mode,
                  "stereo mode; each view has the size given by --size, modes *-half fit all views into that size (default: the scene's)")
      ->type_name("MODE")
      ->check(accepted_words(scene::stereo_mode_names()));
  command
      .add_option("--eye-separation", choice.separation,
                  "distance between the two views (default: the scene's, or a 30th of --zero-parallax)")
      ->type_name("DISTANCE")
      ->check(accepted(">= 0"));
  command
      .add_option("--zero-parallax", choice.zero_parallax,
                  "distance from the camera at which the two views coincide (default: the scene's, or the distance of the camera's target)")
      ->type_name("LENGTH")
      ->check(accepted("> 0"));
  command
      .add_option("--screen", choice.screen,
                  "display screen of the scene for which the image is rendered, seen from the camera's position (default: none)")
      ->type_name("SCREEN");
}

}  // namespace catena::app

/// Options that annotate the image of a scene or a data file: --title TEXT, --scalar-bar, --orientation-marker.
namespace CLI {
class App;
}

namespace catena::app {

/// Values of the annotation options.
struct AnnotationOptions {
  std::string title;
  bool scalar_bar = false, orientation_marker = false;
};
void add_annotation_options(CLI::App& command, AnnotationOptions& options);

/// Adds the annotations to those of the scene; a scalar bar for the first volume or colored streamlines, unless the scene has scalar bars.
/// Error: --scalar-bar, but nothing is colored by values.
Outcome add_annotations(scene::Scene& scene, const AnnotationOptions& options);

}  // namespace catena::app

/// The options --colormap NAME, --range LO HI, --mapping WORD, --linear-below SIZE, --threshold LO,HI, --opacity PAIRS, --preset NAME,
/// --symmetric, --over FILE and --stretch X,Y,Z: the appearance of a data file, and another one over it.
namespace CLI {
class App;
}

namespace catena::app {

/// Values of the color options, as typed.
struct ColorOptions {
  std::string colormap;
  std::vector<std::string> range;
  std::string mapping, linear_below, threshold, opacity, preset, overlay, stretch;
  std::vector<std::string> label_opacities;
  bool is_symmetric = false;

  void add_to(CLI::App& command);
  /// Checks and converts the options. Error: an unknown color map, mapping or preset, a range that is not valid for the mapping, a
  /// threshold that is no rising ranges, or opacities that are no pairs of a rising value and an alpha from 0 to 1.
  Result<scene::FileColors> to_file_colors() const;

 private:
  Result<scene::NamedColors> to_named_colors() const;
};

/// Values of --max-proxy-error E and --max-tick-us T: targets for the links that leave their settings open. At most one is given.
struct HapticTargetOptions {
  std::optional<double> max_proxy_error, max_tick_us;

  void add_to(CLI::App& command);
  bool is_given() const { return max_proxy_error || max_tick_us; }
  /// Returns the scene's targets, with these in place of its own haptic ones.
  scene::TuningTargets resolve(const scene::Scene& scene) const;
};

/// Adds --realtime on|off and --cpu N: real-time scheduling and core of the haptic thread.
inline void add_realtime_options(CLI::App& command, RealtimeChoice& choice) {
  command.add_option("--realtime", choice.realtime, "fixed priority and locked memory of the haptic thread, where the system permits them")
      ->type_name("WORD")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  command.add_option("--cpu", choice.cpu, "processor core of the haptic thread (default: the last one, with a fixed priority)")
      ->type_name("CORE")
      ->check(CLI::Range(0, 4095));
}

}  // namespace catena::app
