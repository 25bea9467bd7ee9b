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
#include "tests/support/support.h"
#include "tests/support/vulkan.h"

namespace catena::extremes {

/// One device for all rows. On a failure the image is empty and `error_message` is set.
struct TestRenderer {
  std::unique_ptr<render::Renderer> renderer;
  std::string error_message;

  static TestRenderer& instance() {
    static TestRenderer eye;
    return eye;
  }

  render::Image8 draw(const std::string& text, const test::TemporaryFolder& folder, std::uint32_t width, std::uint32_t height) {
    error_message.clear();
    auto scene = scene::parse_scene(text, folder / "s.json");
    if (!scene) return on_failure(scene.error(), folder);
    auto packet = render::make_frame(*scene, width, height);
    if (!packet) return on_failure(packet.error(), folder);
    const Outcome drawn = renderer->draw(*packet);
    if (!drawn) return on_failure(drawn.error(), folder);
    auto picture = renderer->read_back();
    if (!picture) return on_failure(picture.error(), folder);
    if (renderer->stats().validation_messages > 0) error_message = "the validation layer said " + renderer->validation_texts().front();
    return *picture;
  }

 private:
  TestRenderer() {
    test::use_lavapipe();
    render::vk::DeviceOptions options;
    options.validation = true;
    options.device_filter = test::test_device();
    auto made = render::Renderer::create(options);
    CATENA_ASSERT(static_cast<bool>(made));
    renderer = std::move(*made);
  }
  render::Image8 on_failure(const Error& error, const test::TemporaryFolder& folder) {
    error_message = error.message;
    for (auto at = error_message.find(folder.path()); at != std::string::npos; at = error_message.find(folder.path()))
      error_message.erase(at, folder.path().size() + 1);
    return {};
  }
};

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

}  // namespace catena::extremes
