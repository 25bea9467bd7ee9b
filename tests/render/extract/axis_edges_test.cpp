// SPDX-License-Identifier: MIT
// The edges of a box that carry the axes, for cameras with known results; ticks and numbers never overlap the box.
#include "render/extract/axis_edges.h"

#include <cmath>

#include "render/frame/camera.h"
#include "tests/render/support/scene_packet.h"

namespace catena::render::axis_edges_test {

const Bounds kBox{{-1, -2, -3}, {1, 2, 3}};

/// Text of an edge, for example "-y -z" for the edge along x at minimum y and z.
std::string words(const AxisEdge& edge) {
  std::string text;
  for (int a = 0; a < 3; ++a) {
    if (edge.from[a] != edge.to[a]) continue;
    text += std::string(text.empty() ? "" : " ") + (edge.from[a] == kBox.lo[a] ? "-" : "+") + "xyz"[a];
  }
  return text;
}

std::string words(const Vec3& out) {
  for (int a = 0; a < 3; ++a)
    if (out[a] != 0) return std::string(out[a] < 0 ? "-" : "+") + "xyz"[a];
  return "none";
}

View from(const Vec3& position, bool orthographic = false) { return {position, Vec3(0.0), {0.0, 0.0, 1.0}, 30, orthographic, 10}; }

TEST(AxisEdges, AreOnTheOutlineOfTheBox) {
  struct Case {
    Vec3 eye;
    const char* edges[3];
  };
  for (const bool orthographic : {false, true})
    for (const Case& c : {Case{{-10, -16, 8}, {"-y -z", "-x -z", "-x +y"}},    // from the left, the front and above
                          Case{{10, -16, 8}, {"-y -z", "+x -z", "-x -y"}},     // from the right
                          Case{{10, 16, 8}, {"+y -z", "+x -z", "+x -y"}},      // from behind
                          Case{{-10, 16, 8}, {"+y -z", "-x -z", "+x +y"}},     //
                          Case{{-10, -16, -8}, {"+y -z", "+x -z", "-x +y"}}})  // from below: the rear edges are the lowest
    {
      const auto edges = find_axis_edges(kBox, from(c.eye, orthographic));
      for (int a = 0; a < 3; ++a) {
        EXPECT_EQ(words(edges[std::size_t(a)]), c.edges[a]) << c.eye.x << " " << c.eye.y << " " << c.eye.z;
        EXPECT_EQ(edges[std::size_t(a)].from[a], kBox.lo[a]);
        EXPECT_EQ(edges[std::size_t(a)].to[a], kBox.hi[a]);
      }
    }
}

TEST(AxisEdges, OfAFaceSeenHeadOnAreTheLowerAndLeftEdges) {
  for (const bool orthographic : {false, true}) {
    const auto edges = find_axis_edges(kBox, from({0, -20, 0}, orthographic));
    EXPECT_EQ(words(edges[0]), "-y -z");
    EXPECT_EQ(words(edges[0].outward), "-z");
    EXPECT_EQ(words(edges[2]), "-x -y");
    EXPECT_EQ(words(edges[2].outward), "-x");
    EXPECT_EQ(words(edges[1]).find("+z"), std::string::npos) << "across the picture it is a point, or low: " << words(edges[1]);
  }
  // inside the box there is no outline
  for (const AxisEdge& edge : find_axis_edges(kBox, from({0.1, 0.2, 0.3}))) EXPECT_NEAR(norm(edge.outward), 1, 1e-12);
}

/// True if a ray intersects the slightly shrunk box.
bool meets(const Ray& ray) {
  double enter = -HUGE_VAL, leave = HUGE_VAL;
  for (int a = 0; a < 3; ++a) {
    const double p = (kBox.lo[a] + 1e-6 - ray.origin[a]) / ray.direction[a], q = (kBox.hi[a] - 1e-6 - ray.origin[a]) / ray.direction[a];
    enter = std::max(enter, std::min(p, q));
    leave = std::min(leave, std::max(p, q));
  }
  return enter < leave;
}

TEST(AxisEdges, TicksAndNumbersNeverOverlapTheBox) {
  for (const bool orthographic : {false, true})
    for (int i = 0; i < 400; ++i) {
      const double z = 1 - (2 * i + 1) / 400.0, r = std::sqrt(1 - z * z), turn = 2.399963229728653 * i;
      const View view = from(15.0 * Vec3(r * std::cos(turn), r * std::sin(turn), z), orthographic);
      const Camera camera = make_camera(view, 400, 400, Bounds());
      const auto edges = find_axis_edges(kBox, view);
      for (std::size_t a = 0; a < 3; ++a) {
        // cameras within a slab of the box see one face only, without an edge for the third axis
        bool slab = false;
        for (std::size_t b = 0; b < 3; ++b) slab = slab || (b != a && !orthographic && std::fabs(view.position[int(b)]) < kBox.hi[int(b)]);
        if (slab) continue;
        for (const double t : {0.01, 0.5, 0.99}) {
          const Vec3 on = edges[a].from + t * (edges[a].to - edges[a].from);
          for (const double reach : {0.05, 0.3, 1.0}) {
            const auto place = project(camera, on + reach * edges[a].outward);
            ASSERT_TRUE(place);
            EXPECT_FALSE(meets(pixel_ray(camera, place->x, place->y))) << i << " axis " << a << " " << t << " " << reach;
          }
        }
      }
    }
}

TEST(AxisEdges, AreEqualInEveryEyeAndTile) {
  View view = from({-10, -16, 8});
  const auto whole = find_axis_edges(kBox, view);
  view.window = {0, 1, 0, 0.5};
  view.aspect = 2;
  const auto tile = find_axis_edges(kBox, view);
  for (std::size_t a = 0; a < 3; ++a) EXPECT_TRUE(whole[a].from == tile[a].from && whole[a].outward == tile[a].outward);
}

TEST(AxisEdges, FollowTheViewOfAPacket) {
  scene::Scene scene =
      test::scene_from(R"({"fields": {"s": {"analytic": "sphere", "resolution": 9}}, "isosurfaces": [{"field": "s", "level": 1}],
    "axes": true, "bounding_box": true, "labels": [{"at": [0, 0, 0], "text": "here"}],
    "camera": {"position": [-10, -16, 8], "target": [0, 0, 0]}})");
  FramePacket packet = test::packet_from(scene, 64, 48);
  const std::size_t tubes = packet.environment.tubes.size(), labels = packet.overlay.axis_labels.size(), objects = packet.objects.size();
  ASSERT_GT(labels, 12u);
  const auto name_of_x = [&] {
    for (const LabelItem& label : packet.overlay.axis_labels)
      if (label.text == "x") return label.position;
    return Vec3(0.0);
  };
  EXPECT_LT(name_of_x().y, -2 + 1e-9);
  View behind = packet.view;
  behind.position = {10, 16, 8};
  set_view(scene, behind, packet);
  EXPECT_GT(name_of_x().y, 2 - 1e-9);
  EXPECT_EQ(packet.environment.tubes.size(), tubes) << "twelve edges and the ticks";
  EXPECT_EQ(packet.overlay.axis_labels.size(), labels);
  EXPECT_EQ(packet.overlay.labels.size(), 1u) << "the scene's own stay";
  EXPECT_EQ(packet.objects.size(), objects);
}

}  // namespace catena::render::axis_edges_test
