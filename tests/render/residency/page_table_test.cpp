// SPDX-License-Identifier: MIT
/// The page table: which page stands for each entry, what is loaded next, what leaves.
#include "render/residency/page_table.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/formula_bricks.h"

namespace catena::render::page_table_test {

using field::Index3;
using Visits = std::vector<std::uint32_t>;

/// 5 x 4 x 3 bricks, 3 x 2 x 2 and 2 x 1 x 1.
class Bricks final : public field::BrickSource {
 public:
  Bricks() : BrickSource(*field::find_number_type("uint8"), make_levels()) {}
  field::BrickRange range(int, const Index3&) const noexcept override { return {}; }
  Outcome read(int, const Index3&, std::span<std::byte>) const override { return Done{}; }

 private:
  static std::vector<field::BrickLevel> make_levels() {
    const auto level = [](const Index3& size, double edge) {
      return field::BrickLevel{size, field::Mapping::from_linear(Mat3(edge), Vec3(0.5 * edge))};
    };
    return {level({300, 200, 150}, 1), level({100, 67, 50}, 3), level({150, 100, 75}, 2), level({75, 50, 37}, 4)};
  }
};

/// Returns the level that an entry's word refers to; -1: homogeneous.
int shown_level(const PageTable& table, const Index3& entry) {
  const std::uint32_t word = table.words()[field::brick_number(table.counts(), entry)];
  return word >> 31 != 0 ? -1 : int(word >> 21 & 15);
}

int finest(const Index3&) { return 0; }

PageTable make_table(const std::array<std::uint32_t, 3>& slots) {
  PageTable table(page_levels(Bricks()), slots);
  for (const PageId& id : table.root_pages()) EXPECT_TRUE(table.place(id));
  return table;
}

TEST(PageTable, LevelsWhoseVoxelsArePowersOfTwoBecomePages) {
  const std::vector<PageLevel> levels = page_levels(Bricks());
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[1].source_level, 2);
  EXPECT_EQ(levels[2].shift, (Index3{2, 2, 2}));
  // the first voxel of level 2 is the mean of the first four
  EXPECT_NEAR(levels[2].scale.x * 1.5 + levels[2].offset.x, 0, 1e-12);
}

TEST(PageTable, EntriesReferToTheFinestPageThatIsThere) {
  PageTable table = make_table({4, 4, 2});
  EXPECT_EQ(shown_level(table, {4, 3, 2}), 2);
  ASSERT_TRUE(table.place({1, {1, 0, 0}}));
  ASSERT_TRUE(table.place({0, {3, 1, 1}}));
  EXPECT_EQ(shown_level(table, {3, 1, 1}), 0);
  EXPECT_EQ(shown_level(table, {2, 1, 1}), 1);
  EXPECT_EQ(shown_level(table, {4, 1, 1}), 2);
  EXPECT_TRUE(table.take_changed());
  EXPECT_FALSE(table.take_changed());
}

TEST(PageTable, TheMostVisitedPagesAreLoadedFirstAndWhatIsNotNeededLeaves) {
  PageTable table = make_table({2, 2, 2});  // two roots, six others
  Visits visits(60);
  for (std::size_t i = 0; i < 6; ++i) visits[i] = std::uint32_t(10 + i);  // the first row of x, and one of the second
  PagePlan plan = table.plan(visits, finest, false);
  ASSERT_EQ(plan.loads.size(), 6u);
  EXPECT_EQ(plan.bias, 0);
  EXPECT_EQ(plan.loads.front(), (PageId{0, {0, 1, 0}}));
  for (const PageId& id : plan.loads) ASSERT_TRUE(table.place(id));
  plan = table.plan(visits, finest, false);
  EXPECT_EQ(plan.resident, 6u);
  EXPECT_TRUE(plan.loads.empty());
  EXPECT_FALSE(table.place({0, {4, 3, 2}})) << "all are needed";

  // the camera looks elsewhere
  std::ranges::fill(visits, 0);
  visits[59] = 1;
  plan = table.plan(visits, finest, false);
  ASSERT_EQ(plan.loads, (std::vector<PageId>{{0, {4, 3, 2}}}));
  ASSERT_TRUE(table.place(plan.loads.front()));
  int fallen_back = 0;
  for (int x = 0; x < 5; ++x) fallen_back += shown_level(table, {x, 0, 0}) == 2;
  fallen_back += shown_level(table, {0, 1, 0}) == 2;
  EXPECT_EQ(fallen_back, 1) << "one page has left, its entry shows the coarsest level";
}

TEST(PageTable, WhatDoesNotFitIsTakenFromACoarserLevel) {
  PageTable table = make_table({3, 3, 2});  // two roots, sixteen others
  const Visits all(60, 7);
  const PagePlan plan = table.plan(all, finest, false);
  EXPECT_EQ(plan.bias, 1);
  EXPECT_EQ(plan.visible, 12u);
  EXPECT_TRUE(std::ranges::all_of(plan.loads, [](const PageId& id) { return id.level == 1; }));
}

TEST(PageTable, StepByStepTheWholeImageBecomesBetterAtTheSameTime) {
  PageTable table = make_table({6, 5, 3});
  const Visits all(60, 7);
  PagePlan plan = table.plan(all, finest, true);
  EXPECT_EQ(plan.loads.size(), 12u);
  for (const PageId& id : plan.loads) {
    EXPECT_EQ(id.level, 1u);
    ASSERT_TRUE(table.place(id));
  }
  plan = table.plan(all, finest, true);
  EXPECT_EQ(plan.loads.size(), 60u);
  EXPECT_EQ(plan.visible, 60u);
}

TEST(PageTable, HomogeneousEntriesNeedNoPage) {
  PageTable table = make_table({4, 4, 2});
  table.set_looks([](const Index3& entry) { return entry.x < 3 ? PageLook{1, 9} : PageLook{}; });
  EXPECT_EQ(shown_level(table, {0, 0, 0}), -1);
  EXPECT_EQ(table.words()[0] & 255u, 9u);
  EXPECT_EQ(table.words()[0] >> 25 & 63u, 3u) << "two more entries along x look alike";
  EXPECT_EQ(shown_level(table, {3, 0, 0}), 2);
  const PagePlan plan = table.plan(Visits(60, 1), finest, false);
  EXPECT_EQ(plan.visible, 24u);
}

}  // namespace catena::render::page_table_test
