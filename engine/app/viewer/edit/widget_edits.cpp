#include "engine/app/viewer/edit/widget_edits.h"

#include "engine/app/viewer/edit/pointers.h"
#include "engine/scene/widgets.h"
#include "engine/scene/write_values.h"

namespace catena::app {

namespace {

bool is_held(exchange::WidgetMode mode) {
  using Mode = exchange::WidgetMode;
  return mode == Mode::translate || mode == Mode::turn || mode == Mode::drag;
}

}  // namespace

std::vector<WidgetEdits::Ended> WidgetEdits::take(const scene::Scene& scene) {
  std::vector<Ended> ended;
  std::map<std::string, bool> held;
  scene.world.each<scene::Widget>([&](scene::Entity e, const scene::Widget& widget) {
    const std::string& place = widget.where.label;
    held[place] = is_held(widget.state.mode);
    const auto before = held_.find(place);
    if (before == held_.end() || !before->second || held[place]) return;
    Ended end{"move " + scene.world.get<scene::Name>(e).value, {}};
    for (auto& [key, value] : scene::pose_members(widget.spec.kind, widget.state.pose))
      end.edits.push_back({pointer_of(widget.where) + "/" + key, std::move(value)});
    ended.push_back(std::move(end));
  });
  held_ = std::move(held);
  return ended;
}

}  // namespace catena::app
