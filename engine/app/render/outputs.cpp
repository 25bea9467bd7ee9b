// SPDX-License-Identifier: MIT
#include "engine/app/render/outputs.h"

#include <fmt/core.h>
#include <algorithm>
#include <filesystem>
#include <optional>

#include "engine/app/render/video_writer.h"
#include "engine/base/clock.h"
#include "engine/scene/drawable.h"

namespace catena::app {
namespace {

struct Pattern {
  std::size_t at = 0, length = 0;
  int width = 0;
};

std::optional<Pattern> pattern_in(const std::string& path) {
  Pattern pattern;
  pattern.at = path.find('%');
  if (pattern.at == std::string::npos) return std::nullopt;
  std::size_t k = pattern.at + 1;
  while (k < path.size() && path[k] >= '0' && path[k] <= '9' && pattern.width < 100) pattern.width = 10 * pattern.width + (path[k++] - '0');
  if (k >= path.size() || path[k] != 'd') return std::nullopt;
  pattern.length = k + 1 - pattern.at;
  return pattern;
}

}  // namespace

bool is_numbered(const std::string& path) { return pattern_in(path).has_value(); }

std::string numbered_path(const std::string& path, int frame) {
  const auto pattern = pattern_in(path);
  if (!pattern) return path;
  return path.substr(0, pattern->at) + fmt::format("{:0{}}", frame, pattern->width) + path.substr(pattern->at + pattern->length);
}

std::string describe_contents(const render::FramePacket& packet) {
  const auto tubes_of = [&](std::string_view kind) {
    return std::ranges::count_if(packet.tubes,
                                 [&](const render::TubeItem& tube) { return tube.id > 0 && packet.objects[tube.id - 1].kind == kind; });
  };
  std::ptrdiff_t balls = 0;
  for (const render::SpheresItem& item : packet.spheres) balls += std::ssize(item.spheres->offsets);
  struct Content {
    std::string_view kind, one, many;
    std::ptrdiff_t count;
  };
  std::vector<Content> contents{{"volumes", "volume", "volumes", std::ssize(packet.volumes)},
                                {"isosurfaces", "isosurface", "isosurfaces", std::ssize(packet.isosurfaces)},
                                {"slices", "slice", "slices", std::ssize(packet.slices)},
                                {"meshes", "mesh", "meshes", std::ssize(packet.meshes)},
                                {"streamlines", "streamline", "streamlines", tubes_of("streamlines")},
                                {"curves", "curve", "curves", tubes_of("curves")},
                                {"points", "point", "points", balls},
                                {"glyphs", "set of glyphs", "sets of glyphs", std::ssize(packet.glyphs)}};
  // all other drawables by their objects
  for (const scene::Drawable& kind : scene::drawables())
    if (std::ranges::find(contents, kind.name, &Content::kind) == contents.end())
      contents.push_back(
          {kind.name, kind.singular, kind.plural, std::ranges::count_if(packet.objects, [&](const render::ObjectName& object) {
             return object.kind == kind.name || object.kind == kind.singular;
           })});
  contents.push_back({"cursor", "cursor", "cursors", std::ssize(packet.cursors)});
  std::string text;
  for (const Content& content : contents)
    if (content.count > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", content.count, content.count == 1 ? content.one : content.many);
  return text.empty() ? "nothing" : text;
}

namespace {

bool is_device(const std::string& path) { return path.starts_with("/dev/"); }

Outcome check_kind(const std::string& path, const char* option, std::initializer_list<const char*> ends) {
  std::string expected;
  for (const char* end : ends) {
    if (path.ends_with(end)) return Done{};
    expected += (expected.empty() ? "" : ", ") + std::string(end);
  }
  if (is_device(path)) return Done{};
  return Error{path + ": a name for " + option + " that ends in " + expected + " was expected"};
}

/// Adds every file to be written, with the option that names it, to the conflict check.
void add_outputs(const RenderOptions& o, int frames, IoConflictChecker& files) {
  for (const auto& [path, option] : {std::pair{o.output, "-o"}, {o.depth, "--depth"}, {o.ids, "--ids"}}) {
    if (path.empty()) continue;
    const int count = is_numbered(path) && !video_kind(path) ? frames : 1;
    for (int k = 0; k < count; ++k) files.add_output(option, count > 1 || is_numbered(path) ? numbered_path(path, k) : path);
  }
  files.add_output("--stats", o.stats);
}

}  // namespace

Outcome check_outputs(const RenderOptions& o, const ImageFormat& shape, int frames, IoConflictChecker files) {
  CATENA_CHECK(check_kind(o.output, "-o", {".png", ".exr", ".mp4", ".webm", ".gif"}));
  if (!o.depth.empty()) CATENA_CHECK(check_kind(o.depth, "--depth", {".exr"}));
  if (!o.ids.empty()) CATENA_CHECK(check_kind(o.ids, "--ids", {".png"}));
  if (o.bits == 16 && !o.output.ends_with(".png") && !is_device(o.output))
    return Error{"--bits 16: applies only to -o FILE.png, not to " + o.output};
  if (video_kind(o.output)) {
    if (frames < 2)
      return Error{o.output + ": a video has several frames; --frames N (and --orbit DEG), or --camera PATH.csv, was expected"};
    CATENA_CHECK(check_video(o.output, {shape.width, shape.height, shape.fps, shape.alpha}));
  }
  add_outputs(o, frames, files);
  return files.check();
}

bool uses_standard_output(const RenderOptions& o) {
  const auto is_stdout = [](const std::string& path) {
    std::error_code code;
    return path == "/dev/stdout" || path == "/dev/fd/1" || path == "/proc/self/fd/1" ||
           (is_device(path) && path != "/dev/null" && std::filesystem::equivalent(path, "/dev/stdout", code));
  };
  return is_stdout(o.output) || is_stdout(o.depth) || is_stdout(o.ids) || is_stdout(o.stats);
}

render::BandChannels required_band_channels(const RenderOptions& o) {
  const bool floats = o.bits == 16 || o.output.ends_with(".exr");
  return {!floats, floats, !o.depth.empty(), !o.ids.empty()};
}

bool takes_all_frames(const RenderOptions& o) {
  return video_kind(o.output) || is_numbered(o.output) || is_numbered(o.depth) || is_numbered(o.ids);
}

Outcome Outputs::open(const std::string& path, int frame,
                      Result<std::unique_ptr<ImageSink>> (*opener)(const std::string&, const ImageFormat&)) {
  if (path.empty()) return Done{};
  const bool video = video_kind(path).has_value(), each = is_numbered(path) && !video;
  if (!each && frame > 0) return Done{};
  CATENA_TRY(std::unique_ptr<ImageSink> sink, opener(each ? numbered_path(path, frame) : path, shape_));
  (video ? sequence_sinks_ : each ? frame_sinks_ : first_frame_sinks_).push_back(std::move(sink));
  return Done{};
}

Outcome Outputs::begin_frame(int frame) {
  const std::int64_t start = now_ns();
  frame_ = frame;
  CATENA_CHECK(open(options_.output, frame, open_image_sink));
  CATENA_CHECK(open(options_.depth, frame, open_depth_sink));
  CATENA_CHECK(open(options_.ids, frame, open_id_sink));
  write_ms_ += ms_since(start);
  return Done{};
}

Outcome Outputs::write(const render::Band& band) {
  const std::int64_t start = now_ns();
  for (auto* sinks : {&frame_sinks_, &first_frame_sinks_, &sequence_sinks_})
    for (const auto& sink : *sinks) CATENA_CHECK(sink->write(band));
  write_ms_ += ms_since(start);
  return Done{};
}

Outcome Outputs::end_frame() {
  const std::int64_t start = now_ns();
  for (const auto& sink : frame_sinks_) CATENA_CHECK(sink->finish());
  for (const auto& sink : frame_sinks_) CATENA_CHECK(sink->commit());
  frame_sinks_.clear();
  for (auto& sink : first_frame_sinks_) {
    CATENA_CHECK(sink->finish());
    finished_sinks_.push_back(std::move(sink));
  }
  first_frame_sinks_.clear();
  write_ms_ += ms_since(start);
  ++frame_count_;
  return Done{};
}

Outcome Outputs::finish() {
  const std::int64_t start = now_ns();
  for (auto& sink : sequence_sinks_) {
    CATENA_CHECK(sink->finish());
    finished_sinks_.push_back(std::move(sink));
  }
  sequence_sinks_.clear();
  write_ms_ += ms_since(start);
  return Done{};
}

Outcome Outputs::commit() {
  for (const auto& sink : finished_sinks_) CATENA_CHECK(sink->commit());
  finished_sinks_.clear();
  return Done{};
}

}  // namespace catena::app
