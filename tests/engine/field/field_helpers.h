// SPDX-License-Identifier: MIT
/// Helpers of the field tests: repeatable random numbers, mappings of every kind, an independent trilinear formula, and reading of files.
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "engine/io/volume/load_field.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::field::test {

using namespace catena::test;

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 2654435769u + 1) {}
  double uniform(double lo, double hi) {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return lo + (hi - lo) * (static_cast<double>(state_ >> 11) * 0x1p-53);
  }
  Vec3 in_box(const Vec3& lo, const Vec3& hi) { return {uniform(lo.x, hi.x), uniform(lo.y, hi.y), uniform(lo.z, hi.z)}; }

 private:
  std::uint64_t state_;
};

/// Mappings: identity, anisotropic, rotated and sheared with a negative origin, and mirrored.
inline std::vector<Mapping> mappings() {
  return {Mapping{}, Mapping::from_linear(Mat3(0.957, 0, 0, 0, 0.957, 0, 0, 0, 1.5), Vec3(-90, -125, -71)),
          Mapping::from_linear(Mat3(0.8, 0.6, 0.0, -0.3, 0.4, 0.2, 0.1, 0.05, 0.9), Vec3(-3, 7, -11)),
          Mapping::from_linear(Mat3(-2, 0, 0, 0, 0, 1, 0, 1, 0), Vec3(5, -5, 0.5))};
}

/// A vector of length h along an axis.
inline Vec3 along(int axis, double h) {
  Vec3 step(0.0);
  step[axis] = h;
  return step;
}

struct Block {
  Index3 size;
  std::vector<float> values;
  double at(int x, int y, int z) const { return values[(static_cast<std::size_t>(z) * size.y + y) * size.x + x]; }
  /// The trilinear interpolation by definition: the sum of corner * weight.
  double trilinear(const Vec3& p) const {
    const auto base = [](double v, int n) { return std::min(std::max(static_cast<int>(std::floor(v)), 0), n - 2); };
    const int x = base(p.x, size.x), y = base(p.y, size.y), z = base(p.z, size.z);
    double sum = 0;
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i)
          sum += at(x + i, y + j, z + k) * (i ? p.x - x : 1 - p.x + x) * (j ? p.y - y : 1 - p.y + y) * (k ? p.z - z : 1 - p.z + z);
    return sum;
  }
};

inline Block random_block(const Index3& size, std::uint64_t seed) {
  Random random(seed);
  Block b{size, {}};
  b.values.resize(static_cast<std::size_t>(size.x) * size.y * size.z);
  for (float& v : b.values) v = static_cast<float>(random.uniform(-3, 5));
  return b;
}

inline std::shared_ptr<const ScalarGrid> random_grid(const Index3& size, std::uint64_t seed, const Mapping& mapping = {}) {
  return make_scalar_grid("g", mapping, size, random_block(size, seed).values);
}

/// f(x, y, z) at each voxel, x fastest.
template <class T = float, class F>
std::vector<T> values_of(const Index3& n, const F& f) {
  std::vector<T> values;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) values.push_back(static_cast<T>(f(x, y, z)));
  return values;
}

/// A request for a grid of a file, or for its only grid.
inline LoadRequest request_for(const std::string& path, const std::string& grid = {}, int step = 0) {
  LoadRequest request;
  request.path = path;
  request.grid = grid;
  request.step = step;
  return request;
}

/// Loads a grid; an error ends the test case.
inline AnyField read(const std::string& path, const std::string& grid = {}, int step = 0) {
  return value_of(load(request_for(path, grid, step)));
}

inline std::string error_of(const std::string& path, const std::string& grid = {}) {
  const auto field = load(request_for(path, grid));
  return field ? "loaded" : field.error().message;
}

inline ScalarSample sample_at(const AnyField& field, const Vec3& world) {
  Cursor cursor;
  return field.scalar->sample(world, cursor);
}

/// The value at a position; the test fails if it has none.
inline double value_at(const AnyField& field, const Vec3& world) {
  const ScalarSample sample = sample_at(field, world);
  EXPECT_TRUE(sample.inside) << world.x << " " << world.y << " " << world.z;
  return sample.value;
}

/// Success if one of the notes contains the words.
inline testing::AssertionResult has_note(const AnyField& field, const std::string& words) {
  std::string all;
  for (const std::string& note : field.notes) all += note + "\n";
  return has(all, words);
}

/// Tests of readers, with a folder for their files.
class FilesTest : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& bytes) {
    write_file(folder_ / name, bytes);
    return folder_ / name;
  }
  TemporaryFolder folder_;
};

}  // namespace catena::field::test
