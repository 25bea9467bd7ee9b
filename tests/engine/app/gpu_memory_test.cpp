// SPDX-License-Identifier: MIT
/// `catena render --gpu-memory`: a grid that does not fit is drawn at a lower resolution, with a note and an entry in the statistics; a
/// grid that fits at no resolution is a one-line error.
#include <gtest/gtest.h>

#include "engine/base/json.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace gpu_memory_test {

using namespace catena;

test::ProgramResult render(const test::TemporaryFolder& folder, const std::string& megabytes) {
  test::write_file(folder / "s.json", R"({"fields": {"density": {"analytic": "sphere", "resolution": 64}},
    "volumes": [{"field": "density", "color": [[0, 1, 0, 0], [2, 0, 0, 1]], "extinction": [[0, 0.5], [2, 0]]}]})");
  return test::run_catena({"render", folder / "s.json", "-o", folder / "o.png", "--size", "96x64", "--quality", "reference", "--validation",
                           "--gpu-memory", megabytes, "--stats", folder / "o.json"});
}

TEST(GpuMemory, AGridThatDoesNotFitIsDrawnCoarser) {
  const test::TemporaryFolder folder;
  const auto run = render(folder, "2");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("sphere: 64^3 needs 1.3 MB of GPU memory, 0.85 MB are left: drawn at half resolution\n"), std::string::npos)
      << run.err;
  const std::string stats = test::read_file(folder / "o.json");
  EXPECT_NE(stats.find(R"("mirror_coarsening": [{"grid": "sphere", "factor": 2}])"), std::string::npos) << stats;
  EXPECT_NE(stats.find("\"gpu_budget_bytes\": 2000000,"), std::string::npos) << stats;
  EXPECT_NE(stats.find("\"validation_messages\": 0"), std::string::npos) << run.err;
}

TEST(GpuMemory, AGridThatFitsKeepsItsResolution) {
  const test::TemporaryFolder folder;
  const auto run = render(folder, "20");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err.find("resolution"), std::string::npos) << run.err;
  EXPECT_NE(test::read_file(folder / "o.json").find("\"mirror_coarsening\": []"), std::string::npos);
}

TEST(GpuMemory, NoImageIsWrittenIfNoResolutionFits) {
  const test::TemporaryFolder folder;
  const auto run = render(folder, "1.1");
  EXPECT_NE(run.exit_code, 0);
  EXPECT_NE(run.err.find("sphere: 64^3 needs"), std::string::npos) << run.err;
  EXPECT_EQ(test::read_file(folder / "o.png"), "");
  const auto words = render(folder, "much");
  EXPECT_EQ(words.exit_code, 2) << words.err;
}

}  // namespace gpu_memory_test
