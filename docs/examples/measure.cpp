// SPDX-License-Identifier: MIT
// Connected parts and surface of a ball of radius 10 voxels. Data files: field::load (engine/io/volume/load_field.h) makes a grid.
#include <cmath>
#include <cstdio>
#include <vector>

#include "engine/field/measure/parts.h"
#include "engine/geometry/mesh/measure.h"

using namespace catena;

Outcome measure() {
  constexpr int kSize = 32;
  std::vector<float> values;
  for (int z = 0; z < kSize; ++z)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) values.push_back(static_cast<float>(10 - norm(Vec3(x - 16, y - 16, z - 16))));
  const auto grid = field::make_scalar_grid("ball", field::Mapping{}, {kSize, kSize, kSize}, values);
  CATENA_TRY(const field::MeasuredParts parts, field::measure_parts(*grid, 0, field::Neighbors::all, 1, nullptr));
  CATENA_TRY(const mesh::SurfaceMeasure surface, mesh::measure_isosurface(*grid, 0, parts, "the ball"));
  std::printf("%d part of %d voxels, area %.0f, volume %.0f\n", static_cast<int>(parts.count), static_cast<int>(parts.parts[0].voxels),
              surface.area, surface.volume.value_or(NAN));
  return Done{};
}

int main() {
  if (const Outcome done = measure(); !done) return std::fprintf(stderr, "%s\n", done.error().message.c_str()), 2;
  return 0;
}
