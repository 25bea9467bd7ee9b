// SPDX-License-Identifier: MIT
/// Reads "orthogonal_views".
#include "engine/scene/readers.h"
#include "engine/scene/to_json.h"

namespace catena::scene {

namespace {

const Table<OrthogonalViews>& views_table() {
  static const auto table = [] {
    Table<OrthogonalViews> t;
    t.bind(schema::vec3("focus", "world", "Common point of the planes.").with_default("the middle of the base field"),
           &OrthogonalViews::focus);
    t.custom(
        schema::vector("window", 2, "value", "Values of the base field that are shown as black and white.")
            .with_range_text("rising")
            .with_default("the display range"),
        [](Scene&, const json::Node& object, OrthogonalViews& views) -> Outcome {
          CATENA_TRY(views.window, read_range(object, "window"));
          return Done{};
        },
        [](const Scene&, const OrthogonalViews& views) { return views.window ? to_json(*views.window) : std::string(); });
    t.bind(schema::number("zoom", "", "Magnification of the planes; at 1 each of them shows the whole field.")
               .within(kMinPlaneZoom, kMaxPlaneZoom),
           &OrthogonalViews::zoom);
    t.bind(schema::vec3("center", "world", "Point in the middle of every plane.").with_default("the middle of the base field"),
           &OrthogonalViews::center);
    return t;
  }();
  return table;
}

Outcome read_orthogonal_views(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "orthogonal_views"));
  return views_table().read(scene, node, scene.orthogonal_views.emplace());
}

}  // namespace

Part orthogonal_views_part() {
  return {{"orthogonal_views",
           "Axial, coronal and sagittal planes beside the 3D view. With this key the window opens with them, and `render --layout ortho` "
           "draws them in this state.",
           schema::Section::Layout::object, views_table().keys()},
          read_orthogonal_views};
}

std::string to_json(const OrthogonalViews& views) { return views_table().write({}, views); }

}  // namespace catena::scene
