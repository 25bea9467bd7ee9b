#include "render/quality/drawing_clock.h"

#include <algorithm>
#include <cstdlib>
#include <thread>

#include "engine/base/clock.h"
#include "render/vk/stopwatch.h"

namespace catena::render {
namespace {

constexpr double kUneven = 1.1;  // of the ideal time: threads wait for each other

/// Of a driver that draws with the processor: a thread a core, or as many as it is told.
double drawing_threads() {
  const double cores = std::max(1u, std::thread::hardware_concurrency());
  const char* told = std::getenv("LP_NUM_THREADS");
  const double threads = told != nullptr ? std::atof(told) : cores;
  return threads >= 1 ? std::min(threads, cores) : cores;
}

}  // namespace

DrawingClock::DrawingClock(Renderer& renderer)
    : DrawingClock(renderer, renderer.device().info().is_cpu()          ? By::processor
                             : renderer.device().stopwatch().measures() ? By::device
                                                                        : By::wall) {}

DrawingClock::DrawingClock(Renderer& renderer, By by) : renderer_(&renderer), by_(by), start_ns_(now_ns()) {}

double DrawingClock::now_ns() const {
  if (by_ == By::device) return renderer_->device().counters().work_ns;
  return double(by_ == By::processor ? processor_ns() : catena::now_ns());
}

double DrawingClock::ms() const {
  const double ms = 1e-6 * (now_ns() - start_ns_);
  return by_ == By::processor ? kUneven * ms / drawing_threads() : ms;
}

Result<double> drawing_ms(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings) {
  const DrawingClock clock(renderer);
  CATENA_CHECK(renderer.draw(packet, settings));
  return clock.ms();
}

}  // namespace catena::render
