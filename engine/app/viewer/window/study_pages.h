/// What a study shows over the picture: pages, questions, and one line while a trial waits. Nothing of it tells a trial's condition.
/// Frame thread, between Gui::begin and end.
#pragma once
#include <string>
#include <vector>

#include "engine/app/study/procedure.h"
#include "engine/app/viewer/window/layout.h"

namespace catena::app {

/// Heights of the text of pages and of their headings, beside the panels': what Gui is made with.
inline constexpr float kPageTextPx = 22, kHeadingTextPx = 32;

struct StudyView {
  const Procedure& procedure;
  bool is_at_start = false;           ///< the cursor is where the trial that is ready begins
  bool must_return_to_start = false;  ///< the trial runs, and the cursor has to come back to its start
  std::string device_prompt{};        ///< what the device asks of the person; empty: nothing
};

/// The same in each area: eyes that have a part of the window for themselves have a page each.
void draw_study(const StudyView& view, const std::vector<Area>& areas);

}  // namespace catena::app
