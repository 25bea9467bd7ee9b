// SPDX-License-Identifier: MIT
/// Stereo images: the position of a ball in each eye against the closed form, and every packing against the eyes' images, pixel by
/// pixel, by an implementation on the CPU.
#include <array>
#include <cmath>

#include "render/frame/camera.h"
#include "render/stereo/stereo_views.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::stereo_test {

using namespace catena::render;

class StereoImage : public ImageTest {
 protected:
  /// The images of the packet's eyes, each drawn separately.
  std::vector<Image8> each_eye(const FramePacket& packet) {
    std::vector<Image8> images;
    for (const View& eye : packet.eyes) {
      FramePacket one = packet;
      one.view = eye;
      one.eyes.clear();
      one.packing = Packing::single;
      images.push_back(draw(one));
    }
    return images;
  }
};

constexpr double kVoxel = 0.02;
constexpr int kNodes = 33;
constexpr double kRadius = 0.15;

/// SphereSet about `centre`: f = 1 in the middle, 0.5 at the radius, smooth.
GridPtr ball_grid(const Vec3& centre) {
  const Vec3 origin = centre - Vec3(0.5 * kVoxel * (kNodes - 1));
  return make_grid(
      {kNodes, kNodes, kNodes},
      [](const Vec3& i) {
        const double r = kVoxel * norm(i - Vec3(0.5 * (kNodes - 1)));
        return std::exp2(-r * r / (kRadius * kRadius));
      },
      field::Mapping::from_linear(Mat3(kVoxel), origin));
}

struct Centroid {
  double x = 0, y = 0, weight = 0;
};
/// Centroid of the alpha.
Centroid centroid(const Image8& image) {
  Centroid c;
  for (const auto& [x, y] : pixels_of(image)) {
    const double a = image.pixel(x, y)[3];
    c.x += a * (x + 0.5);
    c.y += a * (y + 0.5);
    c.weight += a;
  }
  c.x /= c.weight;
  c.y /= c.weight;
  return c;
}

enum class Kind { volume, surface, tube };
constexpr Kind kKinds[] = {Kind::volume, Kind::surface, Kind::tube};

/// A small object at a position: a cloud, a ball, or a star of tubes perpendicular to the camera's axis.
void add_ball(FramePacket& packet, Kind kind, const Vec3& centre, const Camera& camera) {
  if (kind == Kind::volume) packet.volumes.push_back(volume_item(ball_grid(centre), {{0.3, 0}, {1, 12}}, {1, 0.6f, 0.2f}));
  if (kind == Kind::surface) {
    packet.isosurfaces.push_back({ball_grid(centre), 0.5, {0.3f, 0.7f, 1}});
  }
  for (int i = 0; kind == Kind::tube && i < 7; ++i) {
    const double angle = std::acos(-1.0) * i / 7 + 0.1;
    const Vec3 along = 1.5 * kRadius * (std::cos(angle) * camera.right + std::sin(angle) * camera.up);
    packet.tubes.push_back({{centre - along, centre + along}, 0.1 * kRadius, {0.9f, 0.9f, 0.3f}});
  }
}

FramePacket oblique_packet(bool orthographic) {
  FramePacket packet = make_packet({4.0, -7.0, 3.0}, {0.1, 0.2, -0.1}, 10);
  set_size(packet, 256, 192);
  packet.view.orthographic = orthographic;
  packet.view.height = 1.4;
  return packet;
}

Camera camera_of(const FramePacket& packet) { return make_camera(packet.view, packet.width, packet.height, {}); }

std::vector<View> eyes_of(const FramePacket& packet, const StereoSettings& settings) {
  return make_stereo_views(packet.view, frustum_aspect(packet.view, packet.width, packet.height), settings);
}

TEST_F(StereoImage, ABallHasTheDisparityOfItsDepthAndNoVerticalParallax) {
  for (const bool orthographic : {false, true}) {
    FramePacket packet = oblique_packet(orthographic);
    const Camera c = camera_of(packet);
    constexpr double zero = 8.0, separation = 0.2;
    const std::vector<View> pair = eyes_of(packet, {2, separation, zero});
    for (const Kind kind : kKinds)
      for (const double depth : {6.0, zero, 11.0}) {
        FramePacket one = packet;
        add_ball(one, kind, c.position - depth * c.back, c);
        Centroid in[2];
        for (int k = 0; k < 2; ++k) {
          one.view = pair[std::size_t(k)];
          in[k] = centroid(draw(one, reference_settings()));
        }
        // the outline of a ball of radius r is centred at x z / (z^2 - r^2), that of a star at x / z
        const double r = kind == Kind::tube ? 0 : kRadius;
        const double slope = orthographic ? 1 - depth / zero : depth / (depth * depth - r * r) - 1 / zero;
        const double expected = -separation * slope * 0.5 * packet.height / c.half_height;
        // larger tolerance for hard edges and for the facets of tubes
        const double tolerance = kind == Kind::volume || depth == zero ? 0.02 : kind == Kind::surface ? 0.15 : 0.3;
        EXPECT_NEAR(in[1].x - in[0].x, expected, tolerance) << int(kind) << " at " << depth << (orthographic ? " orthographic" : "");
        EXPECT_NEAR(in[1].y, in[0].y, tolerance) << int(kind) << " at " << depth;
        // crossed disparity in front, uncrossed behind
        const double sign = depth < zero ? -1 : depth > zero ? 1 : 0;
        EXPECT_GE(sign * (in[1].x - in[0].x), std::fabs(sign));
      }
  }
}

TEST_F(StereoImage, VolumeSurfaceAndTubeCoincideInEachEye) {
  for (const bool orthographic : {false, true}) {
    FramePacket packet = oblique_packet(orthographic);
    const Camera c = camera_of(packet);
    const Vec3 centre = c.position - 9.5 * c.back + 0.3 * c.right - 0.2 * c.up;
    for (const View& eye : eyes_of(packet, {3, 0.3, 7.0})) {
      packet.view = eye;
      const auto expected = project(make_camera(eye, packet.width, packet.height, {}), centre);
      ASSERT_TRUE(expected);
      for (const Kind kind : kKinds) {
        FramePacket one = packet;
        add_ball(one, kind, centre, c);
        const Centroid found = centroid(draw(one, reference_settings()));
        EXPECT_NEAR(found.x, expected->x, kind == Kind::volume ? 0.03 : 0.15) << int(kind);
        EXPECT_NEAR(found.y, expected->y, kind == Kind::volume ? 0.03 : 0.15) << int(kind);
        if (kind != Kind::volume) continue;
        for (const RenderSettings& fast : {draft_settings(), balanced_settings()}) {
          const Centroid quick = centroid(draw(one, fast));
          EXPECT_NEAR(quick.x, found.x, 0.1);
          EXPECT_NEAR(quick.y, found.y, 0.1);
        }
      }
    }
  }
}

/// A cloud, a surface and tubes at three depths on a transparent background.
FramePacket busy_packet() {
  FramePacket packet = oblique_packet(false);
  set_size(packet, 96, 72);
  const Camera c = camera_of(packet);
  add_ball(packet, Kind::volume, c.position - 8.0 * c.back - 0.4 * c.right, c);
  add_ball(packet, Kind::surface, c.position - 10.0 * c.back + 0.4 * c.right + 0.3 * c.up, c);
  TubeItem line;
  for (int i = 0; i <= 20; ++i)
    line.points.push_back(c.position - (6.5 + 0.25 * i) * c.back + (0.06 * i - 0.6) * c.right + 0.3 * std::sin(0.5 * i) * c.up);
  line.radius = 0.03;
  line.color = {0.2f, 0.9f, 0.4f};
  packet.tubes.push_back(line);
  return packet;
}

double linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }
double display(double c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055; }

using Rgba = std::array<double, 4>;
Rgba at(const Image8& p, std::size_t x, std::size_t y) {
  const std::uint8_t* c = p.pixel(std::uint32_t(x), std::uint32_t(y));
  return {c[0] / 255.0, c[1] / 255.0, c[2] / 255.0, c[3] / 255.0};
}

/// Colour through both anaglyph filters, weighted with alpha.
Rgba anaglyph(const Rgba& l, const Rgba& r, const double (&left)[3][3], const double (&right)[3][3]) {
  const double alpha = std::max(l[3], r[3]);
  Rgba out{0, 0, 0, alpha};
  for (std::size_t i = 0; i < 3 && alpha > 0; ++i) {
    double light = 0;
    for (std::size_t j = 0; j < 3; ++j) light += left[i][j] * l[3] * linear(l[j]) + right[i][j] * r[3] * linear(r[j]);
    out[i] = display(std::clamp(light / alpha, 0.0, 1.0));
  }
  return out;
}

constexpr double kDuboisLeft[3][3] = {
    {0.4561, 0.500484, 0.176381}, {-0.0400822, -0.0378246, -0.0157589}, {-0.0152161, -0.0205971, -0.00546856}};
constexpr double kDuboisRight[3][3] = {
    {-0.0434706, -0.0879388, -0.00155529}, {0.378476, 0.73364, -0.0184503}, {-0.0721527, -0.112961, 1.2264}};
constexpr double kGreyLeft[3][3] = {{0.2126, 0.7152, 0.0722}, {0, 0, 0}, {0, 0, 0}};
constexpr double kGreyRight[3][3] = {{0, 0, 0}, {0.2126, 0.7152, 0.0722}, {0.2126, 0.7152, 0.0722}};

/// Alpha-weighted mean of a block of pixels.
Rgba mean(const Image8& p, std::size_t x0, std::size_t y0, std::size_t nx, std::size_t ny) {
  Rgba sum{};
  for (std::size_t y = y0; y < y0 + ny; ++y)
    for (std::size_t x = x0; x < x0 + nx; ++x) {
      const Rgba c = at(p, x, y);
      for (std::size_t i = 0; i < 3; ++i) sum[i] += c[3] * c[i];
      sum[3] += c[3];
    }
  if (sum[3] > 0)
    for (std::size_t i = 0; i < 3; ++i) sum[i] /= sum[3];
  sum[3] /= double(nx * ny);
  return sum;
}

/// Expected pixel (x, y) of the packed image.
Rgba expected(Packing packing, const std::vector<Image8>& e, std::size_t x, std::size_t y) {
  const std::size_t n = e.size(), w = e[0].width, h = e[0].height;
  switch (packing) {
    case Packing::single:
      return at(e[0], x, y);
    case Packing::side_by_side:
      return at(e[x / w], x % w, y);
    case Packing::side_by_side_half:
      return mean(e[x / (w / n)], n * (x % (w / n)), y, n, 1);
    case Packing::top_bottom:
      return at(e[y / h], x, y % h);
    case Packing::top_bottom_half:
      return mean(e[y / (h / n)], x, n * (y % (h / n)), 1, n);
    case Packing::grid: {
      constexpr std::size_t kViews[] = {1, 0, 2, 3};
      return at(e[kViews[x / w + 2 * (y / h)]], x % w, y % h);
    }
    case Packing::anaglyph:
      return anaglyph(at(e[0], x, y), at(e[1], x, y), kDuboisLeft, kDuboisRight);
    case Packing::anaglyph_gray:
      return anaglyph(at(e[0], x, y), at(e[1], x, y), kGreyLeft, kGreyRight);
    case Packing::rows:
      return at(e[y % n], x, y);
    case Packing::columns:
      return at(e[x % n], x, y);
    case Packing::checkerboard:
      return at(e[(x + y) % n], x, y);
  }
  return {};
}

struct Named {
  Packing packing;
  const char* name;
  double width_factor, height_factor;
};
constexpr Named kPackings[] = {{Packing::single, "single", 1, 1},
                               {Packing::side_by_side, "side-by-side", 2, 1},
                               {Packing::side_by_side_half, "side-by-side-half", 1, 1},
                               {Packing::top_bottom, "top-bottom", 1, 2},
                               {Packing::top_bottom_half, "top-bottom-half", 1, 1},
                               {Packing::anaglyph, "anaglyph", 1, 1},
                               {Packing::anaglyph_gray, "anaglyph-grey", 1, 1},
                               {Packing::rows, "rows", 1, 1},
                               {Packing::columns, "columns", 1, 1},
                               {Packing::checkerboard, "checkerboard", 1, 1}};

void expect_packed(Packing packing, const Image8& image, const std::vector<Image8>& each, const char* name) {
  double worst = 0;
  for (const auto& [x, y] : pixels_of(image)) {
    const Rgba want = expected(packing, each, x, y), have = at(image, x, y);
    worst = std::max(worst, std::fabs(want[3] - have[3]));
    // at low alpha the colour is lost to rounding
    for (std::size_t i = 0; i < 3; ++i) worst = std::max(worst, std::fabs(want[i] - have[i]) * (want[3] > 0 ? 1 : 0));
  }
  const bool computed = packing == Packing::anaglyph || packing == Packing::anaglyph_gray || packing == Packing::side_by_side_half ||
                        packing == Packing::top_bottom_half;
  // the rounding of halves of 1/255 depends on the driver
  EXPECT_LE(255 * worst, !computed ? 0 : uses_lavapipe() ? 0.51 : 0.6) << name;
}

TEST_F(StereoImage, EveryPackingMatchesTheEyesImages) {
  for (const bool transparent : {true, false}) {
    FramePacket packet = busy_packet();
    if (!transparent) packet.background = {0.1f, 0.15f, 0.3f, 1};
    packet.eyes = eyes_of(packet, {2, 0.3, 8.0});
    const std::vector<Image8> each = each_eye(packet);
    ASSERT_GT(max_difference(each[0], each[1]), 100) << "the eyes see the same";
    for (const Named& named : kPackings) {
      packet.packing = named.packing;
      const Image8 image = draw(packet, {}, std::string(named.name) + (transparent ? "-transparent" : ""));
      ASSERT_EQ(image.width, packet.width * named.width_factor) << named.name;
      ASSERT_EQ(image.height, packet.height * named.height_factor) << named.name;
      expect_packed(named.packing, image, each, named.name);
    }
  }
}

TEST_F(StereoImage, ThreeViewsAndOddSizes) {
  FramePacket packet = busy_packet();
  set_size(packet, 95, 71);
  packet.eyes = eyes_of(packet, {3, 0.2, 8.0});
  const std::vector<Image8> each = each_eye(packet);
  for (const Packing packing : {Packing::side_by_side, Packing::side_by_side_half, Packing::top_bottom, Packing::top_bottom_half,
                                Packing::rows, Packing::columns, Packing::checkerboard}) {
    packet.packing = packing;
    const Image8 image = draw(packet, {}, "three-" + std::to_string(int(packing)));
    const PackedSize size = packed_size(packing, 3, 95, 71);
    ASSERT_EQ(image.width, size.width);
    ASSERT_EQ(image.height, size.height);
    expect_packed(packing, image, each, "three");
  }
  packet.packing = Packing::anaglyph;
  expect_refused(packet, "3 views");
}

TEST_F(StereoImage, TheMonoViewReturnsAfterAPair) {
  FramePacket packet = busy_packet();
  const Image8 before = draw(packet);
  packet.eyes = eyes_of(packet, {2, 0.3, 8.0});
  packet.packing = Packing::side_by_side;
  draw(packet);
  packet.eyes.clear();
  EXPECT_EQ(max_difference(before, draw(packet)), 0);
}

TEST_F(StereoImage, DepthIsThatOfTheFirstEye) {
  FramePacket packet = busy_packet();
  packet.eyes = eyes_of(packet, {2, 0.3, 8.0});
  FramePacket left = packet;
  left.view = packet.eyes[0];
  left.eyes.clear();
  draw(left);
  const std::vector<float> alone = depths();
  packet.packing = Packing::anaglyph;
  draw(packet);
  const auto pair = renderer_->read_depth();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->width, packet.width);
  EXPECT_EQ(alone, pair->depth);
}

TEST_F(StereoImage, GridsAndTablesAreUploadedOnce) {
  FramePacket packet = busy_packet();
  draw(packet);
  const RenderStats mono = renderer_->stats();
  packet.eyes = eyes_of(packet, {4, 0.3, 8.0});
  packet.packing = Packing::side_by_side;
  draw(packet);
  EXPECT_EQ(renderer_->stats().upload_bytes, mono.upload_bytes) << "another eye uploads nothing";
  EXPECT_EQ(renderer_->stats().resident_grids, mono.resident_grids);
}

TEST_F(StereoImage, APointOnADisplayScreenIsAtItsPosition) {
  // non-square pixels, the eye off the screen's centre
  constexpr double half_width = 0.9, half_height = 0.6;
  const auto view = make_screen_view({{-half_width, 0.0, -half_height}, {half_width, 0.0, -half_height}, {-half_width, 0.0, half_height}},
                                     {1.2, -6.0, 0.3});
  ASSERT_TRUE(view);
  FramePacket packet;
  set_size(packet, 120, 150);
  packet.background = {0, 0, 0, 0};
  packet.view = *view;
  const Vec3 centre(0.2, 0.0, -0.2);
  for (const Kind kind : kKinds) {
    FramePacket one = packet;
    add_ball(one, kind, centre, make_camera(*view, 1, 1, {}));
    const Centroid found = centroid(draw(one, reference_settings(), std::to_string(int(kind))));
    const double tolerance = kind == Kind::volume ? 0.06 : 0.2;
    EXPECT_NEAR(found.x, 60 * (1 + centre.x / half_width), tolerance) << int(kind);
    EXPECT_NEAR(found.y, 75 * (1 - centre.z / half_height), tolerance) << int(kind);
  }
}

}  // namespace catena::test::stereo_test
