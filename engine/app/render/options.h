/// What `catena render` was asked for, as it came from the command line.
#pragma once
#include <string>
#include <vector>

#include "engine/app/annotate_option.h"
#include "engine/app/color_option.h"
#include "engine/app/stereo_option.h"
#include "engine/base/result.h"

namespace catena::app {

inline constexpr int kMaxFrames = 100000;

struct RenderOptions {
  std::string source, output, size = "1024x768", quality, stats, probe;
  std::vector<std::string> fields;  ///< NAME=FILE[:GRID]
  // outputs
  int bits = 8;            ///< of -o FILE.png
  std::string depth, ids;  ///< beside the picture
  int tile = 0;            ///< samples; 0: chosen
  int antialias = 1;       ///< samples a pixel, each way
  // frames
  int frames = 0;  ///< 0: not given
  double fps = 25, phase = 0;
  bool play = false;  ///< the hand goes along the probe path over the frames
  // the camera
  std::string camera, view;
  bool fit = false;
  double orbit_deg = 0, elevation_deg = 0, zoom = 1;
  double gpu_memory_mb = 0;  ///< 0: what the driver offers
  StereoChoice stereo;
  // what is drawn
  AnnotateOptions annotate;
  ColorOption colors;
  bool validation = false;
};

/// All of the work. An Error: bad input; throws MachineFailure for the rest.
Outcome render_pictures(const RenderOptions& options);

}  // namespace catena::app
