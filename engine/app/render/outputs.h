/// "turn_%03d.png" names every picture of a sequence; a plain name is the first picture's.
#pragma once
#include <string>
#include <vector>

#include "engine/app/cli/io_conflicts.h"
#include "engine/app/render/image_sinks.h"
#include "engine/app/render/render_options.h"
#include "render/frame/frame_packet.h"

namespace catena::app {

bool is_numbered(const std::string& path);
/// The name of one picture; a plain name as it is.
std::string numbered_path(const std::string& path, int frame);

/// "1 volume, 3 streamlines, 1 cursor": what a packet draws.
std::string describe_contents(const render::FramePacket& packet);

/// The files of `catena render`: what is checked before any work, and what is open while frames are drawn.
/// Numbered names ("turn_%03d.png") are a file a frame, committed with it; a video takes all frames; a plain name the first frame.
/// Videos and plain names are committed last, all together.

/// Refuses: kinds of file that do not exist, no ffmpeg, sizes that a video cannot hold, an output that is an input or another output.
Outcome check_outputs(const RenderOptions& options, const ImageFormat& shape, int frames, IoConflictChecker files);
/// Whether something is written to standard output; what the program says then goes to standard error.
bool uses_standard_output(const RenderOptions& options);
/// What the bands must hold for them.
render::BandChannels required_band_channels(const RenderOptions& options);

/// Whether frames after the first are written.
bool takes_all_frames(const RenderOptions& options);

class Outputs {
 public:
  Outputs(const RenderOptions& options, const ImageFormat& shape) : options_(options), shape_(shape) {}
  Outcome begin_frame(int frame);
  Outcome write(const render::Band& band);
  /// Finishes the frame; numbered files are committed.
  Outcome end_frame();
  /// All that is left is on its way to the disk; then the renames.
  Outcome finish();
  Outcome commit();
  double ms_per_frame() const { return frame_count_ > 0 ? write_ms_ / frame_count_ : 0; }  ///< spent on encoding and writing

 private:
  Outcome open(const std::string& path, int frame, Result<std::unique_ptr<ImageSink>> (*opener)(const std::string&, const ImageFormat&));

  const RenderOptions& options_;
  ImageFormat shape_;
  std::vector<std::unique_ptr<ImageSink>> frame_sinks_, first_frame_sinks_, sequence_sinks_, finished_sinks_;
  int frame_ = 0, frame_count_ = 0;
  double write_ms_ = 0;
};

}  // namespace catena::app
