// SPDX-License-Identifier: MIT
/// Recorder of every tick of a servo: `put` copies a tick into a ring buffer and returns; the writer's thread writes the blocks (format.h).
///
/// Three threads: the frame thread opens the log, adds programs, reads the status and finishes; the haptic thread calls `put`; the writer's
/// thread empties the ring every `flush_s` (one write(2) per block) and calls fdatasync every `sync_s`. `put` never waits for a thread.
/// If the process is killed, all but about the last `flush_s` is kept; if the power fails, all but about the last `sync_s`.
/// Losses are reported: a full ring leaves a gap block; a failed write (disk full) is in the status at once, and finish() returns it.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "haptics/servo/log/contents.h"
#include "haptics/servo/log/poses.h"
#include "haptics/servo/servo.h"

namespace catena::haptics::log {

/// Options of a recording.
struct LogOptions {
  std::size_t ring_bytes = std::size_t{16} << 20;  ///< size of the ring; with 8 links at 4 kHz it bridges 2.7 s without a write
  double flush_s = 0.05;                           ///< interval of the writes, seconds
  double sync_s = 1;                               ///< interval of fdatasync, seconds
};

/// Status of a recording, readable while it runs.
struct LogStatus {
  std::uint64_t ticks = 0;  ///< number of ticks written
  std::uint64_t lost = 0;   ///< number of ticks not written, because the ring was full or writing has failed
  std::uint64_t bytes = 0;  ///< bytes written
  bool failed = false;      ///< writing has failed and recording has stopped; finish() returns the error
};

/// Recorder of a servo's ticks. Threads: see the file comment.
class LogWriter final : public TickSink {
 public:
  /// Checks the path as for every output (engine/base/output_file.h; files in `inputs` must not be overwritten), creates or replaces the
  /// file, writes the header and starts the writer's thread. The file exists while it is written. An Error if the path is not allowed, the
  /// scene text is longer than 32 MiB, or the file or thread cannot be created.
  static Result<std::unique_ptr<LogWriter>> open(const std::string& path, LogHeader header, const std::vector<std::string>& inputs = {},
                                                 const LogOptions& options = {});
  ~LogWriter() override;  ///< finishes and prints an error; call finish() to get it

  /// Adds a program. Frame thread, before the servo can run it. The first one must be that with which the servo starts, or that it runs
  /// when it starts to use the log (Servo::set_sink). Every program needs a unique epoch, as build_program() provides. `scene_text`:
  /// present scene text; none: the header's.
  void add_program(const HapticProgram& program, std::optional<std::string> scene_text = {});

  /// Adds the poses of a frame that a headset is about to display. Frame thread. Returns false if they are dropped, because the recording
  /// has ended or failed, or because kMaxPendingPoses of them are waiting to be written.
  bool add_poses(const LogPoses& poses);
  static constexpr std::size_t kMaxPendingPoses = 4096;  ///< maximum number of poses that wait to be written

  // haptic thread
  void begin(const ChainState& state) noexcept override;
  void put(const ProbeSample& input, const HapticState& output) noexcept override;

  // planning thread of the pager of bricks
  void add_bricks(const field::BrickSnapshot& bricks) override;

  /// Returns the status. Frame thread, at any time.
  LogStatus status() const;
  /// Writes the rest and the end block, and closes the file. Frame thread, after the servo has stopped or uses another sink.
  /// The Error is one line: the cause, and with which tick the recording ends.
  Outcome finish();

 private:
  struct Impl;
  explicit LogWriter(std::unique_ptr<Impl> parts);
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::haptics::log
