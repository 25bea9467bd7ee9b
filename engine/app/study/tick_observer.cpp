// SPDX-License-Identifier: MIT
#include "engine/app/study/tick_observer.h"

#include <array>
#include <bit>

namespace catena::app {

TickObserver::TickObserver(std::size_t ticks) : ring_(8 * kWordsPerTick * ticks) {}

void TickObserver::begin(haptics::TickSink* next) {
  while (pop()) continue;
  has_lost_ticks_.store(false, std::memory_order_relaxed);
  next_sink_ = next;
}

std::optional<ObservedTick> TickObserver::pop() {
  if (ring_.available() < kWordsPerTick) return std::nullopt;
  std::array<std::uint64_t, kWordsPerTick> words;
  ring_.pop(words);
  const auto number = [&](std::size_t k) { return std::bit_cast<double>(words[k]); };
  return ObservedTick{words[0], number(1), Vec3(number(2), number(3), number(4)), Vec3(number(5), number(6), number(7)), words[8] != 0};
}

void TickObserver::begin(const haptics::ChainState& state) noexcept {
  if (next_sink_ != nullptr) next_sink_->begin(state);
}

void TickObserver::put(const haptics::ProbeSample& input, const HapticState& output) noexcept {
  if (next_sink_ != nullptr) next_sink_->put(input, output);
  const auto bits = [](double number) { return std::bit_cast<std::uint64_t>(number); };
  const Vec3 &p = output.probe, &f = output.force_n;
  const bool good = output.condition != TickCondition::no_device && output.condition != TickCondition::watchdog;
  const std::array<std::uint64_t, kWordsPerTick> words{output.program_epoch,
                                                       bits(output.t_s),
                                                       bits(p.x),
                                                       bits(p.y),
                                                       bits(p.z),
                                                       bits(f.x),
                                                       bits(f.y),
                                                       bits(f.z),
                                                       static_cast<std::uint64_t>(good)};
  if (!ring_.try_push(words)) has_lost_ticks_.store(true, std::memory_order_release);
}

}  // namespace catena::app
