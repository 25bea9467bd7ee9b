#include "engine/exchange/widget_report.h"

#include "engine/base/assert.h"

namespace catena::exchange {

const char* mode_word(WidgetMode mode) {
  switch (mode) {
    case WidgetMode::away:
      return "away";
    case WidgetMode::explore:
      return "explore";
    case WidgetMode::translate:
      return "translate";
    case WidgetMode::rotate:
      return "rotate";
    case WidgetMode::turn:
      return "turn";
    case WidgetMode::hover:
      return "hover";
    case WidgetMode::drag:
      return "drag";
  }
  CATENA_ASSERT(false);
  return "";
}

}  // namespace catena::exchange
