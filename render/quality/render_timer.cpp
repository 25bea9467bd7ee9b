// SPDX-License-Identifier: MIT
#include "render/quality/render_timer.h"

#include <algorithm>
#include <cstdlib>
#include <thread>

#include "engine/base/clock.h"
#include "render/vk/timestamp_query.h"

namespace catena::render {
namespace {

constexpr double kThreadImbalance = 1.1;  // factor on the ideal time, because threads wait for each other

/// Returns the number of threads of a driver that draws on the CPU: one per core, or LP_NUM_THREADS.
double drawing_threads() {
  const double cores = std::max(1u, std::thread::hardware_concurrency());
  const char* report = std::getenv("LP_NUM_THREADS");
  const double threads = report != nullptr ? std::atof(report) : cores;
  return threads >= 1 ? std::min(threads, cores) : cores;
}

}  // namespace

RenderTimer::RenderTimer(Renderer& renderer)
    : RenderTimer(renderer, renderer.device().info().is_cpu()               ? ClockSource::cpu
                            : renderer.device().timestamps().is_supported() ? ClockSource::gpu
                                                                            : ClockSource::wall) {}

RenderTimer::RenderTimer(Renderer& renderer, ClockSource by) : renderer_(&renderer), source_(by), start_ns_(now_ns()) {}

double RenderTimer::now_ns() const {
  if (source_ == ClockSource::gpu) return renderer_->device().counters().gpu_ns;
  return double(source_ == ClockSource::cpu ? process_cpu_ns() : catena::now_ns());
}

double RenderTimer::elapsed_ms() const {
  const double ms = 1e-6 * (now_ns() - start_ns_);
  return source_ == ClockSource::cpu ? kThreadImbalance * ms / drawing_threads() : ms;
}

Result<double> measure_render_ms(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings) {
  const RenderTimer clock(renderer);
  CATENA_CHECK(renderer.draw(packet, settings));
  return clock.elapsed_ms();
}

}  // namespace catena::render
