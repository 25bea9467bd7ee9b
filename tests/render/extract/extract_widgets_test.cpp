// SPDX-License-Identifier: MIT
// Extracted widgets against closed forms, by mode and handle.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "render/extract/extract_internal.h"
#include "render/extract/widget_shapes.h"
#include "tests/render/support/image_fixture.h"
#include "tests/render/support/scene_packet.h"

namespace catena::test::extract_widgets_test {

using namespace catena::render;
using widget::Kind;
using widget::Mode;

scene::Scene scene_of(const std::string& more = "") {
  return scene_from(R"({"fields": {"s": {"analytic": "sphere", "resolution": 9}}, "chain": [])" + more + "}");
}

const std::string kCamera = R"(, "camera": {"position": [3, -8, 4], "target": [0, 0, 0]})";

scene::Entity add_widget(scene::Scene& scene, const std::string& name, Kind kind, const widget::Pose& pose, Mode mode = Mode::idle,
                         int handle = -1, int held = 0) {
  scene::Widget w;
  w.spec.kind = kind;
  w.spec.pose = w.report.pose = pose;
  w.report.mode = mode;
  w.report.handle = std::int8_t(handle);
  w.report.active_planes = std::uint8_t(held);
  w.is_complete = true;
  const scene::Entity e = scene.entities.create();
  scene.entities.emplace(e, scene::Name{name});
  scene.entities.emplace(e, std::move(w));
  return e;
}

FramePacket packet_of(scene::Scene& scene, std::uint32_t width = 256, std::uint32_t height = 192) {
  return packet_from(scene, width, height);
}

/// Sets the field of an isolevel widget.
void set_field(scene::Scene& scene, scene::Entity widget) {
  const auto field = scene::resolve_field(scene, scene::find_field(scene, "s"), {});
  ASSERT_TRUE(field);
  scene.entities.get<scene::Widget>(widget).spec.field = field->scalar;
}

double luminance(const Color& c) { return c.r + c.g + c.b; }

TEST(PlaneOutline, OfAUnitBoxHasTheExpectedVertices) {
  const auto sizes = [](const Vec3& p, const Vec3& n) { return plane_outline(p, n, {Vec3(0.0), Vec3(1.0)}).size(); };
  EXPECT_EQ(sizes({0.5, 0.5, 0.5}, {1, 1, 1}), 6u);
  EXPECT_EQ(sizes({0.1, 0, 0}, {1, 1, 1}), 3u);
  EXPECT_EQ(sizes({0.5, 0.5, 0.25}, {0, 0, 2}), 4u);
  EXPECT_EQ(sizes({0.5, 0.5, 0.5}, {1, 1, 0}), 4u);  // through two edges
  EXPECT_EQ(sizes({0, 0, 0}, {0, 0, 1}), 4u);        // a face
  EXPECT_EQ(sizes({0, 0, 1}, {0, 0, 1}), 4u);
  EXPECT_EQ(sizes({0, 0, 0}, {1, 1, 1}), 0u);  // touches a corner
  EXPECT_EQ(sizes({0, 0, 1.5}, {0, 0, 1}), 0u);
  EXPECT_EQ(sizes({0, 0, 0}, {0, 0, 0}), 0u);
  EXPECT_TRUE(plane_outline({}, {0, 0, 1}, {}).empty());
}

TEST(PlaneOutline, IsConvexInThePlaneAndOnTheBox) {
  const Bounds box{{-1, -2, 0}, {3, 1, 5}};
  unsigned seed = 7;
  const auto random = [&] { return (seed = seed * 1664525u + 1013904223u) / 4294967296.0; };
  for (int k = 0; k < 2000; ++k) {
    const Vec3 point(-1 + 4 * random(), -2 + 3 * random(), 5 * random());
    const Vec3 normal = direction(Vec3(random() - 0.5, random() - 0.5, random() - 0.5));
    const auto corners = plane_outline(point, normal, box);
    ASSERT_GE(corners.size(), 3u);
    ASSERT_LE(corners.size(), 6u);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()], &c = corners[(i + 2) % corners.size()];
      EXPECT_NEAR(dot(a - point, normal), 0, 1e-9);
      EXPECT_GE(dot(cross(b - a, c - b), normal), -1e-9) << "turns to one side only";
      int on = 0;
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(a[axis], box.lo[axis] - 1e-9);
        EXPECT_LE(a[axis], box.hi[axis] + 1e-9);
        on += std::fabs(a[axis] - box.lo[axis]) < 1e-9 || std::fabs(a[axis] - box.hi[axis]) < 1e-9;
      }
      EXPECT_GE(on, 2) << "on an edge of the box";
    }
  }
}

TEST(ExtractWidgets, ACuttingPlaneHasABorderThreeCirclesAndItsNormal) {
  scene::Scene scene = scene_of(kCamera + R"(, "isosurfaces": [{"field": "s", "level": 1}])");
  const Quat turn = rotation_from_vector({0.3, -0.5, 0.2});
  add_widget(scene, "cut", Kind::cutting_plane, {{Vec3(0.1, 0.2, 0.3), Vec3(0.0)}, turn});
  const FramePacket packet = packet_of(scene);
  ASSERT_EQ(packet.widgets.tubes.size(), 5u);  // border, three circles, the normal's shaft
  ASSERT_EQ(packet.widgets.arrows.size(), 1u);
  const Vec3 centre(0.1, 0.2, 0.3), normal = rotate(turn, {0, 0, 1});
  for (const Vec3& p : packet.widgets.tubes[0].points) {
    EXPECT_NEAR(dot(p - centre, normal), 0, 1e-12);
    EXPECT_NEAR(max_abs(p), 2, 1e-9) << "on the domain's box";
  }
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 e(0.0);
    e[axis] = 1;
    const TubeItem& circle = packet.widgets.tubes[std::size_t(1 + axis)];
    EXPECT_EQ(circle.points.front(), circle.points.back());
    for (const Vec3& p : circle.points) {
      EXPECT_NEAR(norm(p - centre), 0.12 * 4, 1e-12);
      EXPECT_NEAR(dot(p - centre, rotate(turn, e)), 0, 1e-12);
    }
    const float channels[] = {circle.color.r, circle.color.g, circle.color.b};
    EXPECT_EQ(std::max_element(channels, channels + 3) - channels, axis);
  }
  const ArrowItem& arrow = packet.widgets.arrows[0];
  EXPECT_LT(norm(direction(arrow.tip - arrow.base) - normal), 1e-12);
  EXPECT_LT(norm(direction(arrow.tip - centre) - normal), 1e-12);
  // no part is clipped, and all parts are one named object
  for (const TubeItem& tube : packet.widgets.tubes) {
    EXPECT_FALSE(tube.is_clipped);
    EXPECT_EQ(tube.id, arrow.id);
  }
  const auto found = std::find_if(packet.objects.begin(), packet.objects.end(), [&](const auto& o) { return o.id == arrow.id; });
  ASSERT_NE(found, packet.objects.end());
  EXPECT_EQ(found->kind, "widget");
  EXPECT_EQ(found->name, "cut");
}

TEST(ExtractWidgets, WithoutDataThePlaneIsASquareOfEdgeL) {
  scene::Scene scene = scene_of();
  const scene::Entity e = add_widget(scene, "cut", Kind::cutting_plane, {{Vec3(1, 2, 3), Vec3(0.0)}});
  scene.entities.get<scene::Widget>(e).spec.length = 6;
  scene.entities.get<scene::Widget>(e).is_complete = true;  // otherwise resolve_widget() sets 4
  const FramePacket packet = packet_of(scene);
  const TubeItem& border = packet.widgets.tubes[0];
  ASSERT_EQ(border.points.size(), 5u);
  for (const Vec3& p : border.points) {
    EXPECT_NEAR(std::fabs(p.x - 1), 3, 1e-12);
    EXPECT_NEAR(std::fabs(p.y - 2), 3, 1e-12);
    EXPECT_NEAR(p.z, 3, 1e-12);
  }
  // widgets do not affect the camera or the drawn bounds
  scene::Scene bare = scene_of();
  EXPECT_EQ(packet.view.position, packet_of(bare).view.position);
  EXPECT_TRUE(packet_bounds(packet).empty());
}

TEST(ExtractWidgets, FreeAxesAreArrowsAndHeldAxesSquares) {
  for (int held = 0; held < 8; ++held) {
    scene::Scene scene = scene_of(kCamera);
    add_widget(scene, "cut", Kind::cutting_plane, {}, Mode::translate, -1, held);
    const FramePacket packet = packet_of(scene);
    const int squares = (held & 1) + (held >> 1 & 1) + (held >> 2 & 1), free = 3 - squares;
    ASSERT_EQ(packet.widgets.arrows.size(), std::size_t(2 * free)) << held;
    ASSERT_EQ(packet.widgets.tubes.size(), std::size_t(4 + 2 * free)) << held;
    ASSERT_EQ(packet.widgets.meshes.size(), std::size_t(squares)) << held;
    std::size_t next = 0, plate = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (held >> axis & 1) {
        const MeshItem& mesh = packet.widgets.meshes[plate++];
        EXPECT_FALSE(mesh.is_clipped);
        for (const Vec3& p : mesh.geometry->vertices) EXPECT_NEAR(p[axis], 0, 1e-12);
        continue;
      }
      for (const double sign : {1.0, -1.0}) {
        Vec3 along(0.0);
        along[axis] = sign;
        const ArrowItem& arrow = packet.widgets.arrows[next++];
        EXPECT_LT(norm(direction(arrow.tip) - along), 1e-12);
        EXPECT_GT(norm(arrow.tip), 1.5 * 0.12 * 4) << "beyond the sphere";
      }
    }
  }
}

TEST(ExtractWidgets, ModesAndHandlesAreVisible) {
  const auto tubes_of = [](Kind kind, Mode mode, int handle, int held) {
    scene::Scene scene = scene_of(kCamera);
    add_widget(scene, "w", kind, {{Vec3(-1, 0, 0), Vec3(1, 0.5, 0.2)}}, mode, handle, held);
    return packet_of(scene).widgets.tubes;
  };
  const auto plane = [&](Mode mode, int held) { return tubes_of(Kind::cutting_plane, mode, -1, held); };
  const auto away = plane(Mode::idle, 0), explore = plane(Mode::explore, 4), rotate_ = plane(Mode::rotate, 2), turn = plane(Mode::turn, 2);
  EXPECT_GT(explore[0].radius, 1.5 * away[0].radius);
  EXPECT_GT(luminance(explore[0].color), 1.1 * luminance(away[0].color));
  EXPECT_EQ(rotate_[0].radius, away[0].radius);
  for (std::size_t circle = 1; circle <= 3; ++circle) {
    EXPECT_EQ(explore[circle].radius, away[circle].radius);
    EXPECT_GT(rotate_[circle].radius, 1.5 * away[circle].radius);
    if (circle == 2) continue;
    EXPECT_GT(turn[circle].radius, rotate_[circle].radius);
    EXPECT_GT(rotate_[2].radius, 1.3 * rotate_[circle].radius);
    EXPECT_GT(luminance(rotate_[2].color), 1.05 * luminance(rotate_[circle].color));
  }
  EXPECT_GT(luminance(turn[2].color), 1.05 * luminance(rotate_[2].color));

  // only the ball of the active handle, for every kind
  for (const auto& [kind, handles] : {std::pair{Kind::seed, 1}, {Kind::isolevel, 1}, {Kind::rake, 3}, {Kind::ruler, 3}, {Kind::box, 7}})
    for (int handle = 0; handle < handles; ++handle) {
      const auto balls = [&](Mode mode) {
        auto tubes = tubes_of(kind, mode, handle, 7);
        std::erase_if(tubes, [](const TubeItem& tube) { return tube.points.size() != 1; });
        return tubes;
      };
      const auto rest = balls(Mode::idle), hover = balls(Mode::hover), drag = balls(Mode::drag);
      ASSERT_EQ(rest.size(), std::size_t(handles));
      for (std::size_t i = 0; i < rest.size(); ++i) {
        const bool mine = int(i) == handle;
        EXPECT_EQ(hover[i].radius > 1.2 * rest[i].radius, mine) << int(kind) << " " << handle << " " << i;
        EXPECT_EQ(luminance(hover[i].color) > luminance(rest[i].color), mine);
        EXPECT_EQ(luminance(drag[i].color) > luminance(hover[i].color), mine);
      }
    }
}

TEST(ExtractWidgets, OnlyTheDraggedFaceOfABoxHasAnArrowAlongItsNormal) {
  scene::Scene scene = scene_of(kCamera);
  add_widget(scene, "b", Kind::box, {{Vec3(-1, -0.5, -0.2), Vec3(1, 0.5, 0.8)}}, Mode::drag, 3, 5);
  const FramePacket packet = packet_of(scene);
  ASSERT_EQ(packet.widgets.arrows.size(), 2u);
  for (const double sign : {1.0, -1.0}) {
    const ArrowItem& arrow = packet.widgets.arrows[sign > 0 ? 0 : 1];
    EXPECT_LT(norm(direction(arrow.tip - Vec3(0, 0.5, 0.3)) - Vec3(0, sign, 0)), 1e-12);
  }
}

TEST(ExtractWidgets, TheIsolevelsArrowFollowsTheGradient) {
  scene::Scene scene = scene_of(kCamera + R"(, "isosurfaces": [{"field": "s", "level": 1}])");
  const Vec3 at(0.6, -0.7, 0.4);
  const scene::Entity e = add_widget(scene, "l", Kind::isolevel, {{at, Vec3(0.0)}});
  ASSERT_TRUE(packet_of(scene).widgets.arrows.empty()) << "no field yet";
  set_field(scene, e);
  const FramePacket packet = packet_of(scene);
  ASSERT_EQ(packet.widgets.arrows.size(), 1u);
  EXPECT_LT(norm(direction(packet.widgets.arrows[0].tip - at) - direction(at)), 1e-9) << "|x| rises outwards";
}

TEST(ExtractWidgets, ARulerIsLabelledWithItsLength) {
  scene::Scene scene = scene_of(kCamera);
  add_widget(scene, "r", Kind::ruler, {{Vec3(0, 0, 0), Vec3(3, 4, 0)}});
  const FramePacket packet = packet_of(scene);
  ASSERT_EQ(packet.overlay.labels.size(), 1u);
  EXPECT_EQ(packet.overlay.labels[0].text, "5 units");
  EXPECT_EQ(packet.overlay.labels[0].position, Vec3(1.5, 2, 0));
}

TEST(ExtractWidgets, ARulerAlongACurveIsDrawnAlongIt) {
  scene::Scene scene = scene_from(R"({"fields": {"v": {"analytic": "circle"}},
    "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [1, 0, 0]}],
    "widgets": [{"name": "r", "type": "ruler", "from": [1, 0, 0], "to": [0, 1, 0], "along": ["curve"]}]})");
  FramePacket packet = packet_of(scene);
  const auto longest = [&] {
    return *std::max_element(packet.widgets.tubes.begin(), packet.widgets.tubes.end(),
                             [](const auto& a, const auto& b) { return a.points.size() < b.points.size(); });
  };
  ASSERT_GT(longest().points.size(), 8u);
  for (const Vec3& p : longest().points) EXPECT_NEAR(norm(p), 1, 1e-3);
  ASSERT_EQ(packet.overlay.labels.size(), 1u);
  EXPECT_EQ(packet.overlay.labels[0].text, "1.571 units");
  EXPECT_NEAR(norm(packet.overlay.labels[0].position - Vec3(std::sqrt(0.5), std::sqrt(0.5), 0)), 0, 1e-2) << "halfway";
  EXPECT_NEAR(norm(packet.overlay.labels[0].position), 1, 1e-6) << "on the line";
  // set_view() keeps the curve
  const std::size_t before = packet.widgets.tubes.size();
  set_view(scene, {{0, -3, 9}, {0, 0, 0}, {0, 0, 1}, 30}, packet);
  EXPECT_EQ(packet.widgets.tubes.size(), before);
  EXPECT_GT(longest().points.size(), 5u);
  EXPECT_EQ(packet.overlay.labels.size(), 1u);
}

TEST(ExtractWidgets, TubesAreAtLeastAPixelWideFromFarAway) {
  scene::Scene scene = scene_of(R"(, "camera": {"position": [0, -400, 0], "target": [0, 0, 0], "fovy_deg": 30})");
  add_widget(scene, "cut", Kind::cutting_plane, {}, Mode::translate, -1, 1);
  add_widget(scene, "r", Kind::rake, {{Vec3(-1, 0, 0), Vec3(1, 0, 0)}});
  FramePacket packet = packet_of(scene, 200, 100);
  const double pixel = 2 * 400 * std::tan(15 * 3.14159265358979 / 180) / 100;
  for (const TubeItem& tube : packet.widgets.tubes) EXPECT_GE(2 * tube.radius, pixel);
  // after set_view() to a nearer camera the tubes have their stated sizes
  const auto ids = packet.objects.size();
  set_view(scene, {{0, -8, 0}, {0, 0, 0}, {0, 0, 1}, 30}, packet);
  EXPECT_EQ(packet.objects.size(), ids);
  for (const TubeItem& tube : packet.widgets.tubes)
    if (tube.points.size() > 1) {
      EXPECT_LT(tube.radius, 0.1);
    }
  EXPECT_EQ(packet.widgets.tubes.front().id, 1u);
}

TEST(ExtractWidgets, NonFiniteWidgetsAreSkipped) {
  scene::Scene scene = scene_of(kCamera);
  add_widget(scene, "a", Kind::seed, {{Vec3(NAN, 0, 0), Vec3(0.0)}});
  add_widget(scene, "b", Kind::cutting_plane, {{Vec3(0.0), Vec3(0.0)}, Quat(NAN, 0, 0, 0)});
  add_widget(scene, "c", Kind::rake, {{Vec3(0.0), Vec3(0, INFINITY, 0)}});
  EXPECT_TRUE(packet_of(scene).widgets.empty());
  add_widget(scene, "d", Kind::ruler, {});  // of length zero
  EXPECT_FALSE(packet_of(scene).widgets.empty());
}

class WidgetImages : public ImageTest {};

std::uint32_t id_named(const FramePacket& packet, const std::string& name) {
  for (const ObjectName& object : packet.objects)
    if (object.kind == "widget" && object.name == name) return object.id;
  return 0;
}

TEST_F(WidgetImages, CirclesAreDrawnAtTheirProjection) {
  scene::Scene scene = scene_of(kCamera);
  const Quat turn = rotation_from_vector({0.4, 0.1, -0.3});
  const scene::Entity e = add_widget(scene, "cut", Kind::cutting_plane, {{Vec3(0.0), Vec3(0.0)}, turn});
  scene::Widget& w = scene.entities.get<scene::Widget>(e);
  w.spec.radius = 1.2;
  w.spec.length = 0.6;  // thin lines, a small square
  FramePacket packet = packet_of(scene);
  draw(packet, {}, "picture");
  const std::vector<std::uint32_t> drawn = ids();
  const std::uint32_t id = id_named(packet, "cut");
  const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
  // every projected point of a circle has a drawn pixel within one pixel
  std::vector<bool> explained(drawn.size());
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 2000; ++k) {
      const double angle = k * 2 * 3.14159265358979 / 2000;
      Vec3 p(0.0);
      p[(axis + 1) % 3] = 1.2 * std::cos(angle);
      p[(axis + 2) % 3] = 1.2 * std::sin(angle);
      const auto at = project(camera, rotate(turn, p));
      ASSERT_TRUE(at);
      const int x = int(std::floor(at->x)), y = int(std::floor(at->y));
      bool near = false;
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
          const std::size_t i = std::size_t(y + dy) * packet.width + std::size_t(x + dx);
          explained[i] = true;
          near = near || (std::max(std::abs(dx), std::abs(dy)) <= 1 && drawn[i] == id);
        }
      ASSERT_TRUE(near) << axis << " " << k << ": " << at->x << " " << at->y;
    }
  // every drawn pixel far from the centre belongs to a circle or the normal's arrow
  const auto tip = project(camera, rotate(turn, {0, 0, 1.45 * 1.2}));
  int stray = 0, seen = 0;
  for (const auto& [x, y] : pixels_of(packet)) {
    const std::size_t i = y * packet.width + x;
    if (drawn[i] != id) continue;
    ++seen;
    const double along_x = tip->x - 128, along_y = tip->y - 96, length = std::hypot(along_x, along_y);
    const double beside = std::fabs((x + 0.5 - 128) * along_y - (y + 0.5 - 96) * along_x) / length;
    if (!explained[i] && beside > 8 && std::hypot(x + 0.5 - 128, y + 0.5 - 96) > 18) ++stray;
  }
  EXPECT_GT(seen, 500);
  EXPECT_EQ(stray, 0);
}

TEST_F(WidgetImages, ImagesAreRepeatableAndModesDiffer) {
  const auto picture_of = [&](Mode mode, int held) {
    scene::Scene scene = scene_of(kCamera + R"(, "isosurfaces": [{"field": "s", "level": 1}])");
    scene.clip_planes.push_back({{{0, 0, 0}, {0, 0, -1}}});
    add_widget(scene, "cut", Kind::cutting_plane, {}, mode, -1, held);
    const FramePacket packet = packet_of(scene);
    return draw(packet, {}, std::string(to_string(mode)) + std::to_string(held));
  };
  const Image8 away = picture_of(Mode::idle, 0);
  EXPECT_EQ(away.rgba, picture_of(Mode::idle, 0).rgba);
  std::vector<Image8> all{away};
  for (const auto& [mode, held] :
       {std::pair{Mode::explore, 4}, {Mode::translate, 3}, {Mode::translate, 0}, {Mode::rotate, 0}, {Mode::rotate, 1}, {Mode::turn, 1}}) {
    const Image8 one = picture_of(mode, held);
    for (const Image8& other : all) {
      int changed = 0;
      for (std::size_t i = 0; i < one.rgba.size(); i += 4) changed += std::abs(one.rgba[i] - other.rgba[i]) > 30;
      EXPECT_GT(changed, 30) << to_string(mode) << " " << held;
    }
    all.push_back(one);
  }
}

TEST_F(WidgetImages, ClipPlanesDoNotCutWidgets) {
  scene::Scene scene = scene_of(kCamera);
  add_widget(scene, "s", Kind::seed, {{Vec3(0, 0, 0), Vec3(0.0)}});
  const Image8 whole = draw(packet_of(scene));
  scene.clip_planes.push_back({{{0, 0, 5}, {0, 0, 1}}});
  EXPECT_EQ(draw(packet_of(scene)).rgba, whole.rgba);
}

TEST_F(WidgetImages, EveryWidgetIsPickableAndDrawnInBothEyes) {
  scene::Scene scene = scene_of(kCamera);
  add_widget(scene, "seed", Kind::seed, {{Vec3(-1.2, 0, 1), Vec3(0.0)}});
  add_widget(scene, "rake", Kind::rake, {{Vec3(-1.5, 0, -0.6), Vec3(-0.5, 0, -1)}});
  add_widget(scene, "box", Kind::box, {{Vec3(0.4, -0.4, 0.2), Vec3(1.4, 0.4, 1)}}, Mode::hover, 3);
  add_widget(scene, "ruler", Kind::ruler, {{Vec3(0.2, 0, -1), Vec3(1.4, 0, -0.5)}});
  FramePacket packet = packet_of(scene);
  const Image8 mono = draw(packet, {}, "picture");
  const std::vector<std::uint32_t> drawn = ids();
  const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
  const auto id_at = [&](const Vec3& p) {
    const auto at = project(camera, p);
    return drawn[std::size_t(at->y) * packet.width + std::size_t(at->x)];
  };
  EXPECT_EQ(id_at({-1.2, 0, 1}), id_named(packet, "seed"));
  EXPECT_EQ(id_at({-1, 0, -0.8}), id_named(packet, "rake"));
  EXPECT_EQ(id_at({-1.5, 0, -0.6}), id_named(packet, "rake"));
  EXPECT_EQ(id_at({1.4, -0.4, 1}), id_named(packet, "box"));
  EXPECT_EQ(id_at({0.9, -0.4, 0.6}), id_named(packet, "box")) << "a face's handle";
  EXPECT_EQ(id_at({0.2, 0, -1}), id_named(packet, "ruler"));
  EXPECT_EQ(id_at({0, 0, 0}), 0u);

  scene.stereo = scene_from(R"({"fields": {}, "chain": [], "stereo": {"mode": "side-by-side"}})").stereo;
  packet = packet_of(scene, 128, 96);
  ASSERT_EQ(packet.eyes.size(), 2u);
  const Image8 both = draw(packet, {}, "stereo");
  ASSERT_EQ(both.width, 256u);
  int left = 0, right = 0, differ = 0;
  for (std::uint32_t y = 0; y < both.height; ++y)
    for (std::uint32_t x = 0; x < 128; ++x) {
      left += both.pixel(x, y)[0] > 60;
      right += both.pixel(128 + x, y)[0] > 60;
      differ += std::abs(both.pixel(x, y)[0] - both.pixel(128 + x, y)[0]) > 40;
    }
  EXPECT_GT(left, 300);
  EXPECT_NEAR(left, right, 0.2 * left);
  EXPECT_GT(differ, 20);
}

// For visual inspection: CATENA_GALLERY=1 draws every widget in every mode, large, on dark and light backgrounds.
TEST_F(WidgetImages, Gallery) {
  if (std::getenv("CATENA_GALLERY") == nullptr) GTEST_SKIP() << "CATENA_GALLERY is not set";
  struct Case {
    const char* name;
    Kind kind;
    Mode mode;
    int handle, held;
  };
  const Case cases[] = {{"plane_away", Kind::cutting_plane, Mode::idle, -1, 0},
                        {"plane_explore", Kind::cutting_plane, Mode::explore, -1, 4},
                        {"plane_free", Kind::cutting_plane, Mode::translate, -1, 0},
                        {"plane_two", Kind::cutting_plane, Mode::translate, -1, 3},
                        {"plane_held", Kind::cutting_plane, Mode::translate, -1, 7},
                        {"plane_rotate", Kind::cutting_plane, Mode::rotate, -1, 0},
                        {"plane_rotate_x", Kind::cutting_plane, Mode::rotate, -1, 1},
                        {"plane_turn_y", Kind::cutting_plane, Mode::turn, -1, 2},
                        {"seed", Kind::seed, Mode::idle, -1, 0},
                        {"seed_hover", Kind::seed, Mode::hover, 0, 0},
                        {"seed_drag", Kind::seed, Mode::drag, 0, 6},
                        {"rake", Kind::rake, Mode::idle, -1, 0},
                        {"rake_hover", Kind::rake, Mode::hover, 1, 0},
                        {"rake_drag", Kind::rake, Mode::drag, 2, 3},
                        {"level", Kind::isolevel, Mode::hover, 0, 0},
                        {"level_drag", Kind::isolevel, Mode::drag, 0, 0},
                        {"box", Kind::box, Mode::hover, 2, 0},
                        {"box_drag", Kind::box, Mode::drag, 2, 5},
                        {"ruler", Kind::ruler, Mode::idle, -1, 0},
                        {"ruler_drag", Kind::ruler, Mode::drag, 1, 4}};
  for (const bool light : {false, true})
    for (const Case& c : cases) {
      scene::Scene scene =
          scene_of(kCamera + R"(, "isosurfaces": [{"field": "s", "level": 1.2, "color": [0.6, 0.7, 0.85]}], "background": )" +
                   (light ? "[1, 1, 1]" : "[0, 0, 0]"));
      const Vec3 on = 1.2 * direction(Vec3(0.3, -0.8, 0.5));
      widget::Pose pose{{on, Vec3(0.9, -1.3, 1.3)}};
      if (c.kind == Kind::cutting_plane) {
        pose = {{Vec3(0, 0, 0.2), Vec3(0.0)}, rotation_from_vector({0.15, -0.2, 0.1})};
        scene.clip_planes.push_back({pose.points[0], -1.0 * rotate(pose.orientation, {0, 0, 1})});
      }
      if (c.kind == Kind::isolevel) pose.points[0] = 1.2 * direction(Vec3(0.9, -0.5, 0.5));
      if (c.kind == Kind::rake) pose = {{Vec3(-1.2, -1.3, -0.6), Vec3(1, -1.3, 0.8)}};
      if (c.kind == Kind::box) pose = {{Vec3(-0.8, -1.4, -0.6), Vec3(1, 0.2, 1.4)}};
      const scene::Entity e = add_widget(scene, "w", c.kind, pose, c.mode, c.handle, c.held);
      if (c.kind == Kind::isolevel) set_field(scene, e);
      draw(packet_of(scene, 640, 480), {}, std::string(c.name) + (light ? "_light" : ""));
    }
}

}  // namespace catena::test::extract_widgets_test
