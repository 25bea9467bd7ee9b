// SPDX-License-Identifier: MIT
/// Line integral convolution against the direct convolution of every texel, and its invariants.
#include "engine/geometry/flow/lic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/engine/geometry/flow/lambda_field.h"

namespace catena::flow::lic_test {

using test::lambda_field;

double white_noise(std::int64_t i, std::int64_t j) {
  std::uint64_t h = static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15u ^ static_cast<std::uint64_t>(j) * 0xc2b2ae3d27d4eb4fu;
  h = (h ^ (h >> 29)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 32)) * 0x94d049bb133111ebu;
  return static_cast<double>(h >> 40) / double(1 << 23) - 1;
}

/// Bilinear interpolation of white noise.
double noise_at(const glm::dvec2& index) {
  const glm::dvec2 p = index / double(kLicNoiseCell), low = glm::floor(p), f = p - low;
  const auto i = std::int64_t(low.x), j = std::int64_t(low.y);
  return glm::mix(glm::mix(white_noise(i, j), white_noise(i + 1, j), f.x), glm::mix(white_noise(i, j + 1), white_noise(i + 1, j + 1), f.x),
                  f.y);
}

/// Values a + b cos + c sin of the kernel with the phase at each texel, from 41 samples of its own streamline, scaled to the contrast of
/// the texture; not a number where there is no flow.
std::vector<double> direct(const field::VectorField& field, const LicPlane& plane, bool animated, double phase) {
  field::Cursor cursor;
  const auto velocity = [&](const glm::dvec2& p, glm::dvec2& d) {
    if (!(p.x >= 0 && p.y >= 0 && p.x <= plane.width - 1 && p.y <= plane.height - 1)) return false;
    const auto vector_at = [&](const glm::dvec2& at, glm::dvec2& v) {
      const auto sample = field.sample(plane.origin + plane.texel_size * (at.x * plane.u + at.y * plane.v), cursor);
      v = {dot(sample.value, plane.u), dot(sample.value, plane.v)};
      return sample.inside && glm::length(v) > 0;
    };
    // the nearest texel says whether there is a flow
    glm::dvec2 nearest;
    if (!vector_at(glm::floor(p + 0.5), nearest)) return false;
    vector_at(p, d);
    if (glm::length(d) == 0) return false;
    d = glm::normalize(d);
    return true;
  };
  const auto sampled_noise = [&](const glm::dvec2& p) { return noise_at(p + glm::dvec2(double(plane.first_u), double(plane.first_v))); };
  std::vector<double> values, plain;
  for (int j = 0; j < plane.height; ++j)
    for (int i = 0; i < plane.width; ++i) {
      double sum = 0, plain_sum = 0, weights = 0;
      const auto add = [&](int k, const glm::dvec2& p) {
        const double h = std::pow(std::cos(std::numbers::pi * k / 42), 2);
        plain_sum += h * sampled_noise(p);
        sum += (animated ? 1 + std::cos(2 * std::numbers::pi * (k / 21.0 + phase)) : 1) * h * sampled_noise(p);
        weights += h;
      };
      glm::dvec2 d;
      const glm::dvec2 seed(i, j);
      if (!velocity(seed, d)) {
        values.push_back(NAN);
        continue;
      }
      add(0, seed);
      for (const int sign : {1, -1}) {
        glm::dvec2 p = seed;
        for (int k = 1; k <= 20; ++k) {
          bool goes_on = true;
          for (int step = 0; step < 2 && goes_on; ++step) {  // half texels: a finer integration than the texture's
            glm::dvec2 middle(0.0);
            goes_on = velocity(p, d) && velocity(p + 0.25 * sign * d, middle);
            p += 0.5 * sign * middle;
          }
          glm::dvec2 there;
          if (!goes_on || !velocity(p, there) || glm::dot(there, d) < 0) break;
          add(sign * k, p);
        }
      }
      values.push_back(sum / weights);
      plain.push_back(plain_sum / weights);
    }
  double mean = 0, squares = 0;
  for (const double v : plain) mean += v / double(plain.size());
  for (const double v : plain) squares += (v - mean) * (v - mean) / double(plain.size());
  for (double& v : values) v = std::clamp((v - mean) * 0.5 / (2.5 * std::sqrt(squares)), -0.5, 0.5);
  return values;
}

struct Case {
  const char* name;
  double limit;  // on the error, of 255
  field::VectorFieldPtr field;
  LicPlane plane;
};

std::vector<Case> cases() {
  LicPlane flat{Vec3(-1.0), {1, 0, 0}, {0, 1, 0}, 0.0135, 130, 102};
  LicPlane oblique{{-0.7, -0.5, -0.4}, direction(Vec3(1, 0.3, 0.5)), {}, 0.0105, 124, 96};
  oblique.v = direction(cross(Vec3(0.1, 0.4, 0.9), oblique.u));
  oblique.first_u = -37;
  return {{"vortices", 2, lambda_field([](const Vec3& p) { return Vec3(std::sin(4 * p.y), std::sin(3 * p.x + 1), p.z); }), flat},
          {"circle with a hole", 4,
           lambda_field([](const Vec3& p) { return Vec3(-p.y, p.x, 0); }, [](const Vec3& p) { return std::hypot(p.x, p.y) > 0.3; }), flat},
          {"oblique plane", 2, lambda_field([](const Vec3& p) { return Vec3(std::cos(2 * p.z), 0.4 + p.x * p.y, std::sin(2 * p.x)); }),
           oblique}};
}

TEST(Lic, IsTheDirectConvolution) {
  for (const Case& c : cases())
    for (const bool animated : {false, true})
      for (const double phase : {0.0, 0.3}) {
        if (animated == (phase == 0)) continue;
        const auto texture = compute_lic(*c.field, c.plane, animated);
        const std::vector<double> expected = direct(*c.field, c.plane, animated, phase);
        double squares = 0, contrast = 0;
        int count = 0;
        for (std::size_t k = 0; k < expected.size(); ++k) {
          const LicTexture::Texel& texel = texture->texels[k];
          ASSERT_EQ(texel.presence != 0, std::isfinite(expected[k])) << c.name;
          if (texel.presence == 0) continue;
          const double value =
              (texel.a + std::cos(2 * std::numbers::pi * phase) * texel.b + std::sin(2 * std::numbers::pi * phase) * texel.c) / 32767;
          squares += std::pow(std::clamp(value, -0.5, 0.5) - expected[k], 2);
          contrast += expected[k] * expected[k];
          ++count;
        }
        EXPECT_LT(255 * std::sqrt(squares / count), animated ? 4 : c.limit) << c.name << (animated ? ", animated, phase " : " ") << phase;
        EXPECT_GT(std::sqrt(contrast / count), 0.15) << c.name;
        RecordProperty(c.name, std::to_string(255 * std::sqrt(squares / count)));
      }
}

TEST(Lic, IsTheSameInAPartOfThePlane) {
  const Case c = cases().front();
  const auto whole = compute_lic(*c.field, c.plane, false);
  LicPlane part = c.plane;
  part.origin += 12 * part.texel_size * part.u + 7 * part.texel_size * part.v;
  part.first_u += 12;
  part.first_v += 7;
  part.width -= 24;
  part.height -= 14;
  const auto cut = compute_lic(*c.field, part, false);
  double squares = 0;
  int count = 0;
  for (int j = 21; j < part.height - 21; ++j)
    for (int i = 21; i < part.width - 21; ++i, ++count)
      squares += std::pow(
          (cut->texels[std::size_t(j * part.width + i)].a - whole->texels[std::size_t((j + 7) * c.plane.width + i + 12)].a) / 32767.0, 2);
  EXPECT_LT(std::sqrt(squares / count), 0.03);  // the same streaks; the contrast is that of another part
}

}  // namespace catena::flow::lic_test
