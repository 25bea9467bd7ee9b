// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/lic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/base/threads.h"
#include "engine/field/grid/grid.h"

namespace catena::flow {
namespace {

using glm::vec2;

constexpr int kHalf = kLicHalfLength, kTaps = 2 * kHalf + 1;
constexpr int kReuse = 96;           // texels on either side of a seed that get values from its streamline
constexpr int kFirstSpacing = 9;     // texels between the first seeds
constexpr int kBlockSize = 128;      // texels
constexpr float kNear = 0.1f;        // distance of a streamline from a texel's center that needs no other, texels
constexpr float kBetween = 1.1f;     // distance of two streamlines between which a texel needs no other, texels
constexpr double kDeviations = 2.5;  // standard deviations that reach 0 and 1
constexpr std::size_t kSide = kReuse + kHalf, kPoints = 2 * kSide + 1;

/// Nearest whole number of x >= 0.
int nearest_texel(float x) { return (static_cast<int>(2 * x) + 1) / 2; }

/// Values of all texels. Vectors are unit vectors in the plane, or (0, 0) where there is no flow.
struct Lattice {
  int width, height;
  std::vector<vec2> directions;
  std::vector<vec2> forward, backward;  // displacements by a step of one texel along the streamline
  std::vector<float> noise;             // -1 to 1

  std::size_t at(int i, int j) const { return static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i); }
  bool contains(const vec2& p) const {
    return p.x >= 0 && p.y >= 0 && p.x <= static_cast<float>(width - 1) && p.y <= static_cast<float>(height - 1);
  }
  bool has_flow(const vec2& p) const {
    const vec2& d = directions.data()[at(nearest_texel(p.x), nearest_texel(p.y))];
    return d.x != 0 || d.y != 0;
  }
};

/// Bilinear interpolation of one value per texel at a position within the lattice.
template <class T>
T interpolate(const Lattice& lattice, const std::vector<T>& values, const vec2& p) {
  const int i = std::min(static_cast<int>(p.x), lattice.width - 2), j = std::min(static_cast<int>(p.y), lattice.height - 2);
  const float fx = p.x - static_cast<float>(i), fy = p.y - static_cast<float>(j);
  const T* row = values.data() + lattice.at(i, j);
  const T* next = row + lattice.width;
  const T low = row[0] + fx * (row[1] - row[0]), high = next[0] + fx * (next[1] - next[0]);
  return low + fy * (high - low);
}

/// White noise: a value of -1 to 1 per index.
float white_noise(std::int64_t i, std::int64_t j) {
  std::uint64_t h = static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15u ^ static_cast<std::uint64_t>(j) * 0xc2b2ae3d27d4eb4fu;
  h = (h ^ (h >> 29)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 32)) * 0x94d049bb133111ebu;
  return static_cast<float>(static_cast<double>(h >> 40) / double(1 << 23) - 1);
}

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

/// Noise of a row of texels: white noise on every kLicNoiseCell-th texel, interpolated bilinearly.
void fill_noise(const LicPlane& plane, int j, float* row) {
  constexpr auto kCell = static_cast<std::int64_t>(kLicNoiseCell);
  const std::int64_t v = plane.first_v + j, low_v = floor_divide(v, kCell);
  const float fv = static_cast<float>(v - low_v * kCell) / static_cast<float>(kCell);
  const auto column = [&](std::int64_t i) { return white_noise(i, low_v) + fv * (white_noise(i, low_v + 1) - white_noise(i, low_v)); };
  std::int64_t cell = floor_divide(plane.first_u, kCell) - 1;
  float low = 0, high = column(cell + 1);
  for (int i = 0; i < plane.width; ++i) {
    const std::int64_t u = plane.first_u + i, of = floor_divide(u, kCell);
    if (of != cell) {
      low = of == cell + 1 ? high : column(of);
      high = column(of + 1);
      cell = of;
    }
    row[i] = low + static_cast<float>(u - of * kCell) / static_cast<float>(kCell) * (high - low);
  }
}

/// Displacement by one step from a texel with direction d, forward or backward, by the midpoint rule; (0, 0): it turns back.
vec2 displacement(const Lattice& lattice, const vec2& p, const vec2& d, float sign) {
  const vec2 middle = p + (0.5f * sign) * d;
  if (!lattice.contains(middle) || !lattice.has_flow(middle)) return sign * d;
  const vec2 v = interpolate(lattice, lattice.directions, middle);
  const float squared = v.x * v.x + v.y * v.y;
  if (!(squared > 1e-6f) || v.x * d.x + v.y * d.y < 0) return vec2(0.0f);
  return sign / std::sqrt(squared) * v;
}

/// Order of magnitude of the field's vectors, so that they fit into floats.
double largest_vector(const field::VectorField& field) {
  const double largest = field.grid() != nullptr ? field.grid()->max_magnitude() : 1;
  return largest > 0 && std::isfinite(largest) ? largest : 1;
}

Lattice sample_plane(const field::VectorField& field, const LicPlane& plane) {
  Lattice lattice{plane.width, plane.height, {}, {}, {}, {}};
  const std::size_t count = lattice.at(0, plane.height);
  lattice.directions.resize(count);
  lattice.forward.resize(count);
  lattice.backward.resize(count);
  lattice.noise.resize(count);
  const auto rows = static_cast<std::size_t>(plane.height);
  // every second texel is sampled; the others are interpolated between texels that have a flow, else sampled as well
  std::vector<vec2> vectors(count);
  const double scale = largest_vector(field);
  const auto sample_at = [&](int i, int j, field::Cursor& cursor) {
    const Vec3 world = plane.origin + (plane.texel_size * i) * plane.u + (plane.texel_size * j) * plane.v;
    const field::VectorSample sample = field.sample(world, cursor);
    const vec2 v(static_cast<float>(dot(sample.value, plane.u) / scale), static_cast<float>(dot(sample.value, plane.v) / scale));
    return sample.inside && std::isfinite(v.x) && std::isfinite(v.y) ? v : vec2(0.0f);
  };
  parallel_for((rows + 1) / 2, 4, [&](std::size_t begin, std::size_t end) {
    field::Cursor cursor;
    for (int j = 2 * static_cast<int>(begin); j < std::min(2 * static_cast<int>(end), plane.height); j += 2)
      for (int i = 0; i < plane.width; i += 2) vectors[lattice.at(i, j)] = sample_at(i, j, cursor);
  });
  parallel_for(rows, 8, [&](std::size_t begin, std::size_t end) {
    field::Cursor cursor;
    for (int j = static_cast<int>(begin); j < static_cast<int>(end); ++j) {
      fill_noise(plane, j, lattice.noise.data() + lattice.at(0, j));
      for (int i = 0; i < plane.width; ++i) {
        const bool is_between = ((i | j) & 1) != 0;
        vec2 v(0.0f);
        if (!is_between) {
          v = vectors[lattice.at(i, j)];
        } else if (i + (i & 1) >= plane.width || j + (j & 1) >= plane.height) {
          v = sample_at(i, j, cursor);
        } else {
          const vec2* const low = vectors.data() + lattice.at(i - (i & 1), j - (j & 1));
          const vec2* const high = vectors.data() + lattice.at(i - (i & 1), j + (j & 1));
          const int right = 2 * (i & 1);
          const auto flows = [](const vec2& vector) { return vector.x != 0 || vector.y != 0; };
          v = flows(low[0]) && flows(low[right]) && flows(high[0]) && flows(high[right])
                  ? 0.25f * ((low[0] + low[right]) + (high[0] + high[right]))
                  : sample_at(i, j, cursor);
        }
        const float size = std::max(std::fabs(v.x), std::fabs(v.y));
        if (size > 0) {
          const vec2 w = v / size;
          lattice.directions[lattice.at(i, j)] = w / std::sqrt(w.x * w.x + w.y * w.y);
        }
      }
    }
  });
  parallel_for(rows, 8, [&](std::size_t begin, std::size_t end) {
    for (int j = static_cast<int>(begin); j < static_cast<int>(end); ++j)
      for (int i = 0; i < plane.width; ++i) {
        const std::size_t at = lattice.at(i, j);
        const vec2 p(static_cast<float>(i), static_cast<float>(j)), d = lattice.directions[at];
        if (d.x == 0 && d.y == 0) continue;
        lattice.forward[at] = displacement(lattice, p, d, 1);
        lattice.backward[at] = displacement(lattice, p, d, -1);
      }
  });
  return lattice;
}

/// A streamline in steps of one texel: positions, and the part that was reached. The seed is point kSide. It ends kHalf points outside of a
/// block, because only texels of the block get values.
struct Line {
  std::array<vec2, kPoints> points;
  std::size_t first = kSide, last = kSide;

  void trace(const Lattice& lattice, const vec2& seed, const vec2& low, const vec2& high) {
    vec2* const all = points.data();
    all[kSide] = seed;
    // both directions in turn: the processor overlaps their steps
    Walk forward{lattice.forward.data(), all + kSide, 1, seed}, backward{lattice.backward.data(), all + kSide, -1, seed};
    while (forward.goes_on || backward.goes_on) {
      if (forward.goes_on) forward.step(lattice, low, high);
      if (backward.goes_on) backward.step(lattice, low, high);
    }
    last = kSide + forward.count;
    first = kSide - backward.count;
  }

 private:
  static constexpr float kShort = 0.01f, kMixed = 0.8f;  // squared lengths of interpolated displacements

  /// One direction from the seed.
  struct Walk {
    const vec2* displacements;
    vec2* seed;
    std::ptrdiff_t stride;
    vec2 p;
    std::size_t count = 0, outside = 0;  // points that follow the seed; the last of them that are outside of the block
    bool goes_on = true;

    void step(const Lattice& lattice, const vec2& low, const vec2& high) {
      const int width = lattice.width, i = std::min(static_cast<int>(p.x), width - 2),
                j = std::min(static_cast<int>(p.y), lattice.height - 2);
      const float fx = p.x - static_cast<float>(i), fy = p.y - static_cast<float>(j);
      const vec2* const row = displacements + static_cast<std::ptrdiff_t>(j) * width + i;
      const vec2 below = row[0] + fx * (row[1] - row[0]), above = row[width] + fx * (row[width + 1] - row[width]);
      vec2 d = below + fy * (above - below);
      const vec2& nearest = row[(fy < 0.5f ? 0 : width) + (fx < 0.5f ? 0 : 1)];
      const float squared = d.x * d.x + d.y * d.y;
      if ((nearest.x == 0 && nearest.y == 0) || squared < kShort) {
        count -= count > 0 ? 1 : 0;  // there is no flow here
        goes_on = false;
        return;
      }
      if (squared < kMixed) d /= std::sqrt(squared);  // next to texels without a flow
      p += d;
      goes_on = count < kSide && outside <= static_cast<std::size_t>(kHalf) && lattice.contains(p);
      if (!goes_on) return;
      outside = p.x < low.x || p.y < low.y || p.x > high.x || p.y > high.y ? outside + 1 : 0;
      seed[static_cast<std::ptrdiff_t>(++count) * stride] = p;
    }
  };
};

/// Taps of the kernel, and those of its cosine and sine.
struct Kernel {
  std::array<float, kTaps> plain, cosine, sine;
  float sum = 0;
  Kernel() {
    for (int i = -kHalf; i <= kHalf; ++i) {
      const double window = std::cos(std::numbers::pi * i / (2 * (kHalf + 1))), angle = 2 * std::numbers::pi * i / (kHalf + 1);
      const auto k = static_cast<std::size_t>(i + kHalf);
      plain[k] = static_cast<float>(window * window);
      sum += plain[k];
      cosine[k] = static_cast<float>(window * window * std::cos(angle));
      sine[k] = static_cast<float>(-window * window * std::sin(angle));
    }
  }
};

/// out[m] = sum of taps[i] values[m + i], for the points around the seed that get values.
void convolve(const std::array<float, kTaps>& taps, const std::array<float, kPoints>& values, std::array<float, 2 * kReuse + 1>& out) {
  out.fill(0);
  for (std::size_t i = 0; i < kTaps; ++i) {
    const float tap = taps.data()[i];
    const float* const from = values.data() + i;
    float* const to = out.data();
    for (std::size_t m = 0; m < 2 * kReuse + 1; ++m) to[m] += tap * from[m];
  }
}

/// Values of the nearest streamlines on both sides of a texel's center.
struct Sides {
  struct Side {
    float distance = 4, a = 0, b = 0, c = 0;
  };
  std::array<Side, 2> sides{};

  bool is_known() const {
    const float left = sides[0].distance, right = sides[1].distance;
    return std::min(left, right) < kNear || left + right < kBetween;
  }
  /// Value between the two streamlines, or of the only one.
  Side between() const {
    const Side &left = sides[0], &right = sides[1];
    const float sum = left.distance + right.distance, f = right.distance >= 4  ? 0
                                                          : left.distance >= 4 ? 1
                                                          : sum > 0            ? left.distance / sum
                                                                               : 0;
    const auto mix = [&](float l, float r) { return l + f * (r - l); };
    return {sum, mix(left.a, right.a), mix(left.b, right.b), mix(left.c, right.c)};
  }
};

/// Texels of one block.
class Block {
 public:
  Block(const Lattice& lattice, const Kernel& kernel, bool animated, int x, int y)
      : lattice_(lattice),
        kernel_(kernel),
        animated_(animated),
        x_(x),
        y_(y),
        width_(std::min(kBlockSize, lattice.width - x)),
        height_(std::min(kBlockSize, lattice.height - y)),
        texels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

  /// Computes the block's texels; `out`: values of the whole plane.
  void run(std::vector<Sides::Side>& out) {
    // streamlines that are far apart first: fewer are needed
    for (const int spacing : {kFirstSpacing, 1})
      for (int j = spacing / 2; j < height_; j += spacing)
        for (int i = spacing / 2; i < width_; i += spacing) {
          const vec2& v = lattice_.directions[lattice_.at(x_ + i, y_ + j)];
          if ((v.x == 0 && v.y == 0) || texels_[index(i, j)].is_known()) continue;
          add_line(vec2(static_cast<float>(x_ + i), static_cast<float>(y_ + j)));
        }
    for (int j = 0; j < height_; ++j)
      for (int i = 0; i < width_; ++i) out[lattice_.at(x_ + i, y_ + j)] = texels_[index(i, j)].between();
  }

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i);
  }

  void add_line(const vec2& seed) {
    line_.trace(lattice_, seed, vec2(static_cast<float>(x_ - 1), static_cast<float>(y_ - 1)),
                vec2(static_cast<float>(x_ + width_), static_cast<float>(y_ + height_)));
    values_.fill(0);
    inside_.fill(0);
    for (std::size_t k = line_.first; k <= line_.last; ++k) {
      values_[k] = interpolate(lattice_, lattice_.noise, line_.points[k]);
      inside_[k] = 1;
    }
    convolve(kernel_.plain, values_, a_);
    if (line_.first == 0 && line_.last == kPoints - 1)
      weights_.fill(kernel_.sum);
    else
      convolve(kernel_.plain, inside_, weights_);
    if (animated_) {
      convolve(kernel_.cosine, values_, b_);
      convolve(kernel_.sine, values_, c_);
    }
    const std::size_t begin = std::max<std::size_t>(line_.first, kHalf), end = std::min<std::size_t>(line_.last, kHalf + 2 * kReuse);
    for (std::size_t m = begin - kHalf; m <= end - kHalf; ++m) {
      const float scale = 1 / weights_.data()[m];
      for (auto* values : {&a_, &b_, &c_}) values->data()[m] *= scale;
    }
    for (std::size_t k = begin; k <= end; ++k) add_point(k, begin, end);
  }

  /// Gives the value at a point to the texels around it, interpolated along the line to the foot of their centers.
  void add_point(std::size_t k, std::size_t begin, std::size_t end) {
    const vec2* const points = line_.points.data();
    const vec2 p = points[k];
    const float px = p.x - static_cast<float>(x_), py = p.y - static_cast<float>(y_);
    if (px < -1 || py < -1 || px > static_cast<float>(width_) || py > static_cast<float>(height_)) return;
    const std::size_t before = k > begin ? k - 1 : k, after = k < end ? k + 1 : k;
    if (before == after) return add_single(px, py, k);
    const vec2 t = (after - before == 2 ? 0.5f : 1.0f) * (points[after] - points[before]);  // nearly a unit vector
    const std::size_t m = k - kHalf;
    const bool is_steep = std::fabs(t.y) > std::fabs(t.x);  // then the texels to the left and right, else above and below
    const int i = is_steep ? static_cast<int>(px + 1) - 1 : static_cast<int>(px + 1.5f) - 1;
    const int j = is_steep ? static_cast<int>(py + 1.5f) - 1 : static_cast<int>(py + 1) - 1;
    for (int n = 0; n < 2; ++n) {
      const int column = i + (is_steep ? n : 0), row = j + (is_steep ? 0 : n);
      if (column < 0 || row < 0 || column >= width_ || row >= height_) continue;
      const float ox = static_cast<float>(column) - px, oy = static_cast<float>(row) - py, along = ox * t.x + oy * t.y;
      const float across = t.x * oy - t.y * ox, distance = std::fabs(across);
      Sides::Side& side = texels_.data()[row * width_ + column].sides.data()[across < 0 ? 0 : 1];
      if (distance >= side.distance) continue;
      const std::size_t next = (along < 0 ? before : after) - kHalf;
      const float f = std::min(std::fabs(along), 1.0f);
      side.distance = distance;
      side.a = a_.data()[m] + f * (a_.data()[next] - a_.data()[m]);
      if (!animated_) continue;
      side.b = b_.data()[m] + f * (b_.data()[next] - b_.data()[m]);
      side.c = c_.data()[m] + f * (c_.data()[next] - c_.data()[m]);
    }
  }

  /// Gives the value of a line of one point to the seed's texel.
  void add_single(float px, float py, std::size_t k) {
    const std::size_t m = k - kHalf;
    Sides::Side& side = texels_[index(nearest_texel(px), nearest_texel(py))].sides[0];
    if (side.distance > 0) side = {0, a_[m], b_[m], c_[m]};
  }

  const Lattice& lattice_;
  const Kernel& kernel_;
  bool animated_;
  int x_, y_, width_, height_;
  std::vector<Sides> texels_;
  Line line_;
  std::array<float, kPoints> values_{}, inside_{};
  std::array<float, 2 * kReuse + 1> a_{}, b_{}, c_{}, weights_{};
};

std::int16_t pack(double value) { return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0, 1.0) * 32767)); }

}  // namespace

std::shared_ptr<const LicTexture> compute_lic(const field::VectorField& field, const LicPlane& plane, bool animated) {
  CATENA_ASSERT(plane.width >= 2 && plane.height >= 2);
  const Lattice lattice = sample_plane(field, plane);
  static const Kernel kernel;
  std::vector<Sides::Side> values(lattice.directions.size());
  const int across = (plane.width + kBlockSize - 1) / kBlockSize, down = (plane.height + kBlockSize - 1) / kBlockSize;
  parallel_for(static_cast<std::size_t>(across * down), 1, [&](std::size_t begin, std::size_t end) {
    for (int b = static_cast<int>(begin); b < static_cast<int>(end); ++b)
      Block(lattice, kernel, animated, b % across * kBlockSize, b / across * kBlockSize).run(values);
  });
  auto texture = std::make_shared<LicTexture>();
  texture->plane = plane;
  texture->texels.resize(values.size());
  double sum = 0, squares = 0, count = 0;
  const auto has_flow = [&](std::size_t k) { return lattice.directions[k].x != 0 || lattice.directions[k].y != 0; };
  for (std::size_t k = 0; k < values.size(); ++k)
    if (has_flow(k)) {
      const auto a = static_cast<double>(values[k].a);
      sum += a;
      squares += a * a;
      ++count;
    }
  const double mean = count > 0 ? sum / count : 0, deviation = count > 0 ? std::sqrt(std::max(0.0, squares / count - mean * mean)) : 0;
  const double scale = deviation > 0 ? 0.5 / (kDeviations * deviation) : 0;
  parallel_for(values.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (has_flow(k))
        texture->texels[k] = {pack(scale * (static_cast<double>(values[k].a) - mean)), pack(scale * static_cast<double>(values[k].b)),
                              pack(scale * static_cast<double>(values[k].c)), 32767};
  });
  return texture;
}

}  // namespace catena::flow
