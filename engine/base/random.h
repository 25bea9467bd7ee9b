/// Random numbers that are the same on every machine: the standard library's distributions are not. Only whole numbers, + - * / and, of
/// normal numbers, square roots and logarithms (those repeat on one type of machine).
/// Any thread, each its own.
#pragma once
#include <cmath>
#include <cstdint>

namespace catena {

/// Mixes the bits of a number (splitmix64, by S. Vigna).
inline std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// One stream of them: splitmix64 from a seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    const std::uint64_t out = mix_bits(state_);
    state_ += 0x9e3779b97f4a7c15u;
    return out;
  }
  /// 0 <= x < 1, multiples of 2^-53.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double between(double lo, double hi) { return lo + (hi - lo) * uniform(); }
  /// 0 <= n < count; the bias of at most count / 2^64 is accepted.
  std::uint64_t below(std::uint64_t count) { return next() % count; }
  /// Mean 0, standard deviation 1: G. Marsaglia's polar method.
  double normal() {
    while (true) {
      const double u = 2 * uniform() - 1, v = 2 * uniform() - 1, s = u * u + v * v;
      if (s < 1 && s > 0) return u * std::sqrt(-2 * std::log(s) / s);
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace catena
