// SPDX-License-Identifier: MIT
#include "engine/app/haptics/contact_summary.h"

#include <gtest/gtest.h>

namespace catena::app::contact_summary_test {

TEST(ContactSummary, NamesThePressedLabel) {
  haptics::HapticProgram program;
  program.meters_per_unit = 0.001;
  haptics::Link link;
  link.name = "gyrus";
  link.one_sided = true;
  link.feature_name = "Precentral_L";
  program.links = {link};
  ContactSummary summary;
  HapticState state;
  state.link_count = 1;
  state.links[0].status = LinkStatus::ok;
  state.links[0].gap = 3;
  state.force_n = state.links[0].force_n = Vec3(0, 0, 2);
  for (int k = 0; k < 3; ++k) {
    state.t_s = 0.1 * k;
    summary.add(state);
  }
  EXPECT_EQ(summary.link_lines(program), "gyrus: pressed 3 mm into Precentral_L, at most 2 N; held 0.20 of 0.20 s\n");
  program.links[0].one_sided = false;
  EXPECT_NE(summary.link_lines(program).find("pulled up to 3 mm away from Precentral_L"), std::string::npos);
}

}  // namespace catena::app::contact_summary_test
