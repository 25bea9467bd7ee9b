// SPDX-License-Identifier: MIT
/// Pages of a study, shown over the image: pages, questions, and one line while a trial waits. Nothing in them reveals the condition of a
/// trial. Frame thread, between Gui::begin and end.
#pragma once
#include <string>
#include <vector>

#include "engine/app/study/procedure.h"
#include "engine/app/viewer/window/layout.h"

namespace catena::app {

/// Text heights of pages and headings, passed to the Gui in addition to the panels' height.
inline constexpr float kPageTextPx = 22, kHeadingTextPx = 32;

/// Content of the pages.
struct StudyView {
  const Procedure& procedure;
  bool is_at_start = false;           ///< The cursor is at the start point of the ready trial.
  bool must_return_to_start = false;  ///< The trial runs, and the cursor must return to its start point.
  std::string device_prompt{};        ///< Instruction from the device for the user; empty: none.
};

/// Draws the same page in each area; with side-by-side stereo each eye has an area of its own.
void draw_study(const StudyView& view, const std::vector<Area>& areas);

}  // namespace catena::app
