// SPDX-License-Identifier: MIT
/// Random numbers that are identical on every system, unlike the distributions of the standard library. Only integer operations, + - * /
/// and, for normal numbers, square roots and logarithms are used (the latter repeat on one type of system only). Any thread, with one
/// generator per thread.
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

/// Random number generator: splitmix64 with a seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Returns 64 random bits.
  std::uint64_t next() {
    const std::uint64_t out = mix_bits(state_);
    state_ += 0x9e3779b97f4a7c15u;
    return out;
  }
  /// Returns a number in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  /// Returns a number between lo and hi.
  double between(double lo, double hi) { return lo + (hi - lo) * uniform(); }
  /// Returns an integer in [0, count). The bias of at most count / 2^64 is accepted.
  std::uint64_t below(std::uint64_t count) { return next() % count; }
  /// Returns a normally distributed number, mean 0, standard deviation 1: G. Marsaglia's polar method.
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
