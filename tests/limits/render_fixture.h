// SPDX-License-Identifier: MIT
/// Rendering helpers of the rows: scenes drawn on the CPU driver with the validation layer, and raw files.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>

#include "render/extract/extract.h"
#include "render/passes/renderer.h"
#include "tests/limits/limits_table.h"
#include "tests/support/support.h"
#include "tests/support/vulkan.h"

namespace catena::extremes {

/// Removes the folder from an error message.
inline std::string without_folder(std::string message, const test::TemporaryFolder& folder) {
  for (auto at = message.find(folder.path()); at != std::string::npos; at = message.find(folder.path()))
    message.erase(at, folder.path().size() + 1);
  return message;
}

/// Draws a scene on the one device of all rows; an error, or a message of the validation layer, ends the row. `line_count`: number of
/// tubes.
inline render::Image8 draw(const std::string& text, const test::TemporaryFolder& folder, std::uint32_t width, std::uint32_t height,
                           std::size_t* line_count = nullptr) {
  static const std::unique_ptr<render::Renderer> renderer = [] {
    test::use_lavapipe();
    render::vk::DeviceOptions options;
    options.validation = true;
    options.device_filter = test::test_device();
    return get(render::Renderer::create(options));
  }();
  try {
    auto scene = get(scene::parse_scene(text, folder / "s.json"));
    const auto packet = get(render::make_frame(scene, width, height));
    if (line_count != nullptr) *line_count = packet.tubes.size();
    if (const Outcome drawn = renderer->draw(packet); !drawn) throw RowFailure{drawn.error().message};
    const render::Image8 picture = get(renderer->read_back());
    if (renderer->stats().validation_messages > 0) throw RowFailure{"the validation layer said " + renderer->validation_texts().front()};
    return picture;
  } catch (const RowFailure& failure) {
    throw RowFailure{without_folder(failure.message, folder)};
  }
}

template <class T>
std::string to_bytes(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// Writes a .raw file of n[0] x n[1] x n[2] floats.
inline void write_raw(const std::string& path, const std::array<int, 3>& n, const std::function<double(int, int, int)>& value) {
  std::vector<float> values;
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) values.push_back(static_cast<float>(value(x, y, z)));
  test::write_file(path, to_bytes(values));
}

inline std::string triple(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

/// Number of pixels with colours that differ by more than `more` of 255; all pixels if the sizes differ.
inline double count_differing(const render::Image8& a, const render::Image8& b, int more) {
  if (a.rgba.size() != b.rgba.size() || a.rgba.empty()) return 1;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    int maximum = 0;
    for (std::size_t c = 0; c < 4; ++c) maximum = std::max(maximum, std::abs(int(a.rgba[i + c]) - int(b.rgba[i + c])));
    count += maximum > more;
  }
  return 4.0 * static_cast<double>(count) / static_cast<double>(a.rgba.size());
}

/// Number of covered pixels over a transparent background.
inline double count_covered(const render::Image8& picture) {
  double sum = 0;
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) sum += picture.rgba[i] / 255.0;
  return sum;
}

/// "visible" if more than `threshold` pixels are covered.
inline std::string seen(const render::Image8& picture, double threshold = 0) {
  return count_covered(picture) > threshold ? "visible" : "empty image";
}

/// Result of pictures that should be visible and equal.
inline std::string same_pictures(const std::vector<render::Image8>& pictures, double covered, int more, double bound) {
  double maximum = 0;
  for (const render::Image8& picture : pictures) maximum = std::max(maximum, count_differing(picture, pictures[0], more));
  return Findings()
      .add(seen(pictures[0], covered))
      .at_most(fmt::format("fraction of pixels that differ by more than {}/255", more), maximum, bound);
}

}  // namespace catena::extremes
