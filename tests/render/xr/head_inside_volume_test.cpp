// SPDX-License-Identifier: MIT
/// The head enters a volume in small steps through its face, and stands exactly on the face. Every image matches the rays of that eye, so
/// that there are neither flashes nor holes.
#include <cmath>

#include "tests/render/support/image_fixture.h"
#include "tests/render/xr/xr_fixture.h"

namespace catena::test::head_inside_volume_test {

using namespace xr_rig;
using xr_runtime::CapturedImage;

constexpr double kScale = 0.05;  // metres per unit
constexpr int kNodes = 17;       // nodes of the box per axis, one unit apart

class HeadInsideVolume : public HeadsetFixture {
 protected:
  void SetUp() override {
    HeadsetFixture::SetUp();
    if (!runtime_.found()) return;
    runtime_.script().capture_images = true;
    set_image_size(48, 40);
    views_ = runtime_.script().views;
    // the near face of the box is the room's plane z = 0, around the head's path
    placement_.meters_per_unit = kScale;
    placement_.world_origin = {0.45 * (kNodes - 1), 0.55 * (kNodes - 1), kNodes - 1.0};
  }
  /// Positions of the eyes in front of and behind the face.
  void stand_at(double z) {
    for (std::size_t k = 0; k < views_.size(); ++k) {
      runtime_.script().views[k] = views_[k];
      runtime_.script().views[k].pose.position.z = float(z);
    }
  }
  /// Images of both eyes at that position.
  const std::vector<CapturedImage>& seen(FramePacket& packet, const RenderSettings& settings) {
    for (bool shown = false; !shown;) {
      const xr::Frame frame = begin_frame();
      show(frame, packet, settings, placement_);
      shown = frame.should_render || HasFailure();
    }
    return runtime_.record().last_images;
  }

  std::vector<XrView> views_;
  Placement placement_;
};

std::vector<double> steps_through() {
  std::vector<double> steps{1e-6, 0, -1e-6};
  for (double z = 0.03; z > -0.031; z -= 0.005) steps.push_back(z);
  std::ranges::sort(steps, std::greater<>());
  return steps;
}

RenderSettings fast_settings(std::uint32_t spacing) {
  RenderSettings settings{.fast = FastSettings{.step_voxels = 1, .spacing = spacing, .refine_half_255 = 1, .refine_full_255 = 1}};
  return settings;
}

/// For a constant sigma the transmittance is exp(-sigma times the path length in the box in front of the eye).
TEST_F(HeadInsideVolume, AHomogeneousVolumeHasTheAlphaOfThePathLength) {
  constexpr double kSigma = 0.12;  // per unit
  ASSERT_TRUE(open());
  FramePacket packet;
  packet.background = {0, 0, 0, 1};
  const GridPtr grid = make_grid({kNodes, kNodes, kNodes}, [](const Vec3&) { return 1.0; });
  packet.volumes.push_back(volume_item(grid, {{0, 0}, {1, kSigma}}, {1.0f, 1.0f, 1.0f}));
  for (const RenderSettings& settings : {RenderSettings{}, fast_settings(1)})
    for (const double z : steps_through()) {
      stand_at(z);
      const auto& images = seen(packet, settings);
      ASSERT_EQ(images.size(), 2u);
      int worst = 0;
      for (std::size_t k = 0; k < images.size(); ++k) {
        const XrView& view = runtime_.script().views[k];
        const Vec3 eye(view.pose.position.x, view.pose.position.y, view.pose.position.z);
        for (int j = 0; j < 40; ++j)
          for (int i = 0; i < 48; ++i) {
            const double through =
                std::exp(-kSigma * chord_length(*grid, placement_.to_world(eye), ray_of(view, i + 0.5, j + 0.5, 48, 40)));
            const int due = int(std::lround(255 * (1 - through))), is = images[k].rgba[4 * std::size_t(j * 48 + i)];
            worst = std::max(worst, std::abs(is - due));
          }
      }
      EXPECT_LE(worst, 2) << (settings.fast ? "fast rays, " : "exact rays, ") << z << " m before the face";
    }
}

double rms_between(const CapturedImage& a, const CapturedImage& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::pow(double(a.rgba[i]) - b.rgba[i], 2);
  return std::sqrt(sum / double(a.rgba.size()));
}

/// A shaded, inhomogeneous volume: the quality levels of a headset against rays with steps of a tenth of a voxel; consecutive images
/// do not differ more than those of the reference.
TEST_F(HeadInsideVolume, ImagesChangeContinuouslyOnTheWayIn) {
  ASSERT_TRUE(open());
  FramePacket packet;
  packet.background = {0.1f, 0.2f, 0.3f, 1};
  const GridPtr grid = make_grid({kNodes, kNodes, kNodes}, [](const Vec3& at) {
    return 0.5 + 0.25 * std::sin(0.7 * at.x) + 0.25 * std::cos(0.6 * at.y) * std::sin(0.5 * at.z);
  });
  packet.volumes.push_back(volume_item(grid, {{0.3, 0}, {1, 0.8}}, {1.0f, 0.8f, 0.5f}));
  packet.volumes.back().is_shaded = true;
  std::optional<std::array<CapturedImage, 2>> before;
  for (const double z : steps_through()) {
    stand_at(z);
    const CapturedImage reference = seen(packet, reference_settings())[0];
    const CapturedImage drawn = seen(packet, fast_settings(4))[0];
    EXPECT_LT(rms_between(drawn, reference), 4) << z;
    if (before) {
      EXPECT_LT(rms_between(drawn, (*before)[1]), rms_between(reference, (*before)[0]) + 2) << z;
    }
    before = {reference, drawn};
  }
}

}  // namespace catena::test::head_inside_volume_test
