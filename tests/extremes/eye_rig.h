/// The eye of the rows: scenes drawn on the CPU driver with the validation layer on, and raw files to draw.
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

/// One device for all rows. What goes wrong is a sentence in `said`: then the picture is empty.
struct Eye {
  std::unique_ptr<render::Renderer> renderer;
  std::string said;

  static Eye& only() {
    static Eye eye;
    return eye;
  }

  render::Picture draw(const std::string& text, const test::TemporaryFolder& folder, std::uint32_t width, std::uint32_t height) {
    said.clear();
    auto scene = scene::parse_scene(text, folder / "s.json");
    if (!scene) return failed(scene.error(), folder);
    auto packet = render::make_frame(*scene, width, height);
    if (!packet) return failed(packet.error(), folder);
    const Outcome drawn = renderer->draw(*packet);
    if (!drawn) return failed(drawn.error(), folder);
    auto picture = renderer->read_back();
    if (!picture) return failed(picture.error(), folder);
    if (renderer->stats().validation_messages > 0) said = "the validation layer said " + renderer->validation_texts().front();
    return *picture;
  }

 private:
  Eye() {
    test::use_lavapipe();
    render::vk::DeviceOptions options;
    options.validation = true;
    options.choose = test::test_device();
    auto made = render::Renderer::create(options);
    CATENA_ASSERT(static_cast<bool>(made));
    renderer = std::move(*made);
  }
  render::Picture failed(const Error& error, const test::TemporaryFolder& folder) {
    said = error.message;
    for (auto at = said.find(folder.path()); at != std::string::npos; at = said.find(folder.path()))
      said.erase(at, folder.path().size() + 1);
    return {};
  }
};

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// A .raw file of n[0] x n[1] x n[2] floats.
inline void write_raw(const std::string& path, const std::array<int, 3>& n, const std::function<double(int, int, int)>& value) {
  std::vector<float> values;
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) values.push_back(static_cast<float>(value(x, y, z)));
  test::write_file(path, bytes_of(values));
}

inline std::string triple(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

/// Pixels whose colours differ by more than `more` in 255; all of them where sizes differ.
inline double differing(const render::Picture& a, const render::Picture& b, int more) {
  if (a.rgba.size() != b.rgba.size() || a.rgba.empty()) return 1;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    int most = 0;
    for (std::size_t c = 0; c < 4; ++c) most = std::max(most, std::abs(int(a.rgba[i + c]) - int(b.rgba[i + c])));
    count += most > more;
  }
  return 4.0 * static_cast<double>(count) / static_cast<double>(a.rgba.size());
}

/// Pixels that something covers, over a transparent background.
inline double covered(const render::Picture& picture) {
  double sum = 0;
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) sum += picture.rgba[i] / 255.0;
  return sum;
}

}  // namespace catena::extremes
