#include "engine/app/study/tick_tap.h"

#include <array>
#include <bit>

namespace catena::app {

TickTap::TickTap(std::size_t ticks) : ring_(8 * kWords * ticks) {}

void TickTap::begin(haptics::TickSink* next) {
  while (take()) continue;
  lost_.store(false, std::memory_order_relaxed);
  next_ = next;
}

std::optional<TappedTick> TickTap::take() {
  if (ring_.available() < kWords) return std::nullopt;
  std::array<std::uint64_t, kWords> words;
  ring_.take(words);
  const auto number = [&](std::size_t k) { return std::bit_cast<double>(words[k]); };
  return TappedTick{words[0], number(1), Vec3(number(2), number(3), number(4)), Vec3(number(5), number(6), number(7)), words[8] != 0};
}

void TickTap::begin(const haptics::ChainState& state) noexcept {
  if (next_ != nullptr) next_->begin(state);
}

void TickTap::put(const haptics::ProbeSample& input, const exchange::HapticState& output) noexcept {
  if (next_ != nullptr) next_->put(input, output);
  const auto bits = [](double number) { return std::bit_cast<std::uint64_t>(number); };
  const Vec3 &p = output.probe, &f = output.force_n;
  const bool good = output.condition != exchange::Condition::no_device && output.condition != exchange::Condition::watchdog;
  const std::array<std::uint64_t, kWords> words{output.program_epoch,
                                                bits(output.t_s),
                                                bits(p.x),
                                                bits(p.y),
                                                bits(p.z),
                                                bits(f.x),
                                                bits(f.y),
                                                bits(f.z),
                                                static_cast<std::uint64_t>(good)};
  if (!ring_.put(words)) lost_.store(true, std::memory_order_release);
}

}  // namespace catena::app
