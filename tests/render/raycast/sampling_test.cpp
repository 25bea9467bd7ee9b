// SPDX-License-Identifier: MIT
/// Values sampled on the GPU against the grid's values on the CPU, at 10,000 random points.
#include <cmath>
#include <cstring>
#include <random>

#include "render/residency/brick_map.h"
#include "render/vk/commands.h"
#include "shaders/shared/frame.h"
#include "tests/render/support/device_fixture.h"
#include "tests/render/support/image_fixture.h"
#include "tests/render/support/spirv.h"

namespace catena::test::sampling_test {

using namespace catena::render;

class Sampling : public DeviceFixture {
 protected:
  std::vector<float> sample(const ResidentGrid& mirror, const std::vector<glm::vec3>& local) {
    const auto words = shader_words("sample.comp");
    EXPECT_FALSE(words.empty());
    vk::ComputeInfo info;
    info.shader = words;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform}, {1, vk::DescriptorKind::buffer},   {2, vk::DescriptorKind::buffer},
                            {3, vk::DescriptorKind::sampled}, {11, vk::DescriptorKind::texture}, {19, vk::DescriptorKind::texture}};
    info.constants = {(mirror.atlas ? 1u : 0u) | (mirror.masked ? 2u : 0u) | (mirror.cubic ? 4u : 0u)};
    auto pipeline = vk::Pipeline::create(*device_, info);
    EXPECT_TRUE(pipeline);
    auto map = make_brick_map(*device_, mirror, [](const BrickRange&) { return true; });
    EXPECT_TRUE(map);
    shared::FrameData frame{};
    frame.grids[0].lo = glm::vec3(mirror.box_lo);
    frame.grids[0].hi = glm::vec3(mirror.box_hi);
    const VkExtent3D e = mirror.values.info().extent;
    frame.grids[0].texel = {1.0f / float(e.width), 1.0f / float(e.height), 1.0f / float(e.depth)};
    frame.grids[0].value_offset = mirror.offset;
    frame.grids[0].value_scale = mirror.scale;
    auto uniform = vk::Buffer::create(*device_, sizeof frame, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, vk::Memory::upload);
    auto positions = vk::upload_buffer(*device_, std::as_bytes(std::span(local)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    auto values = vk::Buffer::create(*device_, 4 * local.size(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, vk::Memory::readback);
    auto linear = vk::Sampler::create(*device_, vk::Filter::linear);
    EXPECT_TRUE(uniform && positions && values && linear);
    std::memcpy(uniform->bytes().data(), &frame, sizeof frame);
    auto commands = vk::Commands::begin(*device_);
    EXPECT_TRUE(commands);
    const vk::Image& mask = mirror.masked ? mirror.mask : map->image;
    const vk::Binding bindings[] = {{0, vk::DescriptorKind::uniform, &*uniform, nullptr, nullptr},
                                    {1, vk::DescriptorKind::buffer, &*positions, nullptr, nullptr},
                                    {2, vk::DescriptorKind::buffer, &*values, nullptr, nullptr},
                                    {3, vk::DescriptorKind::sampled, nullptr, &mirror.values, &*linear},
                                    {11, vk::DescriptorKind::texture, nullptr, &map->image, nullptr},
                                    {19, vk::DescriptorKind::texture, nullptr, &mask, nullptr}};
    commands->bind(*pipeline, bindings);
    commands->dispatch((std::uint32_t(local.size()) + 63) / 64, 1, 1);
    commands->barrier(*values, vk::kComputeWrite, vk::kHostRead);
    EXPECT_TRUE(commands->finish());
    std::vector<float> out(local.size());
    std::memcpy(out.data(), values->bytes().data(), 4 * out.size());
    return out;
  }

  /// Maximum error of a GPU's texture filter, whose weights are multiples of 1/256 per axis. Cubic cells and lavapipe use float weights.
  static double of_weights(const field::ScalarGrid& grid, const Vec3& index, field::Cursor& cursor) {
    if (uses_lavapipe() || grid.interpolation() != field::Interpolation::linear) return 0;
    const field::ScalarCell cell = grid.cell(grid.cell_base(index), cursor);
    const auto [min_corner, max_corner] = std::minmax_element(std::begin(cell.corner), std::end(cell.corner));
    return 3.0 / 512 * (*max_corner - *min_corner);
  }

  /// Checks the error at 10,000 random points of the domain against `tolerance(value)`.
  void expect_close(const field::ScalarGrid& grid, const ResidencyOptions& options, const std::function<double(double)>& tolerance) {
    auto mirror = make_resident_grid(*device_, grid, options);
    ASSERT_TRUE(mirror);
    ASSERT_EQ(mirror->atlas, options.layout == GridLayout::atlas);
    ASSERT_EQ(mirror->cubic, grid.interpolation() == field::Interpolation::cubic);
    std::mt19937 random(7);
    std::vector<glm::vec3> local;
    std::vector<Vec3> world;
    const Vec3 lo = mirror->box_lo, size = mirror->box_hi - mirror->box_lo;
    for (int i = 0; i < 10000; ++i) {
      std::uniform_real_distribution<double> unit(0, 1);
      Vec3 p = lo + size * Vec3(unit(random), unit(random), unit(random));
      if (i % 10 == 0) p = glm::dvec3(std::round(p.x), p.y, std::round(p.z));  // includes faces and edges of cells
      if (i < 8) p = lo + size * Vec3(i & 1, i >> 1 & 1, i >> 2);
      local.emplace_back(p);
      // the reference at the same float position as on the GPU
      const Vec3 index = Vec3(local.back()) + Vec3(mirror->origin.x, mirror->origin.y, mirror->origin.z);
      world.push_back(grid.mapping().world_from_index(index));
    }
    const std::vector<float> values = sample(*mirror, local);
    field::Cursor cursor;
    double worst = 0;
    int compared = 0;
    for (std::size_t i = 0; i < local.size(); ++i) {
      const field::ScalarSample truth = grid.sample(world[i], cursor);
      if (mirror->masked && (values[i] > 1e29 || !truth.inside)) {
        // on a face between a valid and an invalid cell either result is correct
        if (i % 10 != 0 && i >= 8) {
          EXPECT_EQ(values[i] > 1e29, !truth.inside);
        }
        continue;
      }
      ++compared;
      const double allowed = tolerance(truth.value) + of_weights(grid, grid.mapping().index_from_world(world[i]), cursor);
      worst = std::max(worst, std::fabs(values[i] - truth.value) / allowed);
    }
    EXPECT_GT(compared, 2000);
    EXPECT_LE(worst, 1.0);
  }
};

double wavy(const Vec3& p) { return 40 * std::sin(0.31 * p.x + 0.2 * p.y) * std::cos(0.23 * p.z) + 0.37 * p.y - 20; }

TEST_F(Sampling, ALayerOfMaskedCellsBetweenValidVoxelsIsAHole) {
  const field::Index3 n{20, 18, 17};
  std::vector<float> values;
  std::vector<std::uint8_t> cells;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) {
        values.push_back(float(wavy(Vec3(x, y, z))));
        cells.push_back(x != 9 && (x + y) % 7 != 3);
      }
  const auto grid = field::make_scalar_grid("g", {}, n, values, std::vector<std::uint8_t>(values.size(), 1), cells);
  ASSERT_TRUE(grid->has_cell_mask());
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas})
    expect_close(*grid, {true, layout}, [&](double) { return 1e-5 * 80; });
}

TEST_F(Sampling, Float32) {
  const auto grid = make_grid({64, 64, 64}, wavy);
  const double range = grid->max_value() - grid->min_value();
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas})
    expect_close(*grid, {true, layout}, [&](double) { return 1e-5 * range; });
}

TEST_F(Sampling, HalfFloatsAreRounded) {
  const auto grid = make_grid({64, 64, 64}, wavy);
  const double largest = std::max(std::fabs(grid->min_value()), std::fabs(grid->max_value()));
  // half an ulp of the largest corner value: 2^-12 of the next power of two
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas})
    expect_close(*grid, {false, layout}, [&](double) { return std::exp2(std::ceil(std::log2(largest)) - 12) + 1e-6 * largest; });
}

TEST_F(Sampling, HalfOfASmallRangeFarFromZero) {
  const auto grid = make_grid({40, 33, 21}, [](const Vec3& p) { return 300000 + 0.5 * wavy(p); });
  const double range = grid->max_value() - grid->min_value();
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas})
    expect_close(*grid, {false, layout}, [&](double) { return range / 4096 + 0.04; });
}

TEST_F(Sampling, HalfOfHugeAndTinyValues) {
  for (const double scale : {1e30, 1e-30}) {
    const auto grid = make_grid({20, 20, 20}, [&](const Vec3& p) { return scale * (p.x - 3); });
    expect_close(*grid, {false, GridLayout::dense}, [&](double) { return scale * 16 / 2048; });
  }
}

TEST_F(Sampling, AnOddBoxInTheAtlas) {
  const auto grid = make_grid({17, 9, 25}, wavy);
  expect_close(*grid, {true, GridLayout::atlas}, [&](double) { return 1e-3; });
}

TEST_F(Sampling, MaskedCells) {
  const auto grid = make_grid({40, 40, 40}, wavy, {}, [](const Vec3& p) { return norm(p - Vec3(17, 20, 22)) < 19; });
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) expect_close(*grid, {true, layout}, [&](double) { return 1e-3; });
}

TEST_F(Sampling, CubicMatchesTheFieldWithPaddingAndMask) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto rough = [&](const Vec3&) { return uniform(random); };
  for (const field::Index3& size : {field::Index3{21, 9, 26}, field::Index3{2, 2, 2}, field::Index3{16, 17, 18}}) {
    const auto whole = make_grid(size, rough)->as_cubic(),
               holed = make_grid(size, rough, {}, [&](const Vec3&p) { return p.x < 12 || uniform(random) < 0.97; })->as_cubic();
    ASSERT_TRUE(whole && holed);
    for (const GridLayout layout : {GridLayout::automatic, GridLayout::dense}) {
      expect_close(**whole, {true, layout}, [](double) { return 3e-6; });
      expect_close(**whole, {false, layout}, [](double) { return 2e-3; });
      expect_close(**holed, {true, layout}, [](double) { return 3e-6; });
    }
  }
}

TEST_F(Sampling, CubicOfAConstantIsExact) {
  const auto grid = make_grid({9, 9, 9}, [](const Vec3&) { return 0.1f; })->as_cubic();
  ASSERT_TRUE(grid);
  expect_close(**grid, {true, GridLayout::dense}, [](double) { return 1e-30; });
}

/// The range of a brick includes every value in its cells.
TEST_F(Sampling, RangesOfCubicBricksIncludeOvershoots) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double masked : {0.0, 0.02}) {
    const auto grid = make_grid(
                          {27, 18, 33}, [&](const Vec3&) { return uniform(random) < 0.5 ? 0.0 : 1.0; }, {},
                          [&](const Vec3&) { return uniform(random) >= masked; })
                          ->as_cubic();
    ASSERT_TRUE(grid);
    const auto mirror = make_resident_grid(*device_, **grid, {true, GridLayout::automatic});
    ASSERT_TRUE(mirror && mirror->cubic && !mirror->atlas);
    ASSERT_EQ(mirror->bricks, (std::array<std::int32_t, 3>{4, 3, 5}));
    field::Cursor cursor;
    int beyond = 0;
    for (int trial = 0; trial < 100000; ++trial) {
      const Vec3 local = mirror->box_lo + (mirror->box_hi - mirror->box_lo) * Vec3(uniform(random), uniform(random), uniform(random));
      const auto s = (*grid)->sample(local + Vec3(mirror->origin.x, mirror->origin.y, mirror->origin.z), cursor);
      if (!s.inside) continue;
      const BrickRange& r =
          mirror->brick_ranges[mirror->brick_index(int(local.x) / kBrickSize, int(local.y) / kBrickSize, int(local.z) / kBrickSize)];
      ASSERT_TRUE(r.min <= s.value && s.value <= r.max);
      if (s.value < 0 || s.value > 1) ++beyond;
    }
    EXPECT_GT(beyond, 10000);
  }
}

}  // namespace catena::test::sampling_test
