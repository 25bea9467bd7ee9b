// SPDX-License-Identifier: MIT
// Streamline links on cubic grids: the haptic and the drawn line are the same.
#include "engine/geometry/flow/curve.h"
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::streamline_cubic_test {

TEST(StreamlineCubic, HapticAndDrawnLinesAgree) {
  const auto abc = field::make_analytic("abc")->vector;
  const auto made = field::sample_on_grid(*abc, 40, -2, 2)->as_cubic();
  ASSERT_TRUE(made);
  Fields fields;
  fields.named["f"].vector = *made;
  const field::VectorField& field = **made;
  const Vec3 seed(0.2, 0.1, -0.3);
  const auto drawn = flow::trace({&field}, seed, {.length = 1.5});
  ASSERT_TRUE(drawn);
  const flow::NearestOnCurve nearest(*drawn);
  for (const char* more : {"", R"(, "follow": "online", "method": "dp54", "tolerance": 1e-12)"}) {
    Rig rig(build(std::string(R"({"name": "a", "type": "streamline", "field": "f", "seed": [0.2, 0.1, -0.3])") + more + "}", fields));
    double worst = 0, gone = 0;
    for (int k = 0; k <= 4000; ++k) {
      const double s = 1.2 * std::sin(2 * 3.141592653589793 * k / 4000);
      ASSERT_TRUE(rig.tick((*drawn)->position(s) + Vec3(0.01, -0.02, 0.01)).status == LinkStatus::ok) << k << more;
      worst = std::max(worst, std::sqrt(nearest.find(rig.state.proxy).distance2));
      gone = std::max(gone, norm(rig.state.proxy - seed));
    }
    EXPECT_LE(worst, 1e-9 * field.domain_length()) << more;
    EXPECT_GT(gone, 0.9);
  }
}

}  // namespace catena::haptics::tests::streamline_cubic_test
