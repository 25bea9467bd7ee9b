// SPDX-License-Identifier: MIT
/// The frames of a `catena render`: one scene, seen along a camera motion, while the probe moves or the time steps change. Main thread.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/app/batch/shard.h"
#include "engine/app/cli/command.h"
#include "engine/app/cli/options.h"
#include "engine/app/haptics/probe_playback.h"
#include "engine/app/haptics/signal_handlers.h"
#include "engine/app/render/outputs.h"
#include "engine/app/render/render_options.h"
#include "engine/base/console.h"
#include "render/extract/extract.h"

namespace catena::app {

/// Renders frames of one scene and passes their bands to the outputs.
class Frames {
 public:
  /// `steps`: time steps by frame; empty: the step is fixed. The references must outlive the object.
  Frames(scene::Scene& scene, const RenderOptions& options, const CameraMotion& motion, ProbePlayback& probe, ImageSize size,
         std::vector<int> steps)
      : scene_(scene), options_(options), motion_(motion), probe_(probe), size_(size), steps_(std::move(steps)) {}

  /// Extracts a frame, counted from 0. Error: the scene cannot be prepared, or a screen does not fit the view.
  Result<render::FramePacket> packet(int frame);
  /// Returns milliseconds from the start of extraction to the fence (of all tiles). Without outputs nothing is read back. Throws
  /// MachineFailure when rendering fails or is interrupted.
  Result<double> draw(int frame, Outputs* outputs);
  /// The part of a frame that is measured to choose settings: all of it, or the middle tile of one that is large or supersampled.
  struct Sample {
    render::FramePacket packet;
    double share = 1;  ///< Fraction of the image's samples.
  };
  /// Returns the sample of a frame.
  Sample sample_of(const render::FramePacket& packet) const;

  std::unique_ptr<render::Renderer> renderer;
  render::RenderSettings settings;
  Shard shard;                         ///< The frames that are drawn; the time step of the next one is loaded in advance.
  bool needs_full_resolution = false;  ///< A grid that is downsampled to fit into the GPU memory is an error.
  bool smooth_edges = true;            ///< Contours are antialiased in frames that are drawn in one piece.
  render::TilePlan plan;
  std::optional<PathQuality> path;   ///< The frames are path traced.
  std::string path_summary;          ///< Samples and error of the last path-traced frame.
  render::BandChannels channels;     ///< What the outputs need of each band.
  ProgressLine* progress = nullptr;  ///< Updated after each tile; null: not reported.
  double first_ms = 0;               ///< Time from process start to the first pixels on the host, ms.

 private:
  /// Traces a frame and writes it. Returns milliseconds.
  Result<double> draw_path(const render::FramePacket& packet, Outputs* outputs, int frame);
  /// Adds the planes of --layout ortho.
  Outcome add_planes(render::FramePacket& packet);

  scene::Scene& scene_;
  const RenderOptions& options_;
  const CameraMotion& motion_;
  ProbePlayback& probe_;
  ImageSize size_;
  std::vector<int> steps_;
  std::optional<render::View> base_view_;
  Bounds base_bounds_;
  std::optional<InterruptHandler> interrupt_;  ///< Active while rendering.
  double tiles_done_ = 0;
};

}  // namespace catena::app
