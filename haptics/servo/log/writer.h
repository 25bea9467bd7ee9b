/// Records every tick of a servo: `put` copies a tick into a ring and returns; a thread of its own writes the blocks (format.h).
///
/// Three threads: the frame side opens, adds programs, asks for the status and finishes; the haptic thread calls `put`; the writer's
/// own thread drains the ring every `flush_s` (one write(2)) and calls fdatasync every `sync_s`. None of them waits for another in `put`.
/// What is kept: if the process is killed, all but about the last `flush_s`; if the power fails, all but about the last `sync_s`.
/// What is lost is said: a full ring leaves a gap block, a failed write (disk full) a status at once and one line at the end.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "haptics/servo/log/contents.h"
#include "haptics/servo/log/poses.h"
#include "haptics/servo/servo.h"

namespace catena::haptics::log {

struct LogOptions {
  std::size_t ring_bytes = std::size_t{16} << 20;  ///< 8 links at 4 kHz: 2.7 s that the disk may stand still
  double flush_s = 0.05;
  double sync_s = 1;
};

/// Readable while it runs.
struct LogStatus {
  std::uint64_t ticks = 0;  ///< written
  std::uint64_t lost = 0;   ///< not written: the ring was full, or writing has failed
  std::uint64_t bytes = 0;
  bool failed = false;  ///< writing has failed: nothing is recorded any more; finish() says why
};

class LogWriter final : public TickSink {
 public:
  /// Checks the place as every output (engine/base/output_file.h: `inputs` are what it must not overwrite), then replaces what is
  /// there: a log exists while it is written. Records nothing before the first put.
  static Result<std::unique_ptr<LogWriter>> open(const std::string& path, LogHeader header, const std::vector<std::string>& inputs = {},
                                                 const LogOptions& options = {});
  ~LogWriter() override;  ///< finishes; call finish() to hear of errors

  /// Frame side, before the servo can run it; the first one is that with which the servo begins, or that it runs when it takes the log
  /// up (Servo::set_sink). Every set_program needs a program of an
  /// epoch of its own, as build_program gives it. `scene_text`: that of the moment; none: still the header's.
  void add_program(const HapticProgram& program, std::optional<std::string> scene_text = {});

  /// Frame side: of a picture that a headset is about to show. False: it is left out, since nothing is written any more or the disk does
  /// not keep up with kMaxPendingPoses of them.
  bool add_poses(const LogPoses& poses);
  static constexpr std::size_t kMaxPendingPoses = 4096;

  // haptic thread
  void begin(const ChainState& state) noexcept override;
  void put(const ProbeSample& input, const HapticState& output) noexcept override;

  /// Frame side, any time.
  LogStatus status() const;
  /// Frame side, after the servo has stopped or let go of it: writes the rest and the end. The error is one line: what, and which ticks it
  /// costs.
  Outcome finish();

 private:
  struct Impl;
  explicit LogWriter(std::unique_ptr<Impl> parts);
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::haptics::log
