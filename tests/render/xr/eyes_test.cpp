/// Both eyes of example scenes. CATENA_XR_PICTURES=DIR writes what they see. CATENA_XR_EYES=1 measures what the second one costs: processor
/// time of pictures of one view and of two, the same scene and settings, one after the other, so that what else the machine does counts for
/// both.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "engine/scene/scene.h"
#include "render/extract/extract.h"
#include "render/image/picture.h"
#include "tests/render/xr/rig.h"

namespace catena::test {
namespace eyes_test {

using namespace xr_rig;

double processor_s() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

class HeadsetEyes : public HeadsetFixture {
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
      packet->overlay = {};  // of the flat picture
      const Placement placement = first_placement(packet->view);
      const auto aim = [&](const View& view, FramePacket& of) { set_view(scene, view, of); };
      const Outcome shown = headset_->show(*frame, *renderer_, *packet, settings, placement, 1, aim);
      ASSERT_TRUE(shown) << shown.error().message;
    }
  }
  double packet_s_ = 0;  ///< spent on what both eyes share
  void close() {
    headset_->stop();
    renderer_.reset();
    headset_.reset();
  }
};

TEST_F(HeadsetEyes, PicturesOfBoth) {
  const char* folder = std::getenv("CATENA_XR_PICTURES");
  if (!folder) GTEST_SKIP() << "writes pictures only where CATENA_XR_PICTURES names a folder";
  validation_ = false;
  runtime_.script().width = 640;
  runtime_.script().height = 560;
  runtime_.script().keep_pictures = true;
  for (const char* name : {"atlas", "left-ventricle", "hand"}) {
    auto scene = scene::read_scene(source_dir() + "/assets/scenes/" + name + ".json");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_TRUE(open());
    draw(*scene, balanced_settings(), 3);
    for (std::size_t k = 0; k < runtime_.record().last.size(); ++k) {
      const xr_runtime::KeptPicture& picture = runtime_.record().last[k];
      const std::string path = std::string(folder) + "/" + name + "-eye" + std::to_string(k) + ".png";
      EXPECT_TRUE(write_png(path, {picture.width, picture.height, picture.rgba}, false));
    }
    close();
  }
}

TEST_F(HeadsetEyes, CostOfTheSecond) {
  if (!std::getenv("CATENA_XR_EYES")) GTEST_SKIP() << "measures only where CATENA_XR_EYES is set";
  validation_ = false;
  runtime_.script().width = 320;
  runtime_.script().height = 240;
  runtime_.script().without.insert(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME);
  const std::vector<XrView> both = runtime_.script().views;
  const std::string folder = source_dir() + "/assets/scenes/";
  constexpr int kPictures = 30;
  for (const char* name : {"hand.json", "brain.json", "head-cut.json", "atlas.json"}) {
    auto scene = scene::read_scene(folder + name);
    ASSERT_TRUE(scene) << scene.error().message;
    std::vector<double> ratios;
    double first_ms = 0, packet_ms = 0;
    for (int round = 0; round < 3; ++round) {
      double seconds[2] = {0, 0};
      for (const int which : {0, 1, 2}) {  // the left one alone, the right one, both
        runtime_.script().views = which == 2 ? both : std::vector{both[std::size_t(which)]};
        ASSERT_TRUE(open());
        draw(*scene, balanced_settings(), 10);
        packet_s_ = 0;
        const double before = processor_s();
        draw(*scene, balanced_settings(), kPictures);
        seconds[which / 2] += (processor_s() - before) / kPictures;
        close();
      }
      ratios.push_back(2 * seconds[1] / seconds[0]);
      first_ms = 1e3 * seconds[0] / 2;
      packet_ms = 1e3 * packet_s_ / kPictures;
    }
    std::ranges::sort(ratios);
    std::printf("%-22s one eye %7.1f ms, of these the packet of both %.2f ms; both %.3f times that (%.3f to %.3f)\n", name, first_ms,
                packet_ms, ratios[1], ratios[0], ratios[2]);
  }
}

}  // namespace eyes_test
}  // namespace catena::test
