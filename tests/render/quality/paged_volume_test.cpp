// SPDX-License-Identifier: MIT
/// Volumes in pages: the same image as in memory, coarse first without waiting, and what is shown where a page is missing.
#include <cmath>
#include <thread>

#include "render/image/image_error.h"
#include "render/quality/tiled_render.h"
#include "tests/render/support/ray_alpha.h"
#include "tests/support/formula_bricks.h"

namespace catena::test::paged_volume_test {

using namespace catena::render;

class PagedVolumes : public ImageTest {
 protected:
  static RenderSettings exact(double step) {
    RenderSettings settings;
    settings.step_voxels = step;
    settings.waits_for_pages = settings.shows_finest_pages = true;
    return settings;
  }
  static RenderSettings fast(double step) {
    RenderSettings settings = exact(1);
    settings.fast = FastSettings{step, 1, 0.2, 0.2};
    return settings;
  }
};

constexpr double kQuantization = 0.25;         // 1/255; both volumes are rounded to 256 codes, on different scales
constexpr field::Index3 kSize{150, 130, 140};  // 3 x 3 x 3 bricks

std::shared_ptr<const FormulaBricks> waves() {
  return std::make_shared<const FormulaBricks>(kSize, 1, [](const Vec3& p) {
    return 30000 + 20000 * std::sin(0.11 * p.x + 0.02 * p.z) * std::cos(0.07 * p.y) + 9000 * std::sin(0.23 * p.z - 0.3 * p.x);
  });
}

/// A translucent cloud with an empty part.
VolumeItem cloud(GridPtr grid, std::shared_ptr<const field::PagedGrid> paged) {
  VolumeItem item = volume_item(std::move(grid), {{0, 0}, {28000, 0}, {60000, 0.05}});
  item.transfer.colors = {{0, 0.1, 0.1, 0.9}, {30000, 0.9, 0.8, 0.1}, {60000, 1, 0, 0}};
  item.paged = std::move(paged);
  return item;
}

/// The field of view of 10 degrees shows each voxel larger than a pixel.
FramePacket view(VolumeItem item, double fovy_deg = 28) {
  FramePacket packet = make_packet({400, -330, 260}, {75, 65, 70}, fovy_deg);
  packet.volumes = {std::move(item)};
  return packet;
}

double rmse(const Image8& a, const Image8& b) { return measure_error(a, b).rmse; }

TEST_F(PagedVolumes, TheImageIsThatOfTheVolumeInMemory) {
  const auto source = waves();
  const auto paged = make_paged(source);
  for (const bool shade : {false, true}) {
    VolumeItem whole = cloud(source->whole(0), nullptr), in_pages = cloud(source->whole(1), paged);
    whole.is_shaded = in_pages.is_shaded = shade;
    RenderSettings settings = fast(0.25);
    const Image8 expected = draw(view(whole), settings, "expected"), coarse = draw(view(cloud(source->whole(1), nullptr)), settings);
    const Image8 image = draw(view(in_pages), settings, shade ? "paged_shaded" : "paged");
    EXPECT_LT(rmse(image, expected), shade ? 0.5 : kQuantization);
    EXPECT_GT(rmse(coarse, expected), 1);
    EXPECT_GT(covered(image), 4000);
    // by the rays of an exact raycast
    EXPECT_LT(rmse(draw(view(in_pages), exact(0.25)), expected), 0.5);
  }
}

TEST_F(PagedVolumes, ChannelsAreBlendedAsInMemory) {
  const std::shared_ptr<const FormulaBricks> sources[] = {waves(), std::make_shared<const FormulaBricks>(kSize, 1, [](const Vec3& p) {
                                                            return 20000 + 19000 * std::sin(0.13 * p.y) * std::sin(0.05 * p.x);
                                                          })};
  for (const bool shade : {false, true}) {
    FramePacket whole = view(cloud(nullptr, nullptr)), in_pages = whole, coarse = whole;
    for (FramePacket* packet : {&whole, &in_pages, &coarse}) packet->volumes.clear();
    for (const auto& source : sources) {
      VolumeItem item = cloud(source->whole(0), nullptr);
      item.is_shaded = shade;
      if (source == sources[1]) item.transfer.colors = {{0, 0.1, 0.9, 0.1}, {40000, 0.2, 1, 0.9}};
      whole.volumes.push_back(item);
      item.grid = source->whole(1);
      coarse.volumes.push_back(item);
      item.paged = make_paged(source);
      in_pages.volumes.push_back(item);
    }
    const Image8 expected = draw(whole, exact(0.25), "expected");
    EXPECT_LT(rmse(draw(in_pages, fast(0.25), shade ? "channels_shaded" : "channels"), expected), shade ? 1 : 0.3);
    EXPECT_GT(rmse(draw(coarse, exact(0.25)), expected), 1);
  }
}

TEST_F(PagedVolumes, ValuesBetweenCodesKeepTheirMean) {
  // a haze of which a code more or less is a difference of 13/255, and a few values that set the range
  const auto source =
      std::make_shared<const FormulaBricks>(kSize, 1, [](const Vec3& p) { return p.x < 4 && p.y < 4 && p.z < 4 ? 60000.0 : 30190.0; });
  VolumeItem whole = cloud(source->whole(0), nullptr), in_pages = cloud(source->whole(1), make_paged(source));
  whole.transfer.extinctions = in_pages.transfer.extinctions = {{0, 0}, {30000, 0}, {60000, 0.5}};
  const Image8 expected = draw(view(whole), exact(0.5), "expected");
  EXPECT_LT(rmse(draw(view(in_pages), fast(0.5), "dithered"), expected), 1);
}

TEST_F(PagedVolumes, ProjectionsAreThoseOfTheVolumeInMemory) {
  const auto source = waves();
  const auto paged = make_paged(source);
  for (const Projection projection : {Projection::maximum, Projection::minimum, Projection::average}) {
    VolumeItem whole = cloud(source->whole(0), nullptr), in_pages = cloud(source->whole(1), paged);
    for (VolumeItem* item : {&whole, &in_pages}) {
      item->projection = projection;
      item->transfer.extinctions = {{0, 0.5}, {60000, 3}};
    }
    const Image8 expected = draw(view(whole), exact(0.25), "expected");
    EXPECT_LT(rmse(draw(view(in_pages), exact(0.25), "projection"), expected), kQuantization) << int(projection);
    in_pages.paged.reset();
    EXPECT_GT(rmse(draw(view(in_pages), exact(0.25)), expected), 2 * kQuantization) << int(projection);
  }
}

TEST_F(PagedVolumes, FramesDoNotWaitForAPage) {
  const auto source = waves();
  const auto paged = make_paged(source);
  const Image8 expected = draw(view(cloud(source->whole(0), nullptr), 10), fast(0.25));
  RenderSettings live = fast(0.25);
  live.waits_for_pages = false;
  const FramePacket packet = view(cloud(source->whole(1), paged), 10);
  const Image8 first = draw(packet, live, "paged_first");
  EXPECT_GT(rmse(first, expected), 0.5);
  EXPECT_GT(covered(first), 4000);
  double error = 1000;
  for (int i = 0; i < 200 && error > kQuantization; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    error = rmse(draw(packet, live), expected);
  }
  EXPECT_LT(error, kQuantization);
}

TEST_F(PagedVolumes, WhereAPageCannotBeReadACoarserLevelIsShown) {
  const auto source = std::make_shared<FormulaBricks>(kSize, 1, [](const Vec3& p) { return 30000 + 200 * p.x; });
  const auto paged = make_paged(source);
  const Image8 expected = draw(view(cloud(source->whole(1), nullptr)), fast(0.25));
  RenderSettings live = fast(0.25);
  live.waits_for_pages = false;
  const FramePacket packet = view(cloud(source->whole(1), paged));
  draw(packet, live);
  source->fails = true;
  EXPECT_LT(rmse(draw(packet, fast(0.25)), expected), 3);
}

TEST_F(PagedVolumes, WhatDoesNotFitIsDrawnInParts) {
  const auto source = waves();
  const Image8 expected = draw(view(cloud(source->whole(0), nullptr)), fast(0.25));
  const FramePacket packet = view(cloud(source->whole(1), make_paged(source)));
  RenderSettings settings = fast(0.25);
  settings.fast->max_bytes = 15 << 20;  // twelve pages besides those of the coarse level, of 27
  Image8 image{packet.width, packet.height, {}};
  const TilePlan plan = plan_tiles(packet.width, packet.height, 1, 0, true, renderer_->max_image_side());
  value_of(render_tiled(*renderer_, packet, settings, plan, {}, [&](const Band& band) -> Outcome {
    image.rgba.insert(image.rgba.end(), band.bytes.begin(), band.bytes.end());
    return Done{};
  }));
  EXPECT_LT(rmse(image, expected), kQuantization);
  // in one piece it is coarse
  draw(packet, settings);
  EXPECT_EQ(renderer_->paging().finest_level, 1);
  EXPECT_GT(rmse(draw(packet, settings), expected), 0.5);
}

}  // namespace catena::test::paged_volume_test
