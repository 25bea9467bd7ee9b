// SPDX-License-Identifier: MIT
/// The output files of `catena render`. A numbered name ("turn_%03d.png") denotes one file per frame of a sequence; a plain name denotes
/// the image of the first frame.
#pragma once
#include <string>
#include <vector>

#include "engine/app/cli/io_conflicts.h"
#include "engine/app/render/image_sinks.h"
#include "engine/app/render/render_options.h"
#include "render/frame/frame_packet.h"

namespace catena::app {

/// Whether a file name has a number pattern such as %03d.
bool is_numbered(const std::string& path);
/// The file name of one frame; a plain name is returned unchanged.
std::string numbered_path(const std::string& path, int frame);

/// Describes the contents of a packet: "1 volume, 3 streamlines, 1 cursor"; "nothing" if it is empty.
std::string describe_contents(const render::FramePacket& packet);

/// Checks the outputs before any work. Error: an unknown file extension, no ffmpeg, a size that a video cannot hold, a video of one frame,
/// or an output that is an input or another output.
Outcome check_outputs(const RenderOptions& options, const ImageFormat& shape, int frames, IoConflictChecker files);
/// Whether an output is standard output; messages of the program then go to standard error.
bool uses_standard_output(const RenderOptions& options);
/// The channels that the rendered bands need for these outputs.
render::BandChannels required_band_channels(const RenderOptions& options);

/// Whether frames after the first are written.
bool takes_all_frames(const RenderOptions& options);

/// The files that are open while frames are rendered. Files with numbered names are committed at the end of their frame; videos, which take
/// all frames, and files with plain names, which take the first frame, are committed together in commit().
class Outputs {
 public:
  Outputs(const RenderOptions& options, const ImageFormat& shape) : options_(options), shape_(shape) {}
  /// Opens the files of the frame.
  Outcome begin_frame(int frame);
  /// Writes a band of rows to all open files.
  Outcome write(const render::Band& band);
  /// Finishes the frame and commits its numbered files.
  Outcome end_frame();
  /// Flushes the remaining files.
  Outcome finish();
  /// Renames the remaining files to their final names.
  Outcome commit();
  double ms_per_frame() const {
    return frame_count_ > 0 ? write_ms_ / frame_count_ : 0;
  }  ///< Average time per frame spent on encoding and writing, ms

 private:
  Outcome open(const std::string& path, int frame, Result<std::unique_ptr<ImageSink>> (*opener)(const std::string&, const ImageFormat&));

  const RenderOptions& options_;
  ImageFormat shape_;
  std::vector<std::unique_ptr<ImageSink>> frame_sinks_, first_frame_sinks_, sequence_sinks_, finished_sinks_;
  int frame_ = 0, frame_count_ = 0;
  double write_ms_ = 0;
};

}  // namespace catena::app
