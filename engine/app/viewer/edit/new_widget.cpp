#include "engine/app/viewer/edit/new_widget.h"

#include <algorithm>

#include "engine/app/viewer/edit/chain_edit.h"
#include "engine/scene/widgets.h"
#include "engine/scene/write_values.h"

namespace catena::app {

std::vector<std::string> widget_types() { return {"cutting_plane", "seed", "rake", "isolevel", "box", "ruler"}; }

Result<std::string> new_widget(const scene::Scene& scene, const std::string& type, const Bounds& bounds) {
  using scene::text_of;
  std::vector<std::string> taken;
  scene.world.each<scene::Widget>([&](scene::Entity e, const scene::Widget&) { taken.push_back(scene.world.get<scene::Name>(e).value); });
  std::string name = type == "cutting_plane" ? "cut" : type;
  for (int n = 2; std::find(taken.begin(), taken.end(), name) != taken.end(); ++n)
    name = (type == "cutting_plane" ? "cut" : type) + "_" + std::to_string(n);

  const Vec3 middle = bounds.empty() ? Vec3(0.0) : bounds.centre(), size = bounds.empty() ? Vec3(1.0) : bounds.hi - bounds.lo;
  const Vec3 half(0.25 * max_abs(size), 0, 0);
  std::string text = "{\"name\": " + text_of(name) + ", \"type\": " + text_of(type);
  const auto add = [&](const char* key, const std::string& value) { text += std::string(", \"") + key + "\": " + value; };
  if (type == "cutting_plane") {
    add("center", text_of(middle));
    add("normal", "[0, 0, 1]");
  } else if (type == "seed") {
    add("position", text_of(middle));
  } else if (type == "isolevel") {
    // the field of a surface that is drawn, or else the first one
    std::string field;
    scene.world.each<scene::Isosurface>([&](scene::Entity, const scene::Isosurface& surface) {
      if (field.empty()) field = scene.world.get<scene::Name>(surface.field).value;
    });
    if (const auto fields = fields_of(scene, false); field.empty() && !fields.empty()) field = fields.front();
    if (field.empty()) return Error{"an isolevel needs a scalar field, which the scene does not have"};
    add("field", text_of(field));
    add("position", text_of(middle));
  } else if (type == "box") {
    add("lo", text_of(middle - size * 0.25));
    add("hi", text_of(middle + size * 0.25));
  } else {
    add("from", text_of(middle - half));
    add("to", text_of(middle + half));
  }
  return text + "}";
}

}  // namespace catena::app
