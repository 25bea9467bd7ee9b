// SPDX-License-Identifier: MIT
// A tracked head in front of a screen: smoothing of a head that moves, jumps or is lost, and the window's image against that of render.
#include "engine/app/viewer/input/tracked_head.h"

#include <chrono>
#include <thread>

#include "engine/scene/document.h"
#include "tests/engine/app/program_runs.h"
#include "tests/engine/app/window_fixture.h"
#include "tests/support/results.h"

namespace catena::app::tracked_head_test {

const scene::DisplayScreen kDesk{"desk", {-2, -2, -1.5}, {2, -2, -1.5}, {-2, -2, 1.5}};  // diagonal 5; heads are at y < -2
constexpr double kDt = 1.0 / 60;

TEST(SmoothedHead, FollowsExactlyAndGlidesAfterAJump) {
  SmoothedHead head(kDesk);
  EXPECT_FALSE(head.update(0, std::nullopt));
  EXPECT_EQ(head.update(kDt, Vec3(0, -8, 0)), Vec3(0, -8, 0));  // no transition
  double t = kDt;
  for (int k = 1; k < 20; ++k) EXPECT_EQ(head.update(t += kDt, Vec3(0.1 * k, -8, 0.01 * k)), Vec3(0.1 * k, -8, 0.01 * k));
  // A jump of 4 units within a frame.
  const Vec3 from(1.9, -8, 0.19), to(-2.1, -8, 0.19);
  Vec3 last = from;
  const double jump_s = t + kDt;
  int steps = 0;
  while (last != to && steps++ < 100) {
    const Vec3 now = *head.update(t += kDt, to);
    EXPECT_LE(now.x, last.x + 1e-12);
    EXPECT_LT(norm(now - last), 0.4) << "no step of the glide is a leap";
    last = now;
  }
  EXPECT_NEAR(t - jump_s, SmoothedHead::kGlideS, 1.5 * kDt);
  // In the middle of the transition, the head is halfway.
  SmoothedHead other(kDesk);
  other.update(10, from);
  other.update(10.001, to);
  EXPECT_NEAR(other.update(10.001 + 0.15, to)->x, -0.1, 1e-9);
}

TEST(SmoothedHead, StaysWhileTheHeadIsLost) {
  SmoothedHead head(kDesk);
  double t = 0;
  head.update(t, Vec3(1, -6, 0));
  const std::optional<Vec3> odd[] = {std::nullopt, Vec3(NAN, -6, 0), Vec3(0, INFINITY, 0), Vec3(0, -2, 0), Vec3(0, 3, 0)};
  for (const auto& lost : odd) {
    EXPECT_EQ(head.update(t += kDt, lost), Vec3(1, -6, 0));
    EXPECT_TRUE(head.is_lost());
  }
  // A head that is found nearby moves there without a jump.
  EXPECT_LT(norm(*head.update(t += kDt, Vec3(1.1, -6, 0)) - Vec3(1, -6, 0)), 1e-12);
  EXPECT_FALSE(head.is_lost());
  EXPECT_EQ(head.update(t += 0.4, Vec3(1.1, -6, 0)), Vec3(1.1, -6, 0));
}

constexpr const char* kScene = R"({ "fields": {"s": {"analytic": "sphere"}},
  "isosurfaces": [{"field": "s", "level": 1, "color": [1, 0.5, 0.2]}],
  "streamlines": [{"field": "v", "seeds": [[0.8, 0, 0.5]], "length": 3, "radius": 0.05}],
  "screens": [{"name": "desk", "lower_left": [-2, -2, -1.5], "lower_right": [2, -2, -1.5], "upper_left": [-2, -2, 1.5]}],
  "cursor": {"probe": [0, 0, 0]},
  WORKSPACE
  "camera": {"position": [0, -8, 2], "target": [0, 0, 0]} })";

std::string scene(const std::string& workspace = "") {
  std::string text = kScene;
  text.replace(text.find("WORKSPACE"), 9, workspace);
  text.replace(text.find("\"s\": {"), 0, R"("v": {"analytic": "helix"}, )");
  return text;
}

class HeadTrackedWindow : public test::WindowTest {
 protected:
  int view(const std::string& options) const {
    return run_on_display("export HOME=" + folder_.path() + "\nexec " + test::program_path() + " view " + (folder_ / "s.json") +
                          " --screen desk --size 160x120 --no-panels " + options + "\n");
  }
};

TEST_F(HeadTrackedWindow, ShowsTheImageOfRender) {
  test::write_file(folder_ / "s.json", scene());
  // The head moves to the right and nearer, and rests.
  test::write_file(folder_ / "head.csv", "t,x,y,z\n10,0,-8,2\n10.1,0.8,-7.5,1.5\n10.2,1.6,-6,0.5\n");
  ASSERT_EQ(view("--head " + (folder_ / "head.csv") + " --seconds 1.5 --screenshot " + (folder_ / "w.png")), 0) << log();
  test::run_ok({"render", folder_ / "s.json", "-o", folder_ / "r_%d.png", "--size", "160x120", "--screen", "desk", "--head",
                folder_ / "head.csv", "--frames", "2"});
  const render::Image8 window = picture("w.png"), first = picture("r_0.png"), last = picture("r_1.png");
  ASSERT_EQ(window.width, 160u);
  const auto differing = [&](const render::Image8& other) {
    int count = 0;
    for (std::size_t i = 0; i < window.rgba.size(); ++i) count += std::abs(window.rgba[i] - other.rgba[i]) > 1;
    return count;
  };
  EXPECT_EQ(differing(last), 0);
  EXPECT_GT(differing(first), 2000);
}

/// A device position in metres, mapped by the workspace: 0.1 m to the right, 0.05 m above and 0.6 m in front of the screen's center.
TEST_F(HeadTrackedWindow, ADevicesPositionIsTheHeads) {
  const std::string workspace = R"("workspace": {"metres_per_unit": 0.1, "origin": [0, -2, 0], "rotation": [[1,0,0],[0,0,-1],[0,1,0]]},
    "device": {"type": "simulated", "friction": 0},)";
  test::write_file(folder_ / "s.json", scene(workspace));
  test::write_file(folder_ / "hand.csv", "t,x,y,z\n0,0.1,0.05,0.6\n");
  auto document = test::value_of(scene::Document::open(folder_ / "s.json"));
  auto read = test::value_of(document.read());
  read.stereo.screen_index = 0;
  auto head = test::value_of(TrackedHead::open("simulated:" + (folder_ / "hand.csv"), read));
  ASSERT_TRUE(head->start(0));
  std::optional<Vec3> at;
  for (int k = 0; k < 5000 && !at; ++k) {
    at = head->position_at(1e-3 * k);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_TRUE(at);
  EXPECT_LT(norm(*at - Vec3(1, -8, 0.5)), 1e-3);
}

TEST_F(HeadTrackedWindow, InvalidHeadsAreOneErrorLine) {
  test::write_file(folder_ / "s.json", scene());
  test::write_file(folder_ / "behind.csv", "t,x,y,z\n0,0,3,0\n");
  test::write_file(folder_ / "nan.csv", "t,x,y,z\n0,0,-8,nan\n");
  const auto refused = [&](const std::string& head, const std::string& words) {
    EXPECT_EQ(view("--frames 2 --head " + head), 2) << head;
    EXPECT_TRUE(test::has(log(), words));
    EXPECT_TRUE(test::is_one_line(log()));
  };
  refused(folder_ / "behind.csv", "first position: screen \"desk\": ");
  refused(folder_ / "nan.csv", "nan.csv:2: \"nan\" in column \"z\"");
  refused(folder_ / "none.csv", "none.csv");
  refused("simulated", "the scene's \"workspace\" was expected");
  refused("mouse", "expected");
}

}  // namespace catena::app::tracked_head_test
