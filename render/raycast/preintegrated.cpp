#include "render/raycast/preintegrated.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/raycast/transfer_lut.h"

namespace catena::render {
namespace {

constexpr int kCodes = 256, kFine = 16;  // samples a code
constexpr int kSamples = (kCodes - 1) * kFine + 1;

/// sigma, and sigma times red, green, blue.
using Look = std::array<double, 4>;

Look look_at(const TransferTable& table, double value) {
  const double sigma = table_value(table, value, 3);
  if (!(sigma > 0)) return {};
  return {sigma, sigma * table_value(table, value, 0), sigma * table_value(table, value, 1), sigma * table_value(table, value, 2)};
}

std::uint32_t quantised(double share, double greatest) { return std::uint32_t(std::lround(std::clamp(share, 0.0, 1.0) * greatest)); }

std::array<std::uint32_t, 2> entry(const Look& mean) {
  if (!(mean[0] > 0)) return {};
  return {std::bit_cast<std::uint32_t>(float(mean[0])),
          quantised(mean[1] / mean[0], 2047) | quantised(mean[2] / mean[0], 2047) << 11 | quantised(mean[3] / mean[0], 1023) << 22};
}

}  // namespace

ValueInterval active_interval(const TransferTable& table, const ValueInterval& values, bool shaded) {
  constexpr int last = 4096;
  const auto value = [&](int i) { return values.least + (values.greatest - values.least) * i / last; };
  std::vector<Look> looks(last + 1);
  for (int i = 0; i <= last; ++i) looks[i] = look_at(table, value(i));
  int first = 0, final = last;
  const auto trims = [&](const Look& end) { return !shaded || !(end[0] > 0); };
  while (trims(looks[0]) && first < last && looks[first + 1] == looks[0]) ++first;
  while (trims(looks[last]) && final > first && looks[final - 1] == looks[last]) --final;
  return {value(first), value(final)};
}

PreintegratedTable make_preintegrated(const TransferTable& table, double lo, double per_code, bool shaded) {
  // running integrals by the trapezium rule
  std::vector<Look> looks(kSamples), integral(kSamples);
  PreintegratedTable out;
  for (int k = 0; k < kSamples; ++k) {
    looks[k] = look_at(table, lo + per_code * k / kFine);
    out.greatest_sigma = std::max(out.greatest_sigma, looks[k][0]);
    if (k > 0)
      for (int c = 0; c < 4; ++c) integral[k][c] = integral[k - 1][c] + 0.5 * (looks[k - 1][c] + looks[k][c]);
  }
  const auto mean = [&](int a, int b) {
    Look m;
    for (int c = 0; c < 4; ++c) m[c] = std::max(0.0, (integral[b][c] - integral[a][c]) / (b - a));
    return m;
  };

  // runs of codes between which nothing changes
  std::array<bool, kCodes> alike{};  // code and the next
  for (int a = 0; a + 1 < kCodes; ++a) {
    alike[a] = !shaded || !(looks[a * kFine][0] > 0);
    for (int k = a * kFine; k < (a + 1) * kFine && alike[a]; ++k) alike[a] = looks[k] == looks[k + 1];
    out.look[a + 1] = std::uint16_t(out.look[a] + (alike[a] ? 0 : 1));
  }

  out.entries.resize(std::size_t(kCodes) * kCodes);
  for (int a = 0; a < kCodes; ++a) {
    out.entries[std::size_t(a) * kCodes + a] = entry(looks[a * kFine]);
    for (int b = a + 1; b < kCodes; ++b) {
      const bool same = out.look[a] == out.look[b];
      out.entries[std::size_t(a) * kCodes + b] = out.entries[std::size_t(b) * kCodes + a] =
          entry(same ? looks[a * kFine] : mean(a * kFine, b * kFine));
    }
  }
  return out;
}

}  // namespace catena::render
