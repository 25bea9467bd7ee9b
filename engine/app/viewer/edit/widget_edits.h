/// When the hand lets go of a widget, where it stands becomes an edit of the scene's text: one step of undo. Frame thread.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "engine/scene/document.h"

namespace catena::app {

class WidgetEdits {
 public:
  struct Ended {
    std::string what;  ///< "move cut"
    std::vector<scene::Document::Edit> edits;
  };
  /// What ended since the last call.
  std::vector<Ended> take(const scene::Scene& scene);

 private:
  std::map<std::string, bool> held_;  ///< by the widget's place in the text
};

}  // namespace catena::app
