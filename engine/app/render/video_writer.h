/// Frames into ffmpeg through a pipe (no shell, no library): .mp4 (H.264), .webm (VP9, with alpha if asked), .gif (one palette).
/// ImageWriteResult beside its place and renamed by commit(); without one nothing stays behind, and ffmpeg is ended. Colours are tagged
/// BT.709, limited range. One thread; SIGPIPE is ignored while one is open.
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

struct VideoFormat {
  std::uint32_t width = 0, height = 0;
  double fps = 25;
  bool alpha = false;  ///< frames are RGBA, straight; else RGB
};

/// By the name's end: "mp4", "webm", "gif".
std::optional<std::string> video_kind(const std::string& path);
bool supports_alpha(const std::string& path);

/// Refuses, before any work: no ffmpeg on PATH, a size that the format cannot hold.
Outcome check_video(const std::string& path, const VideoFormat& format);

class VideoWriter {
 public:
  static Result<VideoWriter> open(const std::string& path, const VideoFormat& format);
  ~VideoWriter();
  VideoWriter(VideoWriter&& other) noexcept;
  VideoWriter& operator=(VideoWriter&&) = delete;

  /// The next rows of the next frame, 8 bits a value.
  Outcome write_rows(std::span<const std::uint8_t> values);
  /// After the last frame: ffmpeg has ended well, or its last line.
  Outcome finish();
  /// The rename to the final name.
  Outcome commit();

 private:
  VideoWriter(std::string path, TemporaryFile part) : path_(std::move(path)), part_(std::move(part)) {}
  /// Closes the pipe and waits; the error of ffmpeg, if it failed.
  Outcome close_pipe();

  std::string path_;
  TemporaryFile part_;  ///< which ffmpeg writes
  pid_t child_ = -1;
  int pipe_ = -1;
  std::FILE* messages_ = nullptr;  ///< what ffmpeg says
  bool ignores_sigpipe_ = false;
  struct sigaction saved_action_ {};
};

}  // namespace catena::app
