// SPDX-License-Identifier: MIT
/// Writes frames to a video through a pipe to ffmpeg (no shell, no library): .mp4 (H.264), .webm (VP9, with alpha if requested), .gif (one
/// palette). The video is written to a temporary file in the same folder and renamed by commit(); without commit() the file is removed and
/// ffmpeg is killed. Colors of .mp4 and .webm are tagged BT.709, limited range. One thread; SIGPIPE is ignored while a writer is open.
#pragma once
#include <sys/types.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>

#include "engine/base/output_file.h"
#include "engine/base/result.h"

namespace catena::app {

/// Format of the frames.
struct VideoFormat {
  std::uint32_t width = 0, height = 0;
  double fps = 25;
  bool alpha = false;  ///< Frames are RGBA with straight alpha; false: RGB
};

/// The kind of video by file extension, "mp4", "webm" or "gif"; empty for other extensions.
std::optional<std::string> video_kind(const std::string& path);
/// Whether the format of the file can hold alpha: .webm only.
bool supports_alpha(const std::string& path);

/// Error if ffmpeg is not on PATH or the format cannot hold the frame size (an .mp4 needs an even width and height).
Outcome check_video(const std::string& path, const VideoFormat& format);

class VideoWriter {
 public:
  /// Starts ffmpeg. Error: as check_video(), or a system failure.
  static Result<VideoWriter> open(const std::string& path, const VideoFormat& format);
  ~VideoWriter();
  VideoWriter(VideoWriter&& other) noexcept;
  VideoWriter& operator=(VideoWriter&&) = delete;

  /// Writes the next rows of the current frame, 8 bits per value. Error: ffmpeg ended; contains its last line of output.
  Outcome write_rows(std::span<const std::uint8_t> values);
  /// Call after the last frame: waits for ffmpeg. Error: ffmpeg failed; contains its last line of output.
  Outcome finish();
  /// Renames the temporary file to its final name.
  Outcome commit();

 private:
  VideoWriter(std::string path, TemporaryFile part) : path_(std::move(path)), part_(std::move(part)) {}
  /// Closes the pipe and waits for ffmpeg. Error: ffmpeg failed.
  Outcome close_pipe();

  std::string path_;
  TemporaryFile part_;  ///< Temporary file that ffmpeg writes
  pid_t child_ = -1;
  int pipe_ = -1;
  std::FILE* messages_ = nullptr;  ///< ffmpeg's error output
  bool ignores_sigpipe_ = false;
  struct sigaction saved_action_ {};
};

}  // namespace catena::app
