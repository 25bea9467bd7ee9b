// SPDX-License-Identifier: MIT
/// `catena render --gpu-memory`: a grid that does not fit is drawn at a lower resolution, with a note and an entry in the statistics; a
/// grid that fits at no resolution is a one-line error.
#include "tests/engine/app/program_in_folder.h"

namespace catena::gpu_memory_test {

class GpuMemory : public test::ProgramInFolder {
 protected:
  test::ProgramResult render(const std::string& megabytes) {
    write("s.json", R"({"fields": {"density": {"analytic": "sphere", "resolution": 64}},
      "volumes": [{"field": "density", "color": [[0, 1, 0, 0], [2, 0, 0, 1]], "extinction": [[0, 0.5], [2, 0]]}]})");
    return run("render {s.json} -o {o.png} --size 96x64 --quality reference --validation --stats {o.json} --gpu-memory " + megabytes);
  }
};

TEST_F(GpuMemory, AGridThatDoesNotFitIsDrawnCoarser) {
  const auto run = render("2");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  test::expect_parts(run.err, {"sphere: 64^3 needs 1.3 MB of GPU memory, 0.85 MB are left: drawn at half resolution\n"});
  test::expect_parts(read("o.json"), {R"("mirror_coarsening": [{"grid": "sphere", "factor": 2}])", "\"gpu_budget_bytes\": 2000000,",
                                      "\"validation_messages\": 0"});
}

TEST_F(GpuMemory, AGridThatFitsKeepsItsResolution) {
  const auto run = render("20");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err.find("resolution"), std::string::npos) << run.err;
  test::expect_parts(read("o.json"), {"\"mirror_coarsening\": []"});
}

TEST_F(GpuMemory, NoImageIsWrittenIfNoResolutionFits) {
  const auto run = render("1.1");
  EXPECT_NE(run.exit_code, 0);
  test::expect_parts(run.err, {"sphere: 64^3 needs"});
  EXPECT_EQ(read("o.png"), "");
  EXPECT_EQ(render("much").exit_code, 2);
}

}  // namespace catena::gpu_memory_test
