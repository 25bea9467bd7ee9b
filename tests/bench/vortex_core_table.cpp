// SPDX-License-Identifier: MIT
/// Traced core lines of flows with known cores (engine/geometry/flow/vortex_cores.h), by criterion, cells and noise.
///   vortex_core_table [NODES]        default 49, over [-1.2, 1.2]^3
/// Flows: Burgers' vortex about a tilted line, also in a sheared axial stream, the Lamb-Oseen vortex about an arc of radius 1.5 with an
/// axial stream, Hill's ring. Noise: uniform and independent at the nodes, standard deviation relative to the maximum speed. One line per
/// case: recall (fraction of the core within a voxel of a traced line), RMS and maximum distance in voxels of the traced lines from the
/// core within two voxels of it, and the length of the other traced lines relative to the core's.
#include <fmt/core.h>

#include <cstdlib>

#include "engine/base/random.h"
#include "engine/geometry/flow/vortex_cores.h"
#include "tests/engine/geometry/flow/analytic_cores.h"

namespace {

using namespace catena;

void measure(const test::AnalyticCore& known, int nodes, double noise, bool cubic, flow::CoreCriterion criterion) {
  const double voxel = 2.4 / (nodes - 1);
  const auto grid = test::sample_core_flow(known, nodes, noise, 1);
  const field::VectorFieldPtr field = cubic ? *grid->as_cubic() : grid;
  const auto cores = flow::find_vortex_cores(field, {criterion});
  const test::CoreScore score = test::score_cores(**cores, known, voxel);
  fmt::print("{:12} {:17} {:7} {:5.2f}  {:6.3f} {:7.4f} {:7.4f} {:7.3f}{}\n", known.name,
             flow::kCoreCriterionNames[static_cast<int>(criterion)], cubic ? "cubic" : "linear", noise, score.recall, score.rms,
             score.worst, score.false_length, (*cores)->holds_everywhere ? "  everywhere" : "");
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const int nodes = argc > 1 ? std::atoi(argv[1]) : 49;
  fmt::print("flow         criterion         cells   noise  recall     rms   worst  strays\n");
  for (const test::AnalyticCore& known : test::analytic_cores())
    for (const auto criterion : {flow::CoreCriterion::sujudi_haimes, flow::CoreCriterion::parallel_vectors, flow::CoreCriterion::vorticity})
      for (const bool cubic : {false, true})
        for (const double noise : {0.0, 0.02, 0.05, 0.1}) measure(known, nodes, noise, cubic, criterion);
  return 0;
}
