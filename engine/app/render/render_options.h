/// What `catena render` was asked for, as it came from the command line.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/app/cli/options.h"
#include "engine/base/result.h"
#include "render/frame/camera.h"
#include "render/frame/camera_path.h"
#include "render/quality/quality.h"

namespace catena::app {

inline constexpr int kMaxFrames = 100000;

struct RenderOptions {
  std::string source, grid, output, size = "1024x768", quality, plan, stats, probe;
  std::vector<std::string> fields;  ///< NAME=FILE[:GRID]
  // outputs
  int bits = 8;            ///< of -o FILE.png
  std::string depth, ids;  ///< beside the picture
  int tile = 0;            ///< samples; 0: chosen
  int antialias = 1;       ///< samples a pixel, each way
  // frames
  int frames = 0;  ///< 0: not given
  double fps = 25, animation_phase = 0;
  int step = -1;            ///< in time; -1: the scene's
  std::string steps;        ///< A:B or A:B:STRIDE, a frame each
  bool play_probe = false;  ///< the hand goes along the probe path over the frames
  // the camera
  std::string camera, view, head_path;
  bool fit = false;
  double orbit_deg = 0, elevation_deg = 0, zoom = 1;
  double gpu_memory_mb = 0;  ///< 0: what the driver offers
  StereoOptions stereo;
  // what is drawn
  AnnotationOptions annotate;
  ColorOptions colors;
  bool validation = false;
};

/// All of the work. An Error: bad input; throws MachineFailure for the rest.
Outcome render_images(const RenderOptions& options);

/// The places of a tracked head, `t,x,y,z`, as a camera goes along them; what it looks at does not count.
Result<render::CameraPath> read_head_path(const std::string& path);

/// Where the camera is in each frame: the scene's, a key-framed path's, or along an axis; fitted, zoomed, raised and turned; or, before a
/// screen of the scene, where a tracked head is.
class CameraMotion {
 public:
  /// Checks the words and numbers of the options and reads the path.
  /// `haptics_s`: the duration of the hand's path where it is played, else 0.
  static Result<CameraMotion> make(const RenderOptions& options, double hand_s);
  /// --frames, or what the duration of --camera or of the hand's path comes to at --fps, or 1.
  int frames() const { return frames_; }
  /// Of frame 0 .. frames() - 1. `base`: the scene's view; `bounds`: of all that is drawn.
  render::View view_at(const render::View& base, const Bounds& bounds, double aspect, int frame) const;

 private:
  std::optional<render::CameraPath> path_, head_;
  std::optional<Vec3> camera_direction_;
  bool fit_ = false;
  double orbit_deg_ = 0, elevation_deg_ = 0, zoom_ = 1;
  int frames_ = 1;
};

/// "--steps FIRST:LAST[:STRIDE]": the steps, in order; empty where nothing is said.
Result<std::vector<int>> parse_steps(const std::string& words);

/// "--quality Q" and the scene's "quality": draft, balanced, reference, time=MS, error=E or step=VOXELS.
/// Settings, or a goal that they have yet to be measured for.
struct Quality {
  render::RenderSettings settings;
  std::optional<render::QualityGoal> goal;
  std::optional<double> interactive_ms = {};  ///< of a picture while something moves, in a window
};

Result<Quality> parse_quality(const std::string& words);

}  // namespace catena::app
