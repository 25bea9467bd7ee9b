// SPDX-License-Identifier: MIT
// The object that is felt is the object that is drawn. The tests pick random pixels of each kind of item, simulate the link that the
// window makes for the item, and compare the proxy's position with the depth in the image.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "engine/app/tuning/figures/figures.h"
#include "engine/app/viewer/edit/haptic_binding.h"
#include "engine/app/viewer/input/pick.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "render/extract/extract.h"
#include "tests/engine/app/open_scene_model.h"
#include "tests/render/support/image_fixture.h"
#include "tests/support/curve_files.h"
#include "tests/support/mesh_shapes.h"
#include "tests/support/results.h"

namespace catena::app::feel_matches_image_test {

using test::fails;
using test::value_of;

constexpr int kPixels = 20, kTicks = 400;

class FeelMatchesImage : public test::ImageTest {
 protected:
  void show(const std::string& text) {
    ASSERT_NO_FATAL_FAILURE(test::open_scene(folder_, text, host_));
    packet_ = value_of(render::make_frame(host_->scene(), 320, 240));
    draw(packet_);
    camera_ = render::make_camera(packet_.view, packet_.width, packet_.height, Bounds());
  }

  /// A pixel that shows an item of the given part, away from its silhouette, and its position.
  PickHit random_place(const std::string& part) {
    std::uniform_int_distribution<int> column(4, 315), row(4, 235);
    for (int tries = 0; tries < 4000; ++tries) {
      const double x = column(random_) + 0.5, y = row(random_) + 0.5;
      bool inner = true;
      for (const auto& [dx, dy] : {std::pair{0, 0}, {-3, 0}, {3, 0}, {0, -3}, {0, 3}}) {
        const auto there = pick_on_cpu(packet_, x + dx, y + dy);
        inner = inner && there && item_of(*there).starts_with(part);
      }
      if (!inner) continue;
      pixel_ = {x, y};
      return pick_on_cpu(packet_, x, y).value();
    }
    throw std::runtime_error("no pixel shows " + part);
  }
  std::string item_of(const PickHit& place) const { return packet_.objects[place.id - 1].scene_path; }
  double pixel_at(const Vec3& p) const { return render::pixel_size(camera_, render::project(camera_, p)->z); }
  /// The position in the image at that pixel, from the depth buffer.
  Vec3 drawn_at(double x, double y) {
    const auto texel = renderer_->pick(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    EXPECT_TRUE(texel);
    return render::unproject(camera_, x, y, texel->depth);
  }

  struct Contact {
    Vec3 touched{0.0}, pressed{0.0};  ///< the proxy where the hand is placed, and after it is pushed
    double force_n = 0;
    Vec3 hand{0.0};
    std::string words;
  };
  HapticBinding binding_at(const PickHit& place) {
    return value_of(make_haptic_binding(host_->scene(), item_of(place), place.world, packet_.view.position, 4));
  }
  /// Makes the link as the window does, places the hand at the position, and pushes along the view direction.
  Contact feel_at(const PickHit& place, double push) {
    Contact contact;
    const HapticBinding thing = binding_at(place);
    contact.words = thing.description;
    const std::string text = host_->document().text();
    TickSimulation hand(text.substr(0, text.rfind('}')) + ", \"chain\": [" + thing.link_json + "]}");
    const Vec3 ahead = direction(place.world - packet_.view.position);
    for (int k = 0; k <= kTicks; ++k) {
      const double share = std::max(0.0, (k - 50) / double(kTicks - 50));
      contact.hand = place.world + share * push * ahead;
      const HapticState& state = hand.step(1e-3 * k, contact.hand);
      if (k == 0) contact.touched = state.links[0].proxy;
      contact.pressed = state.links[0].proxy;
      contact.force_n = norm(state.force_n);
    }
    return contact;
  }
  /// At random pixels of the part, the touched point is the drawn one, except for the radius of a tube, and a push has a force.
  void expect_felt(
      const std::string& part, double push, double radius = 0,
      const std::function<void(const PickHit&, const Contact&)>& more = [](const PickHit&, const Contact&) {}) {
    for (int k = 0; k < kPixels; ++k) {
      const PickHit place = random_place(part);
      const Contact contact = feel_at(place, push);
      EXPECT_LE(norm(contact.touched - place.world), radius + pixel_at(place.world)) << contact.words;
      EXPECT_GT(contact.force_n, 0.05);
      more(place, contact);
    }
  }

  test::TemporaryFolder folder_;
  std::optional<SceneModel> host_;
  render::FramePacket packet_;
  render::Camera camera_;
  std::array<double, 2> pixel_{};
  std::mt19937 random_{20261122};
};

TEST_F(FeelMatchesImage, PickingFindsTheDrawnObjectAndDepth) {
  show(R"({"fields": {"g": {"analytic": "gaussian", "resolution": 48}, "flow": {"analytic": "hill", "resolution": 32}},
           "isosurfaces": [{"field": "g", "level": 0.4}], "slices": [{"field": "g", "axis": "x", "at": -0.7}],
           "streamlines": [{"field": "flow", "radius": 0.03, "length": 3, "seeds": [[0.2, 0.1, -0.4], [0.5, 0.5, 0.1]]}],
           "clip": [{"plane": {"point": [0.1, 0, 0], "normal": [-1, -0.3, 0.2]}}]})");
  int things = 0;
  for (int k = 0; k < 800; ++k) {
    const double x = std::uniform_int_distribution<int>(0, 319)(random_) + 0.5,
                 y = std::uniform_int_distribution<int>(0, 239)(random_) + 0.5;
    const auto place = pick_on_cpu(packet_, x, y);
    const auto texel = renderer_->pick(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    ASSERT_TRUE(texel);
    // At an edge, either object may be nearer.
    bool edge = false;
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const auto u = static_cast<std::uint32_t>(std::clamp(int(x) + dx, 0, 319)),
                 v = static_cast<std::uint32_t>(std::clamp(int(y) + dy, 0, 239));
      edge = edge || renderer_->pick(u, v)->id != texel->id;
    }
    if (edge) continue;
    EXPECT_EQ(place ? place->id : 0, texel->id) << x << " " << y;
    if (!place || texel->id == 0) continue;
    ++things;
    EXPECT_NEAR(render::project(camera_, place->world)->z, texel->depth, 1.5 * pixel_at(place->world)) << object_label(packet_, place->id);
  }
  EXPECT_GT(things, 60);
}

TEST_F(FeelMatchesImage, AnIsosurfaceIsFeltWhereItIsDrawn) {
  show(R"({"fields": {"g": {"analytic": "gaussian", "resolution": 48}}, "isosurfaces": [{"field": "g", "level": 0.37}],
           "camera": {"position": [5, -3, 2], "target": [0, 0, 0]}, "workspace": {"metres_per_unit": 0.05}})");
  expect_felt("isosurfaces", 0.05, 0, [&](const PickHit& place, const Contact& contact) {
    EXPECT_EQ(contact.words, "isosurface g at 0.37");
    EXPECT_LE(norm(contact.touched - drawn_at(pixel_[0], pixel_[1])), 1.5 * pixel_at(place.world));
    // The proxy of the pressed hand stays on the drawn surface.
    const auto at = render::project(camera_, contact.pressed);
    const Vec3 drawn = drawn_at(std::floor(at->x) + 0.5, std::floor(at->y) + 0.5);
    EXPECT_LE(norm(drawn - contact.pressed), 3 * pixel_at(contact.pressed)) << "half a pixel sideways on an oblique surface";
    EXPECT_GT(norm(contact.hand - contact.pressed), 0.01);
  });
}

TEST_F(FeelMatchesImage, AVolumeIsFeltAsTheIsosurfaceOfThePickedValue) {
  show(R"({"fields": {"g": {"analytic": "gaussian", "resolution": 48}},
           "volumes": [{"field": "g", "extinction": [[0.3, 0], [0.31, 40], [1, 40]]}], "workspace": {"metres_per_unit": 0.05}})");
  expect_felt("volumes", 0.05);
}

TEST_F(FeelMatchesImage, OnlyThePickedLabelOfALabelMapIsFelt) {
  std::string bytes;
  for (int z = 0; z < 24; ++z)
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) bytes += static_cast<char>(std::hypot(x - 11.5, y - 11.5, z - 11.5) > 9 ? 0 : x < 12 ? 5 : 6);
  test::write_file(folder_ / "m.raw", bytes);
  show(
      R"({"fields": {"m": {"file": "m.raw", "shape": [24, 24, 24], "type": "uint8", "labels": {"values": [5, 6], "names": ["Left one", "Right"]}},
           "all": {"label": "*", "of": "m"}}, "isosurfaces": [{"field": "all", "level": 0.5, "color_by": {"field": "m"}}]})");
  std::set<std::string> words;
  for (int k = 0; k < kPixels; ++k) {
    const PickHit place = random_place("isosurfaces");
    const HapticBinding thing = binding_at(place);
    words.insert(thing.description);
    if (std::fabs(place.world.x - 11.5) > 0.6) {
      EXPECT_EQ(thing.description, place.world.x < 11.5 ? "label Left one (5)" : "label Right (6)");
    }
    if (thing.description != "label Left one (5)") continue;
    // The first binding adds the label's field together with the link; later ones find the link.
    const bool known = !find_bound_link(host_->scene(), thing).empty();
    EXPECT_EQ(thing.new_field.has_value(), !known);
    if (known) continue;
    EXPECT_EQ(thing.new_field->first, "/fields/left_one");
    value_of(host_->apply({{thing.new_field->first, thing.new_field->second}, {"/chain/-", thing.link_json}}, "feel"));
    ASSERT_TRUE(scene::resolve_field(host_->scene(), "left_one", {}));
  }
  EXPECT_EQ(words.size(), 2u) << "both are seen";
}

TEST_F(FeelMatchesImage, ThePickedStreamlineIsFelt) {
  show(R"({"fields": {"flow": {"analytic": "helix", "resolution": 40}},
           "streamlines": [{"field": "flow", "radius": 0.04, "length": 2, "seeds": [[0.6, 0, -0.8], [-0.5, 0.2, 0.1], [0, 0.9, 0.4]]}],
           "workspace": {"metres_per_unit": 0.05}})");
  std::set<std::string> links;
  expect_felt("streamlines", 0.2, 0.04, [&](const PickHit& place, const Contact&) { links.insert(binding_at(place).link_json); });
  EXPECT_GE(links.size(), 2u) << "the picture shows several lines";
}

TEST_F(FeelMatchesImage, ASliceIsFeltAsItsPlane) {
  show(
      R"({"fields": {"g": {"analytic": "gaussian", "resolution": 32}}, "slices": [{"field": "g", "point": [0, 0.1, 0], "normal": [1, -2, 0.5]}],
           "workspace": {"metres_per_unit": 0.05}})");
  expect_felt("slices", 0.1, 0, [&](const PickHit&, const Contact& contact) {
    EXPECT_LE(std::abs(dot(direction(Vec3(1, -2, 0.5)), contact.pressed - Vec3(0, 0.1, 0))), 1e-9);
  });
}

/// The scene of one mesh; TickSimulation needs its absolute path.
std::string mesh_scene(const std::string& file) {
  return R"({"meshes": [{"name": "ball", "file": ")" + file + R"("}], "workspace": {"metres_per_unit": 0.05}})";
}

TEST_F(FeelMatchesImage, AMeshIsFeltWhereItIsDrawn) {
  test::write_file(folder_ / "ball.stl", test::binary_stl(test::sphere_soup(24, 0.8)));
  show(mesh_scene(folder_ / "ball.stl"));
  expect_felt("meshes", 0.05);
}

TEST_F(FeelMatchesImage, ThePickedCurveOfAFileIsFelt) {
  test::Polylines lines;
  for (int k = 0; k < 12; ++k) {
    lines.emplace_back();
    for (int i = 0; i <= 60; ++i) {
      const double t = 0.1 * i;
      lines.back().push_back({0.9 * std::cos(t) + 0.02 * k, 0.15 * k - 0.9, 0.9 * std::sin(t)});
    }
  }
  test::write_file(folder_ / "fibres.tck", test::tck_bytes(lines, "Float32BE"));
  show(R"({"curves": [{"name": "fibres", "file": ")" + (folder_ / "fibres.tck") + R"(", "radius": 0.03}],
           "workspace": {"metres_per_unit": 0.05}})");
  std::set<int> held;
  expect_felt("curves", 0.06, 0.03, [&](const PickHit& place, const Contact& contact) {
    EXPECT_EQ(contact.words, "curves fibres");
    EXPECT_LE(norm(contact.touched - drawn_at(pixel_[0], pixel_[1])), 0.03 + 1.5 * pixel_at(place.world));
    // The proxy of the pressed hand stays on that line.
    EXPECT_NEAR(contact.pressed.y, contact.touched.y, 1e-9);
    held.insert(static_cast<int>(std::lround((contact.pressed.y + 0.9) / 0.15)));
  });
  EXPECT_GE(held.size(), 4u) << "the picture shows many lines";
}

TEST_F(FeelMatchesImage, ThePickedPointOfATableIsFelt) {
  std::string table = "x,y,z\n";
  std::uniform_real_distribution<double> place(-0.9, 0.9);
  for (int k = 0; k < 60; ++k) table += fmt::format("{},{},{}\n", place(random_), place(random_), place(random_));
  test::write_file(folder_ / "table.csv", table);
  show(R"({"points": [{"name": "dots", "file": ")" + (folder_ / "table.csv") + R"(", "radius": 0.06}],
           "workspace": {"metres_per_unit": 0.05}})");
  expect_felt("points", 0.03, 0.06, [&](const PickHit& at, const Contact& contact) {
    EXPECT_LE(norm(at.world - drawn_at(pixel_[0], pixel_[1])), 1.5 * pixel_at(at.world)) << "picked where it is drawn";
    EXPECT_EQ(contact.words, "points dots");
    EXPECT_NEAR(norm(contact.pressed - at.world), 0.06, 1e-6) << "the middle of the ball";
  });
}

TEST_F(FeelMatchesImage, TheFreeSideIsTheCamerasSideForEitherMeshOrientation) {
  mesh::TriangleSoup soup = test::sphere_soup(16, 0.8);
  test::write_file(folder_ / "out.stl", test::binary_stl(soup));
  for (auto& triangle : soup.triangles) std::swap(triangle[0], triangle[1]);
  test::write_file(folder_ / "in.stl", test::binary_stl(soup));
  for (const std::string name : {"out", "in"}) {
    show(mesh_scene(folder_ / (name + ".stl")));
    EXPECT_GT(feel_at(random_place("meshes"), 0.05).force_n, 0.05) << name;
  }
}

TEST_F(FeelMatchesImage, AConstantFieldHasNoSurface) {
  show(R"({"fields": {"c": {"analytic": "constant", "resolution": 16}}, "volumes": [{"field": "c"}]})");
  EXPECT_TRUE(fails(make_haptic_binding(host_->scene(), "volumes[0]", Vec3(0.0), Vec3(9, 9, 9), 4), "the same value everywhere"));
}

TEST_F(FeelMatchesImage, AnExistingLinkIsFoundAndErrorsStateTheReason) {
  show(R"({"fields": {"g": {"analytic": "gaussian", "resolution": 16}}, "isosurfaces": [{"field": "g", "level": 0.5}],
           "volumes": [{"field": "g"}], "slices": [{"field": "g", "widget": "cut"}], "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 0, 1]}],
           "chain": [{"name": "skin", "type": "isosurface", "field": "g", "level": 0.5, "free": "below"}]})");
  const auto bound = [&](const char* item) { return make_haptic_binding(host_->scene(), item, std::nullopt, Vec3(9, 9, 9), 4); };
  EXPECT_EQ(find_bound_link(host_->scene(), value_of(bound("isosurfaces[0]"))), "skin");
  EXPECT_TRUE(fails(bound("volumes[0]"), "point at the volume"));
  EXPECT_TRUE(fails(bound("slices[0]"), "widget"));
  EXPECT_FALSE(can_bind_haptics("lights"));
  for (const char* part : {"isosurfaces", "streamlines", "slices", "meshes", "curves", "points", "volumes"})
    EXPECT_TRUE(can_bind_haptics(part)) << part;
}

}  // namespace catena::app::feel_matches_image_test
