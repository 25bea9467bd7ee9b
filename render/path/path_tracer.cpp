// SPDX-License-Identifier: MIT
#include "render/path/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/clock.h"
#include "engine/base/threads.h"
#include "render/frame/linear_color.h"

namespace catena::render {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;
// Scatterings after which paths may end by chance: those that carry little, then all, so that white cavities end too.
constexpr int kRouletteFrom = 4, kRouletteForAll = 8192;
constexpr std::uint32_t kPassSamples = 4;

double luminance(const double rgb[3]) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

/// Returns a direction of unit length from components along and around an axis.
Vec3 around(const Vec3& axis, double cosine, double angle) {
  const Vec3 helper = std::fabs(axis.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 u = direction(cross(helper, axis)), v = cross(axis, u);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return cosine * axis + sine * (std::cos(angle) * u + std::sin(angle) * v);
}

/// Returns Henyey and Greenstein's phase function times 4 pi, by the cosine of the angle by which light is turned.
double phase(double g, double cosine) {
  const double base = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (base * std::sqrt(base));
}

/// Returns a cosine distributed by the phase function.
double sample_phase(double g, double u) {
  if (std::fabs(g) < 1e-4) return 1 - 2 * u;
  const double s = (1 - g * g) / (1 - g + 2 * g * u);
  return std::clamp((1 + g * g - s * s) / (2 * g), -1.0, 1.0);
}

double environment(const IlluminationItem& light, const Vec3& way, int c) {
  const double sky[3] = {double(light.sky.r), double(light.sky.g), double(light.sky.b)};
  const double ground[3] = {double(light.ground.r), double(light.ground.g), double(light.ground.b)};
  return ground[c] + 0.5 * (1 + way.z) * (sky[c] - ground[c]);
}

}  // namespace

PathImage::PathImage(const PathScene& scene, const FramePacket& packet, const PathSettings& settings)
    : scene_(scene), packet_(packet), settings_(settings), camera_(make_display_camera(packet.view, packet.width, packet.height, {})) {
  const IlluminationItem& light = packet.illumination;
  reach_ = light.occlusion_reach;
  if (settings.bounces == 1) {
    has_occlusion_ = light.occlusion_reach > 0;
    strength_ = light.occlusion_strength;
    has_shadows_ = light.shadows;
  }
  if (!std::isfinite(reach_)) reach_ = 0;
  lights_ = packet.lights;
  if (lights_.empty()) lights_.push_back({Vec3(0, 0, 1), {1, 1, 1}, true, 0});  // a headlight
  for (LightItem& one : lights_) {
    const Vec3 d = one.direction;
    one.direction = direction(one.camera_relative ? d.x * camera_.right + d.y * camera_.up + d.z * camera_.back : d);
  }
  std::erase_if(lights_, [](const LightItem& one) { return one.color == Color{} || one.direction == Vec3(0.0); });
  sums_.resize(std::size_t(packet.width) * packet.height);
}

/// Adds what is scattered directly from each light towards the ray's origin, times `weight`. `facing`: normal towards it; zero: none.
void PathImage::add_lights(const PathRay& ray, const Vec3& position, const Vec3& facing, double surface_share, double anisotropy,
                           const double weight[3], Random& random, Sample& out) const {
  for (const LightItem& light : lights_) {
    Vec3 way = light.direction;
    if (light.angular_size_deg > 0) {
      const double least = std::cos(0.5 * light.angular_size_deg * kPi / 180);
      const double u = random.uniform(), v = random.uniform();
      way = around(way, 1 - u * (1 - least), 2 * kPi * v);
    }
    const double lambert = std::max(0.0, dot(facing, way));
    const double scattered = surface_share < 1 ? 0.25 * phase(anisotropy, dot(ray.direction, way)) : 0;
    const double share = surface_share * lambert + (1 - surface_share) * scattered;
    if (!(share > 0)) continue;
    const bool is_shadowed = has_shadows_ && !light.camera_relative;
    const double arriving = is_shadowed ? scene_.transmittance({position, way}, kUnbounded, random) : 1;
    const double color[3] = {double(light.color.r), double(light.color.g), double(light.color.b)};
    for (int c = 0; c < 3; ++c) out.rgb[c] += weight[c] * share * arriving * color[c];
  }
}

PathImage::Sample PathImage::trace(PathRay ray, Random& random) const {
  Sample out;
  double weight[3] = {1, 1, 1};
  double from = 0;
  for (int scattered = 0; scattered <= settings_.bounces;) {
    // the environment's light counts by 1/e behind its reach
    const double escape = scattered > 0 && reach_ > 0 ? from - reach_ * std::log(1 - random.uniform()) : kUnbounded;
    const SurfaceHit hit = scene_.surface(ray, from, escape, scattered == 0);
    const auto collision = scene_.collide(ray, from, std::min(hit.t, escape), random);
    if (!collision && hit && random.uniform() >= double(hit.opacity)) {  // passes a translucent surface
      from = hit.t + hit.epsilon;
      continue;
    }
    if (!collision && !hit) {
      if (scattered > 0)
        for (int c = 0; c < 3; ++c) out.rgb[c] += weight[c] * environment(packet_.illumination, ray.direction, c);
      break;
    }
    if (scattered == settings_.bounces) break;
    out.alpha = 1;
    Vec3 position = ray.at(collision ? collision->t : hit.t), facing(0.0), geometric(0.0);
    Color color;
    double surface_share = 1, anisotropy = 0;
    if (collision) {
      const VolumeItem& item = scene_.volumes()[collision->volume].item();
      color = scene_.volume_color(collision->volume, position);
      anisotropy = item.scattering.anisotropy;
      surface_share = item.is_shaded ? item.scattering.surface : 0;
      if (surface_share > 0) facing = direction(scene_.volumes()[collision->volume].gradient_at(position));
      if (facing == Vec3(0.0)) surface_share = 0;
    } else {
      color = hit.color;
      if (hit.is_unlit) {
        const double rgb[3] = {double(color.r), double(color.g), double(color.b)};
        for (int c = 0; c < 3; ++c) out.rgb[c] += weight[c] * rgb[c];
        break;
      }
      geometric = direction(hit.normal);
      if (dot(geometric, ray.direction) > 0) geometric = -geometric;
      facing = direction(hit.shading_normal);
      if (facing == Vec3(0.0)) facing = geometric;
      position += hit.epsilon * geometric;
    }
    if (dot(facing, ray.direction) > 0) facing = -facing;
    const double albedo[3] = {double(color.r), double(color.g), double(color.b)};
    for (int c = 0; c < 3; ++c) weight[c] *= albedo[c];
    add_lights(ray, position, facing, surface_share, anisotropy, weight, random, out);

    // a new direction, with the density of what is scattered
    Vec3 way;
    const double u = random.uniform(), v = random.uniform();
    if (surface_share > 0 && (surface_share >= 1 || random.uniform() < surface_share)) {
      way = around(facing, std::sqrt(1 - u), 2 * kPi * v);
      // a shading normal can lead below the surface
      if (const double below = dot(way, geometric); below < 0) way -= 2 * below * geometric;
    } else {
      way = around(ray.direction, sample_phase(anisotropy, u), 2 * kPi * v);
    }
    ++scattered;
    if (settings_.bounces == 1) {
      double arriving = 1;
      if (has_occlusion_ && strength_ > 0) {
        const double end = reach_ > 0 ? -reach_ * std::log(1 - random.uniform()) : kUnbounded;
        arriving = 1 - strength_ * (1 - scene_.transmittance({position, way}, end, random));
      }
      for (int c = 0; c < 3; ++c) out.rgb[c] += weight[c] * arriving * environment(packet_.illumination, way, c);
      break;
    }
    if (scattered >= kRouletteFrom) {
      const double survival = std::min(scattered >= kRouletteForAll ? 0.98 : 1.0, std::max({weight[0], weight[1], weight[2]}));
      if (random.uniform() >= survival) break;
      for (double& w : weight) w /= survival;
    }
    ray = {position, way};
    from = 0;
  }
  return out;
}

void PathImage::add_samples(std::uint32_t count) {
  const std::uint32_t width = packet_.width;
  parallel_for(sums_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      Sums& sums = sums_[pixel];
      for (std::uint32_t k = samples_; k < samples_ + count; ++k) {
        Random random(mix_bits(mix_bits(settings_.seed) ^ mix_bits((std::uint64_t(pixel) << 32) | k)));
        const double x = double(pixel % width) + random.uniform(), y = double(pixel / width) + random.uniform();
        const Ray primary = pixel_ray(camera_, x, y);
        const Sample sample = trace({primary.origin, primary.direction}, random);
        for (int c = 0; c < 3; ++c) {
          sums.rgb[c] += sample.rgb[c];
          sums.squares[c] += sample.rgb[c] * sample.rgb[c];
        }
        sums.alpha += sample.alpha;
        sums.luminance2 += luminance(sample.rgb) * luminance(sample.rgb);
      }
    }
  });
  samples_ += count;
}

bool PathImage::render(const PathGoal& goal, const std::function<bool(double done)>& proceed) {
  const std::int64_t start = now_ns();
  while (true) {
    double done = 0;
    std::uint32_t next = kPassSamples;
    if (goal.samples > 0) {
      done = double(samples_) / goal.samples;
      next = std::min(next, goal.samples - std::min(samples_, goal.samples));
    }
    if (goal.seconds > 0) done = std::max(done, 1e-3 * ms_since(start) / goal.seconds);
    if (goal.error > 0 && samples_ >= kPassSamples) {
      const double standard = error().standard;
      done = std::max(done, standard > 0 ? std::pow(goal.error / standard, 2) : 1.0);
    }
    if (done >= 1 && samples_ > 0) return true;
    if (!proceed(done)) return false;
    add_samples(std::max(1u, next));
  }
}

void PathImage::mean(std::size_t pixel, double rgba[4]) const {
  for (int c = 0; c < 3; ++c) rgba[c] = sums_[pixel].rgb[c] / samples_;
  rgba[3] = sums_[pixel].alpha / samples_;
}

std::vector<float> PathImage::display() const {
  std::vector<float> image(4 * sums_.size());
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    double rgba[4];
    mean(i, rgba);
    const double behind = (1 - rgba[3]) * double(packet_.background[3]), alpha = rgba[3] + behind;
    for (std::size_t c = 0; c < 3; ++c)
      image[4 * i + c] = alpha > 0 ? float(to_display((rgba[c] + behind * to_linear(double(packet_.background[c]))) / alpha)) : 0;
    image[4 * i + 3] = float(alpha);
  }
  return image;
}

PathImage::Error PathImage::error() const {
  double standard = 0, relative = 0;
  std::uint64_t covered = 0, lit = 0;
  const double n = samples_;
  if (samples_ < 2) return {kUnbounded, kUnbounded};
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    if (!(sums_[i].alpha > 0)) continue;
    ++covered;
    double rgba[4];
    mean(i, rgba);
    for (int c = 0; c < 3; ++c) {
      const double variance = std::max(0.0, sums_[i].squares[c] / n - rgba[c] * rgba[c]) / (n - 1);
      const double value = std::max(rgba[c], 1e-4), step = 1e-3 * value;
      const double slope = (to_display(value + step) - to_display(value - step)) / (2 * step);
      standard += std::min(1.0, variance * slope * slope);
    }
    if (const double light = luminance(rgba); light > 0) {
      ++lit;
      relative += std::max(0.0, sums_[i].luminance2 / n - light * light) / (n - 1) / (light * light);
    }
  }
  if (covered == 0) return {};
  return {255 * std::sqrt(standard / (3.0 * double(covered))), lit > 0 ? std::sqrt(relative / double(lit)) : 0};
}

}  // namespace catena::render
