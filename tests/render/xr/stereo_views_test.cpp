// SPDX-License-Identifier: MIT
/// Images of both eyes of example scenes. CATENA_XR_PICTURES=DIR writes them. CATENA_XR_EYES=1 measures the cost of the second eye:
/// processor time of images with one and with two views, of the same scene and settings, alternating, so that other load affects both.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "engine/base/clock.h"
#include "engine/scene/scene.h"
#include "render/extract/extract.h"
#include "render/image/image.h"
#include "tests/render/xr/xr_fixture.h"

namespace catena::test::stereo_views_test {

using namespace xr_rig;

double processor_s(int whose = RUSAGE_SELF) {
  rusage used{};
  ::getrusage(whose, &used);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

class HeadsetStereoViews : public HeadsetFixture {
 protected:
  void draw(scene::Scene& scene, const RenderSettings& settings, int count) {
    const XrExtent2Di size{std::int32_t(runtime_.script().width), std::int32_t(runtime_.script().height)};
    for (int i = 0; i < count; ++i) {
      ASSERT_TRUE(headset_->poll());
      const auto frame = headset_->begin();
      ASSERT_TRUE(frame);
      const double before = processor_s();
      auto packet = make_frame(scene, std::uint32_t(size.width), std::uint32_t(size.height));
      ASSERT_TRUE(packet) << packet.error().message;
      packet_s_ += processor_s() - before;
      packet->overlay = {};  // the overlay of the flat image
      const Placement placement = make_initial_placement(packet->view);
      const auto aim = [&](const View& view, FramePacket& of) { set_view(scene, view, of); };
      const Outcome shown = headset_->show(*frame, *renderer_, *packet, settings, placement, 1, aim);
      ASSERT_TRUE(shown) << shown.error().message;
    }
  }
  double packet_s_ = 0;  ///< time of the work that both eyes share
};

TEST_F(HeadsetStereoViews, ImagesOfBothEyes) {
  const char* folder = std::getenv("CATENA_XR_PICTURES");
  if (!folder) GTEST_SKIP() << "writes pictures only where CATENA_XR_PICTURES names a folder";
  validation_ = false;
  set_image_size(640, 560);
  runtime_.script().capture_images = true;
  for (const char* name : {"atlas", "left-ventricle", "hand"}) {
    auto scene = scene::read_scene(source_dir() + "/assets/scenes/" + name + ".json");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_TRUE(open());
    draw(*scene, balanced_settings(), 3);
    for (std::size_t k = 0; k < runtime_.record().last_images.size(); ++k) {
      const xr_runtime::CapturedImage& rendered = runtime_.record().last_images[k];
      const std::string path = std::string(folder) + "/" + name + "-eye" + std::to_string(k) + ".png";
      EXPECT_TRUE(write_png(path, {rendered.width, rendered.height, rendered.rgba}, false));
    }
    close();
  }
}

TEST_F(HeadsetStereoViews, CostOfTheSecondEye) {
  if (!std::getenv("CATENA_XR_EYES")) GTEST_SKIP() << "measures only where CATENA_XR_EYES is set";
  validation_ = false;
  set_image_size(320, 240);
  runtime_.script().unsupported.insert(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME);
  const std::vector<XrView> both = runtime_.script().views;
  const std::string folder = source_dir() + "/assets/scenes/";
  constexpr int kPictures = 12, kRounds = 7;
  struct Cost {
    double processor_s = 0, own_s = 0, wall_s = 0, work_s = 0;  // work_s: GPU time of the submitted work
  };
  for (const char* name : {"brain", "hand", "head-cut", "atlas", "left-ventricle", "rake", "ventricle-fibres"}) {
    auto scene = scene::read_scene(folder + name + ".json");
    ASSERT_TRUE(scene) << scene.error().message;
    std::vector<double> processor, wall;
    Cost one;
    for (int round = 0; round < kRounds; ++round) {
      Cost cost[2];
      for (const int which : {0, 2, 1}) {  // left eye, both eyes, right eye
        runtime_.script().views = which == 2 ? both : std::vector{both[std::size_t(which)]};
        ASSERT_TRUE(open());
        draw(*scene, balanced_settings(), 4);
        packet_s_ = 0;
        const double before = processor_s(), own = processor_s(RUSAGE_THREAD);
        const std::int64_t start = now_ns();
        const double work_ns = renderer_->device().counters().gpu_ns;
        draw(*scene, balanced_settings(), kPictures);
        Cost& sum = cost[which / 2];
        sum.processor_s += processor_s() - before;
        sum.own_s += processor_s(RUSAGE_THREAD) - own;
        sum.wall_s += 1e-9 * double(now_ns() - start);
        sum.work_s += 1e-9 * (renderer_->device().counters().gpu_ns - work_ns);
        close();
      }
      processor.push_back(2 * cost[1].processor_s / cost[0].processor_s);
      wall.push_back(2 * cost[1].wall_s / cost[0].wall_s);
      one = cost[0];
    }
    const auto quartiles = [](std::vector<double>& of) {
      std::ranges::sort(of);
      return fmt::format("{:.3f} ({:.3f} to {:.3f})", of[of.size() / 2], of[of.size() / 4], of[of.size() * 3 / 4]);
    };
    const auto ms = [](double seconds) { return 1e3 * seconds / (2 * kPictures); };
    fmt::print(
        "{:16} one eye: processor {:.1f} ms ({:.1f} ms of the thread that submits), wall {:.1f} ms, device {:.1f} ms; both by one: "
        "processor {}, wall {}\n",
        name, ms(one.processor_s), ms(one.own_s), ms(one.wall_s), ms(one.work_s), quartiles(processor), quartiles(wall));
    std::fflush(stdout);
  }
}

}  // namespace catena::test::stereo_views_test
