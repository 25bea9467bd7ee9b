#include "haptics/servo/report.h"

#include <fmt/format.h>

#include "engine/base/json_text.h"

namespace catena::haptics {

namespace {

std::string figures_json(const char* name, const HistogramFigures& f) {
  std::string bins;
  for (const HistogramFigures::Bin& bin : f.bins) bins += fmt::format("{}[{:.3f}, {}]", bins.empty() ? "" : ", ", bin.from_us, bin.count);
  return fmt::format(
      "  \"{}\": {{\"p50\": {:.3f}, \"p99\": {:.3f}, \"p999\": {:.3f}, \"max\": {:.3f}, \"count\": {},\n    \"bins\": [{}]}},\n", name,
      f.p50_us, f.p99_us, f.p999_us, f.max_us, f.count, bins);
}

std::string figures_line(const char* name, const HistogramFigures& f) {
  return fmt::format("  {:<8} {:>10.2f} {:>10.2f} {:>10.2f} {:>10.2f}\n", name, f.p50_us, f.p99_us, f.p999_us, f.max_us);
}

}  // namespace

std::string servo_json(const ServoReport& r, const std::string& device_name, std::uint64_t state_hash) {
  std::string notes;
  for (const std::string& note : r.realtime.notes) notes += (notes.empty() ? "" : ", ") + json_string(note);
  std::string out = fmt::format(
      "{{\n  \"device\": {},\n  \"rate_hz\": {},\n  \"seconds\": {:.6f},\n  \"ticks\": {},\n  \"missed_deadlines\": {},\n"
      "  \"late_ticks\": {},\n  \"lost_ticks\": {},\n  \"watchdog_trips\": {},\n"
      "  \"realtime\": {{\"fifo\": {}, \"locked\": {}, \"cpu\": {}, \"notes\": [{}]}},\n",
      json_string(device_name), r.rate_hz, r.seconds, r.ticks, r.missed_deadlines, r.late_ticks, r.lost_ticks, r.watchdog_trips,
      r.realtime.fifo, r.realtime.locked, r.realtime.cpu < 0 ? "null" : std::to_string(r.realtime.cpu), notes);
  out += figures_json("period_us", r.period) + figures_json("compute_us", r.compute) + figures_json("device_us", r.device);
  return out + fmt::format("  \"state_hash\": \"{:016x}\"\n}}\n", state_hash);
}

std::string servo_summary(const ServoReport& r, const std::string& device_name) {
  std::string out = fmt::format("{}: {} ticks in {:.2f} s, {} missed deadlines, {} late, {} without the device, {} watchdog trips\n",
                                device_name, r.ticks, r.seconds, r.missed_deadlines, r.late_ticks, r.lost_ticks, r.watchdog_trips);
  out += fmt::format("  {:<8} {:>10} {:>10} {:>10} {:>10}\n", "us", "p50", "p99", "p99.9", "max");
  out += figures_line("period", r.period) + figures_line("compute", r.compute) + figures_line("device", r.device);
  const std::string core = r.realtime.cpu < 0 ? "any core" : fmt::format("core {}", r.realtime.cpu);
  return out + fmt::format("  {} priority, memory {}, {}\n", r.realtime.fifo ? "real-time" : "normal",
                           r.realtime.locked ? "locked" : "not locked", core);
}

}  // namespace catena::haptics
