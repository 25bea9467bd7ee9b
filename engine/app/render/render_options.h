// SPDX-License-Identifier: MIT
/// Options of `catena render`, as given on the command line, and the camera and quality that follow from them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/app/cli/options.h"
#include "engine/app/render/path_quality.h"
#include "engine/base/result.h"
#include "render/frame/camera.h"
#include "render/frame/camera_path.h"
#include "render/quality/quality.h"

namespace catena::app {

/// Maximum number of frames of a sequence.
inline constexpr int kMaxFrames = 100000;

/// Values of the options.
struct RenderOptions {
  std::string source, grid, output, size = "1024x768", quality, stats, probe;
  HapticTargetOptions targets;
  std::vector<std::string> fields;  ///< NAME=FILE[:GRID]
  // Outputs.
  int bits = 8;            ///< Bits per channel of -o FILE.png
  std::string depth, ids;  ///< Files for a depth and an id image in addition to the image; empty: none
  int tile = 0;            ///< Tile size in samples; 0: chosen automatically
  int antialias = 0;       ///< Samples per pixel on each axis; 0: 1, with antialiased contours
  // Frames.
  int frames = 0;  ///< Number of frames; 0: not given
  double fps = 25, animation_phase = 0;
  std::optional<std::string> shard;  ///< I/N: only every N-th frame, from the I-th on; not given: all frames
  int step = -1;                     ///< Time step; -1: the scene's
  std::string steps;                 ///< Time steps FIRST:LAST or FIRST:LAST:STRIDE, one frame each
  bool play_probe = false;           ///< The probe moves along the probe path over the frames
  // Camera.
  std::string camera, view, head_path;
  bool fit = false;
  double orbit_deg = 0, elevation_deg = 0, zoom = 1;
  double gpu_memory_mb = 0;  ///< Limit of GPU memory, MB; 0: what the driver reports
  StereoOptions stereo;
  // Contents.
  std::string layout;              ///< "ortho": orthogonal views beside the 3D view; empty: the 3D view
  std::vector<std::string> focus;  ///< Common point of the orthogonal views, three numbers; empty: the middle of the field
  AnnotationOptions annotate;
  ColorOptions colors;
  bool validation = false;
};

/// Renders and writes all outputs. Error: bad input. Throws MachineFailure for system failures.
Outcome render_images(const RenderOptions& options);

/// Reads the positions of a tracked head, a CSV table `t,x,y,z`, as a camera path whose view targets are not used.
Result<render::CameraPath> read_head_path(const std::string& path);

/// Camera of each frame: the scene's, that of a key-framed path, or along an axis; fitted, zoomed, elevated and orbited; or, with a screen
/// of the scene, at the position of a tracked head.
class CameraMotion {
 public:
  /// Checks the camera options and reads the camera path. `probe_path_s`: duration of the probe path if it is played, else 0.
  static Result<CameraMotion> make(const RenderOptions& options, double probe_path_s);
  /// Number of frames: --frames, or the longest duration of --camera, --head and the played probe path at --fps, or 1.
  int frames() const { return frames_; }
  /// View of a frame, 0 to frames() - 1. `base`: the scene's view; `bounds`: of everything that is rendered; `aspect`: width / height.
  render::View view_at(const render::View& base, const Bounds& bounds, double aspect, int frame) const;

 private:
  std::optional<render::CameraPath> path_, head_;
  std::optional<Vec3> camera_direction_;
  bool fit_ = false;
  double orbit_deg_ = 0, elevation_deg_ = 0, zoom_ = 1;
  int frames_ = 1;
};

/// Parses --steps FIRST:LAST[:STRIDE] into the list of time steps; empty for an empty string.
Result<std::vector<int>> parse_steps(const std::string& words);

/// The quality of --quality and of the scene's "quality": draft, balanced, reference, time=MS, error=E or step=VOXELS. Either settings, or
/// a goal for which settings have yet to be searched.
struct Quality {
  render::RenderSettings settings;
  std::optional<render::QualityGoal> goal;
  std::optional<PathQuality> path = {};       ///< `catena render`: the image is path traced
  std::optional<double> interactive_ms = {};  ///< Viewer: target time of a frame while something moves, ms; empty: the default
};

/// Returns whether a stated quality is fixed settings instead of a target for error or time; false for an empty one.
bool is_fixed_quality(std::string_view words);
/// Parses a quality. Error: an unknown word or a number out of range.
Result<Quality> parse_quality(const std::string& words);

}  // namespace catena::app
