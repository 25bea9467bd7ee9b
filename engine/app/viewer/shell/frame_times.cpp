#include "engine/app/viewer/shell/frame_times.h"

#include <fmt/format.h>

namespace catena::app {

namespace {

constexpr std::int64_t kPauseNs = 1'000'000'000;

std::string figures_json(const haptics::HistogramFigures& f) {
  std::string bins;
  for (const auto& bin : f.bins) bins += fmt::format("{}[{:.6g}, {}]", bins.empty() ? "" : ", ", bin.from_us, bin.count);
  return fmt::format(R"({{"p50": {:.6g}, "p99": {:.6g}, "p999": {:.6g}, "max": {:.6g}, "count": {}, "bins": [{}]}})", f.p50_us, f.p99_us,
                     f.p999_us, f.max_us, f.count, bins);
}

}  // namespace

void FrameTimes::add(double ms, std::int64_t now_ns) {
  draw_.add(static_cast<std::int64_t>(1e6 * ms));
  if (last_ns_ != 0 && now_ns - last_ns_ < kPauseNs) period_.add(now_ns - last_ns_);
  last_ns_ = now_ns;
  recent_[recent_first()] = static_cast<float>(ms);
  ++count_;
}

std::string FrameTimes::json() const {
  return fmt::format("{{\"frames\": {},\n \"draw_us\": {},\n \"period_us\": {},\n \"interface_us\": {}}}\n", count_, figures_json(draw()),
                     figures_json(period()), figures_json(interface()));
}

}  // namespace catena::app
