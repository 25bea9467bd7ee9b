/// The haptic thread: a thin shell around the tick. Wakes at absolute deadlines, reads the device, takes the newest program
/// (never waits), runs the tick, writes the force, publishes one HapticState.
/// Two threads touch a Servo: the frame side calls the public functions, the haptic thread runs the loop. They share two
/// triple buffers and one flag, all lock-free. The haptic thread never frees: programs are kept by the frame side until a
/// published epoch shows that a newer one has run.
#pragma once
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "engine/exchange/triple_buffer.h"
#include "haptics/chain/rebind.h"
#include "haptics/chain/state_hash.h"
#include "haptics/device/device.h"
#include "haptics/servo/tick_sink.h"

namespace catena::haptics {

struct ServoOptions {
  double rate_hz = 1000;
  bool paced = true;            ///< false: as fast as it goes (soaks, determinism)
  std::uint64_t max_ticks = 0;  ///< 0: until stop()
  TickSink* sink = nullptr;     ///< gets every tick; outlives the servo
};

class Servo {
 public:
  /// The device must outlive the servo. Nothing runs before start().
  Servo(Device& device, std::shared_ptr<const Program> program, const ServoOptions& options = {});
  ~Servo();
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;

  // frame side
  void start();
  void stop();  ///< joins; the device has had a last zero force
  void set_program(std::shared_ptr<const Program> program);
  bool take(exchange::HapticState& state);  ///< true if there was something newer
  bool running() const { return running_.load(std::memory_order_acquire); }
  std::uint64_t state_hash() const { return hash_.value(); }  ///< after stop()
  std::size_t programs_alive() const { return programs_.size(); }

 private:
  void loop() noexcept;
  void one_tick(double t_s, exchange::HapticState& out) noexcept;

  Device& device_;
  ServoOptions options_;
  exchange::TripleBuffer<const Program*> next_program_;
  exchange::TripleBuffer<exchange::HapticState> published_;
  std::atomic<bool> stop_{false}, running_{false};

  // haptic thread only, once started
  const Program* program_ = nullptr;
  ChainState state_;
  ChainScratch scratch_;
  StateHash hash_;

  // frame side only
  std::vector<std::shared_ptr<const Program>> programs_;
  std::thread thread_;
};

}  // namespace catena::haptics
