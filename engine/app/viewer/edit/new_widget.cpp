#include "engine/app/viewer/edit/new_widget.h"

#include <algorithm>

#include "engine/app/viewer/edit/chain_edit.h"
#include "engine/base/text.h"
#include "engine/scene/widgets.h"
#include "engine/scene/write_values.h"

namespace catena::app {

namespace {

/// The field of a surface that is drawn, or else the first scalar one.
scene::Entity field_of_isolevel(const scene::Scene& scene) {
  scene::Entity field;
  scene.world.each<scene::Isosurface>([&](scene::Entity, const scene::Isosurface& surface) {
    if (!field) field = surface.field;
  });
  const auto fields = fields_of(scene, false);
  return field || fields.empty() ? field : scene::find_field(scene, fields.front());
}

}  // namespace

std::vector<std::string> widget_types() {
  std::vector<std::string> words;
  for (const schema::Component& component : scene::scene_components())
    if (component.name == "widgets")
      for (const schema::Variant& type : component.variants) words.push_back(type.name);
  return words;
}

Result<std::string> new_widget(const scene::Scene& scene, const std::string& type, const Bounds& bounds) {
  using widget::Kind;
  const std::vector<std::string> types = widget_types();
  const auto kind = static_cast<Kind>(std::find(types.begin(), types.end(), type) - types.begin());
  const std::string name =
      free_name(kind == Kind::cutting_plane ? "cut" : type, [&](const std::string& n) { return bool(scene::find_widget(scene, n)); });

  const Vec3 middle = bounds.empty() ? Vec3(0.0) : bounds.centre(), size = bounds.empty() ? Vec3(1.0) : bounds.hi - bounds.lo;
  const Vec3 half = kind == Kind::box ? size * 0.25 : Vec3(0.25 * max_abs(size), 0, 0);
  const bool two_ends = kind == Kind::rake || kind == Kind::ruler || kind == Kind::box;
  scene::Widget widget;
  widget.spec.kind = kind;
  widget.spec.pose.points = {two_ends ? middle - half : middle, middle + half};
  if (kind == Kind::isolevel && !(widget.field = field_of_isolevel(scene)))
    return Error{"an isolevel needs a scalar field, which the scene does not have"};
  return scene::text_of(scene, name, widget);
}

}  // namespace catena::app
