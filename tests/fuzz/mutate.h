// SPDX-License-Identifier: MIT
/// Deterministic mutations of a text (bytes flipped, cut, duplicated, swapped; tokens dropped or inserted), and the loops of the fuzz
/// tests.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace catena::test {

/// splitmix64 generator: seeded and portable.
struct Random {
  std::uint64_t state;
  std::uint64_t next() {
    std::uint64_t z = (state += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  std::size_t below(std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(next() % n); }
};

/// The inputs of a fuzz test: `max_count`, or CATENA_FUZZ_INPUTS, or as many as fit CATENA_FUZZ_SECONDS. CATENA_FUZZ_SEED: another seed.
class FuzzInputs {
 public:
  FuzzInputs(std::uint64_t max_count, std::uint64_t seed) : random{seed}, max_count_(number("CATENA_FUZZ_INPUTS", max_count)) {
    random.state += 1000003 * number("CATENA_FUZZ_SEED", 0);
    if (const std::uint64_t seconds = number("CATENA_FUZZ_SECONDS", 0); seconds > 0) {
      timed_ = true;
      deadline_ = Clock::now() + std::chrono::seconds(seconds);
    }
  }
  /// True while there is another input.
  bool next() {
    if (timed_ ? Clock::now() >= deadline_ : count_ >= max_count_) return false;
    ++count_;
    return true;
  }
  /// Number of inputs so far.
  std::uint64_t count() const { return count_; }
  bool is_long_run() const { return timed_ || std::getenv("CATENA_FUZZ_INPUTS") != nullptr; }
  /// Value of an environment variable.
  static std::uint64_t number(const char* variable, std::uint64_t otherwise) {
    const char* text = std::getenv(variable);
    return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
  }
  Random random;

 private:
  using Clock = std::chrono::steady_clock;
  std::uint64_t max_count_, count_ = 0;
  bool timed_ = false;
  Clock::time_point deadline_;
};

inline constexpr std::string_view kTokens[] = {"{",         "}",    "[",      "]",       ",",     ":",    "\"",
                                               "\\",        "\n",   "\r",     "null",    "1e999", "-1",   "0",
                                               "NaN",       "inf",  "1e-400", "//",      "/*",    "*/",   "\xEF\xBB\xBF",
                                               "\xff",      "true", "[[[[",   "{\"a\":", "0.5",   "-0.0", "99999999999999999999",
                                               "\"field\"", ",,",   "\t",     " "};

inline std::string mutate(std::string text, Random& random) {
  const std::size_t changes = 1 + random.below(4);
  for (std::size_t i = 0; i < changes; ++i) {
    const std::size_t at = random.below(text.size() + 1), length = random.below(24);
    const std::string_view spice = kTokens[random.below(std::size(kTokens))];
    switch (random.below(7)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ static_cast<char>(1u << random.below(8)));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(random.below(text.size() + 1), length));
        break;
      case 3:
        text.insert(at, spice);
        break;
      case 4:
        text.replace(at, std::min(length, text.size() - at), spice);
        break;
      case 5:
        text.insert(at, 1, static_cast<char>(random.below(256)));
        break;
      default:
        if (random.below(20) == 0) text.insert(at, std::string(1 + random.below(300), random.below(2) == 0 ? '[' : '{'));
    }
  }
  return text;
}

/// Expects an error message of one line that begins with the file's name, is shorter than `max_size` and says what was `expected`.
inline void expect_error_line(const std::string& message, const std::string& begin, const std::string& input, std::size_t max_size = 500,
                              const char* expected = "expected") {
  EXPECT_TRUE(message.starts_with(begin)) << message << "\nfor\n" << input;
  EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos) << message << "\nfor\n" << input;
  EXPECT_NE(message.find(expected), std::string::npos) << message;
  EXPECT_LT(message.size(), max_size) << message;
}

/// Calls accepts(text) for every truncation and every byte flip of `whole`; truncations to fewer than `refused` bytes must be refused.
template <class Accepts>
void truncate_and_flip(const std::string& whole, const Accepts& accepts, std::size_t refused = 0) {
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const bool is_accepted = accepts(whole.substr(0, n));
    EXPECT_FALSE(is_accepted && n < refused) << n;
    std::string flipped = whole;
    flipped[n] = static_cast<char>(flipped[n] ^ 0x81);
    accepts(flipped);
  }
}

struct FuzzCounts {
  std::uint64_t accepted, inputs;
};

/// Sums accepts(random, n) over the inputs n = 1, 2, ... until a check fails; the sum must be between 0 and `most` per input, exclusive.
template <class Accepts>
FuzzCounts fuzz(std::uint64_t max_count, std::uint64_t seed, const Accepts& accepts, double most = 1) {
  FuzzInputs inputs(max_count, seed);
  std::uint64_t accepted = 0;
  while (inputs.next() && !testing::Test::HasFailure()) accepted += static_cast<std::uint64_t>(accepts(inputs.random, inputs.count()));
  EXPECT_GT(accepted, 0u);
  EXPECT_LT(static_cast<double>(accepted), most * static_cast<double>(inputs.count()));
  return {accepted, inputs.count()};
}

}  // namespace catena::test
