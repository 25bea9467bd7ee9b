// SPDX-License-Identifier: MIT
/// Translucent layers among volumes and surfaces: synthetic layers, against the sum along the ray.
#include <cmath>
#include <cstring>

#include "render/light/light_grid.h"
#include "render/passes/passes.h"
#include "render/vk/commands.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::layers_test {

using namespace catena::render;

struct Sheet {
  double depth = 0;  // along the view axis in world units; infinite: no layer
  std::array<float, 4> color{};
};

/// Checks the colours of the image's left and right half, whose rays hit the layers `left` and `right`, nearest first.
class Layers : public ImageTest {
 protected:
  vk::Image image(VkFormat format, const std::vector<float>& values) {
    vk::ImageInfo info;
    info.format = format;
    info.extent = {packet_.width, packet_.height, 1};
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    auto made = vk::Image::create(renderer_->device(), info);
    EXPECT_TRUE(made) << made.error().message;
    const auto filled = vk::upload_planes(renderer_->device(), *made, 1, [&](std::uint32_t, std::uint32_t, std::byte* out) {
      std::memcpy(out, values.data(), values.size() * sizeof(float));
    });
    EXPECT_TRUE(filled);
    return std::move(*made);
  }

  std::vector<float> draw_with(const std::vector<Sheet>& left, const std::vector<Sheet>& right) {
    vk::Device& device = renderer_->device();
    ResidencyManager mirrors(device);
    Targets targets;
    const RenderSettings settings;
    Frame frame{device, mirrors, targets, packet_, settings, {}};
    const std::size_t count = std::max(left.size(), right.size());
    frame.layers.resize(count);
    auto pass = kRaycastPass.create(device);
    EXPECT_TRUE(pass);
    const auto prepared = (*pass)->prepare(frame);
    EXPECT_TRUE(prepared) << (prepared ? "" : prepared.error().message);
    frame.rays = CameraRays::make(packet_, (*pass)->bounds());
    EXPECT_TRUE(targets.ensure(device, packet_.width, packet_.height, (*pass)->use(frame).writes));

    std::vector<vk::Image> images;
    images.reserve(2 * count);
    for (std::size_t k = 0; k < count; ++k) {
      std::vector<float> colors, depths;
      for (std::uint32_t i = 0; i < packet_.width * packet_.height; ++i) {
        const auto& side = i % packet_.width < packet_.width / 2 ? left : right;
        const Sheet sheet = k < side.size() ? side[k] : Sheet{HUGE_VAL, {}};
        colors.insert(colors.end(), sheet.color.begin(), sheet.color.end());
        depths.push_back(std::isfinite(sheet.depth) ? float(sheet.depth - frame.rays.reference_depth) : NO_DEPTH);
      }
      images.push_back(image(VK_FORMAT_R32G32B32A32_SFLOAT, colors));
      images.push_back(image(VK_FORMAT_R32_SFLOAT, depths));
      frame.layers[k] = {&images[2 * k], &images[2 * k + 1]};
    }

    const std::size_t bytes = 16 * std::size_t(packet_.width) * packet_.height;
    auto buffer = vk::Buffer::create(device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::Memory::readback);
    LightGrid light;
    EXPECT_TRUE(light.update(device, packet_, true));
    auto commands = vk::Commands::begin(device);
    EXPECT_TRUE(buffer && commands);
    const auto recorded = (*pass)->record(*commands, frame);
    EXPECT_TRUE(recorded) << (recorded ? "" : recorded.error().message);
    commands->copy(targets.volume, *buffer);
    EXPECT_TRUE(commands->finish());
    std::vector<float> values(bytes / 4);
    std::memcpy(values.data(), buffer->bytes().data(), bytes);
    return values;
  }

  std::array<float, 4> at(const std::vector<float>& rendered, std::uint32_t x, std::uint32_t y) const {
    std::array<float, 4> c{};
    std::copy_n(&rendered[4 * (std::size_t(y) * packet_.width + x)], 4, c.begin());
    return c;
  }

  FramePacket packet_;
};

/// A white fog from y = 0 to 20, seen along y from -40.
FramePacket fog_packet(double sigma) {
  FramePacket packet = square_packet_along_y(64, 16);
  packet.volumes.push_back(volume_item(make_grid({21, 21, 21}, [](const Vec3&) { return 0.5; }), {{0, sigma}, {1, sigma}}));
  return packet;
}

TEST_F(Layers, AreBlendedWithinAVolumeInOrder) {
  packet_ = fog_packet(0.05);
  const std::array<float, 4> red{0.5f, 0, 0, 0.5f}, blue{0, 0, 0.25f, 0.25f}, green{0, 0.9f, 0, 0.9f};
  // left: in front of, within (twice) and behind the fog; right: one layer behind it
  const auto rendered = draw_with({{30, green}, {45, red}, {52.5, blue}, {70, green}}, {{70, red}});
  const auto fog = [](double length) { return 1 - std::exp(-0.05 * length); };
  double through = 1, white = 0, r = 0, g = 0, b = 0;
  const auto march = [&](double length) {
    white += through * fog(length);
    through *= 1 - fog(length);
  };
  const auto meet = [&](const std::array<float, 4>& c) {
    r += through * c[0];
    g += through * c[1];
    b += through * c[2];
    through *= 1 - c[3];
  };
  meet(green), march(5), meet(red), march(7.5), meet(blue), march(7.5), meet(green);
  const auto left = at(rendered, 10, 30);
  EXPECT_NEAR(left[0], white + r, 2e-3);
  EXPECT_NEAR(left[1], white + g, 2e-3);
  EXPECT_NEAR(left[2], white + b, 2e-3);
  EXPECT_NEAR(left[3], 1 - through, 2e-3);
  const auto right = at(rendered, 50, 30);
  EXPECT_NEAR(right[0], fog(20) + (1 - fog(20)) * 0.5, 2e-3);
  EXPECT_NEAR(right[1], fog(20), 2e-3);
  EXPECT_NEAR(right[3], 1 - (1 - fog(20)) * 0.5, 2e-3);
}

TEST_F(Layers, AreBlendedWithASurface) {
  packet_ = fog_packet(0);
  packet_.volumes.clear();
  packet_.isosurfaces = {{make_grid({21, 21, 21}, [](const Vec3& p) { return p.y; }), 10, {1, 1, 1}, 0.5f}};
  const std::array<float, 4> red{0.5f, 0, 0, 0.5f};
  const auto rendered = draw_with({{45, red}}, {{55, red}});
  const double lit = 1.1;  // 0.2 + 0.7 + 0.2, seen along the normal
  EXPECT_NEAR(at(rendered, 10, 30)[0], 0.5 + 0.5 * 0.5 * lit, 2e-3);
  EXPECT_NEAR(at(rendered, 50, 30)[0], 0.5 * lit + 0.5 * 0.5, 2e-3);
  EXPECT_NEAR(at(rendered, 50, 30)[1], 0.5 * lit, 2e-3);
}

TEST_F(Layers, AreDrawnWithoutAVolume) {
  packet_ = fog_packet(0);
  packet_.volumes.clear();
  const std::array<float, 4> red{0.5f, 0, 0, 0.5f}, blue{0, 0, 0.25f, 0.25f};
  const auto rendered = draw_with({{5, red}, {6, blue}}, {});
  EXPECT_NEAR(at(rendered, 10, 30)[0], 0.5, 1e-6);
  EXPECT_NEAR(at(rendered, 10, 30)[2], 0.125, 1e-6);
  EXPECT_NEAR(at(rendered, 10, 30)[3], 0.625, 1e-6);
  EXPECT_EQ(at(rendered, 50, 30)[3], 0);
}

TEST_F(Layers, MoreThanFourLayersAreAnError) {
  packet_ = fog_packet(0.1);
  vk::Device& device = renderer_->device();
  ResidencyManager mirrors(device);
  Targets targets;
  Frame frame{device, mirrors, targets, packet_, {}, {}};
  frame.layers.resize(5);
  auto pass = kRaycastPass.create(device);
  ASSERT_TRUE(pass);
  const auto prepared = (*pass)->prepare(frame);
  ASSERT_FALSE(prepared);
  EXPECT_NE(prepared.error().message.find("5 translucent layers"), std::string::npos);
}

}  // namespace catena::test::layers_test
