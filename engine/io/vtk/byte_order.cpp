// SPDX-License-Identifier: MIT
#include "engine/io/vtk/byte_order.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <vector>

#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::vtk {
namespace {

template <class T>
T byte_swapped(T v) {
  char raw[sizeof(T)];
  std::memcpy(raw, &v, sizeof v);
  std::reverse(raw, raw + sizeof v);
  std::memcpy(&v, raw, sizeof v);
  return v;
}

template <class T>
bool numbers_look_swapped(const T* numbers, std::size_t count, bool is_legacy) {
  if constexpr (std::is_floating_point_v<T>) {
    // decimal exponents
    std::vector<double> as_read, swapped;
    for (std::size_t i = 0; i < count; ++i) {
      const T other = byte_swapped(numbers[i]);
      if (numbers[i] == 0 || other == 0) continue;
      as_read.push_back(std::isfinite(numbers[i]) ? std::log10(std::fabs(static_cast<double>(numbers[i]))) : 400);
      swapped.push_back(std::isfinite(other) ? std::log10(std::fabs(static_cast<double>(other))) : 400);
    }
    constexpr std::size_t kMinNumbers = 8;
    if (as_read.size() < kMinNumbers) return false;
    const double low = quantile(as_read, 0.1), high = quantile(as_read, 0.9), swapped_low = quantile(swapped, 0.1),
                 swapped_high = quantile(swapped, 0.9);
    const bool implausible = high < -30 || low > 30 || high - low > 20;
    return implausible && swapped_low > -15 && swapped_high < 15 && swapped_high - swapped_low < 10;
  } else {
    double as_read = 0, swapped = 0;
    for (std::size_t i = 0; i + 1 < count; ++i) {
      as_read += std::fabs(static_cast<double>(numbers[i + 1]) - static_cast<double>(numbers[i]));
      swapped += std::fabs(static_cast<double>(byte_swapped(numbers[i + 1])) - static_cast<double>(byte_swapped(numbers[i])));
    }
    // with swapped bytes, small integers become multiples of 256 or of higher powers
    constexpr double kLargeStep = 4096, kMuchLess = 8, kAlmostNothing = 64;
    const bool small = is_legacy && kAlmostNothing * swapped < as_read;
    return count >= 16 && (small || (as_read >= kLargeStep * static_cast<double>(count - 1) && kMuchLess * swapped < as_read));
  }
}

}  // namespace

bool looks_byte_swapped(vtkDataArray& array, std::string_view path) {
  constexpr std::size_t kMaxNumbers = 100'000;
  if (!array.HasStandardMemoryLayout() || array.GetNumberOfTuples() == 0) return false;
  const std::size_t all = static_cast<std::size_t>(array.GetNumberOfTuples()) * static_cast<std::size_t>(array.GetNumberOfComponents());
  const bool is_legacy = has_extension(path, ".vtk");
  const auto looks_swapped = [&]<class T>(const T* numbers) {
    return sizeof(T) > 1 && numbers_look_swapped(numbers, std::min(all, kMaxNumbers), is_legacy);
  };
  switch (array.GetDataType()) { vtkTemplateMacro(return looks_swapped(static_cast<const VTK_TT*>(array.GetVoidPointer(0)))); }
  return false;
}

std::string byte_order_advice(std::string_view path) {
  const std::string swapped = "the numbers look as if their bytes were in the other order";
  if (has_extension(path, ".vtk"))
    return swapped + ": a BINARY legacy .vtk must be big-endian; save the data in this order, or as .vti, .vtu or .vtp";
  if (has_extension(path, ".nrrd") || has_extension(path, ".nhdr")) return swapped + ": see \"endian:\" in the header";
  if (has_extension(path, ".mha") || has_extension(path, ".mhd")) return swapped + ": see \"BinaryDataByteOrderMSB\" in the header";
  if (has_extension(path, ".ply")) return swapped + ": see \"format\" in the header";
  if (has_extension(path, ".npz")) return swapped + ": see the dtype of the arrays (\"<f4\", \">f4\")";
  return swapped + ": see \"byte_order\" or a similar key in the header";
}

}  // namespace catena::vtk
