// SPDX-License-Identifier: MIT
/// Cost of recording: `put` compared with its tick, bytes per tick, and a servo at 4 kHz without lost ticks.
#include <cstdio>
#include <thread>

#include "engine/base/clock.h"
#include "engine/base/numbers.h"
#include "haptics/device/recorded_path.h"
#include "haptics/servo/log/writer.h"
#include "haptics/servo/servo.h"
#include "tests/bench/chain_bench.h"

namespace log_bench {

using namespace catena;
using namespace catena::bench;

std::unique_ptr<log::LogWriter> open_log(const HapticProgram& program) {
  auto writer = log::LogWriter::open("log_bench.catlog", {});
  CATENA_ASSERT(static_cast<bool>(writer));
  (*writer)->add_program(program);
  return std::move(*writer);
}

void LogPutBesideTheTick(benchmark::State& state) {
  const HapticProgram program = make_pair_program();
  const std::vector<ProbeSample> path = probe_path();
  std::vector<double> tick_ns, put_ns;
  log::LogStatus status;
  for (auto unused : state) {
    const auto writer = open_log(program);
    ChainState chain;
    ChainScratch scratch;
    HapticState out;
    for (const ProbeSample& probe : path) {
      const std::int64_t start = now_ns();
      tick(program, probe, chain, scratch, out);
      const std::int64_t between = now_ns();
      writer->put(probe, out);
      const std::int64_t end = now_ns();
      tick_ns.push_back(static_cast<double>(between - start));
      put_ns.push_back(static_cast<double>(end - between));
    }
    CATENA_ASSERT(static_cast<bool>(writer->finish()));
    status = writer->status();
  }
  state.counters["tick_ns"] = quantile(tick_ns, 0.5);
  state.counters["put_ns"] = quantile(put_ns, 0.5);
  state.counters["put_ns_p99"] = quantile(put_ns, 0.99);
  state.counters["put_by_tick"] = quantile(put_ns, 0.5) / quantile(tick_ns, 0.5);
  state.counters["bytes_a_tick"] = static_cast<double>(status.bytes) / static_cast<double>(status.ticks);
  state.counters["lost"] = static_cast<double>(status.lost);
  std::remove("log_bench.catlog");
}
BENCHMARK(LogPutBesideTheTick)->Unit(benchmark::kMillisecond);

void LogOfAServoAt4kHz(benchmark::State& state) {
  const auto program = std::make_shared<HapticProgram>(make_pair_program());
  std::vector<RecordedPath::Sample> samples;
  for (const ProbeSample& p : probe_path()) samples.push_back({p.t_s, p.position, p.buttons});
  log::LogStatus status;
  for (auto unused : state) {
    const auto writer = open_log(*program);
    RecordedPath device(samples);
    Servo servo(device, program, {.rate_hz = 4000, .max_ticks = samples.size(), .sink = writer.get()});
    CATENA_ASSERT(static_cast<bool>(servo.start()));
    while (servo.running()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    servo.stop();
    CATENA_ASSERT(static_cast<bool>(writer->finish()));
    status = writer->status();
  }
  state.counters["ticks"] = static_cast<double>(status.ticks);
  state.counters["lost"] = static_cast<double>(status.lost);
  state.counters["bytes_a_tick"] = static_cast<double>(status.bytes) / static_cast<double>(status.ticks);
  std::remove("log_bench.catlog");
}
BENCHMARK(LogOfAServoAt4kHz)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace log_bench
