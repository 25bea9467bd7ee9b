// SPDX-License-Identifier: MIT
/// Reads "slices": their planes, colors and contour lines.
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"
#include "engine/scene/visibility.h"

namespace catena::scene {
namespace {

constexpr double kWidest = 100;  // pixels

const Table<Slice::Contours>& contours_table() {
  using Contours = Slice::Contours;
  static const auto table = [] {
    Table<Contours> t;
    t.bind(schema::numbers("levels", "value", "Values of the lines; exactly one of `levels`, `count` and `spacing` is required.")
               .with_range_text("rising")
               .without_default()
               .with_size(1, kMaxContours),
           &Contours::levels);
    t.bind(
        schema::integer("count", "", "Number of lines, evenly spaced within the range of the colours; the ends of the range have no line.",
                        1, kMaxContours)
            .without_default(),
        &Contours::count);
    t.bind(schema::number("spacing", "value", "Value step between lines; the lines are at all multiples of this step.")
               .positive()
               .without_default(),
           &Contours::spacing);
    t.bind(schema::color("color", "Colour of the lines."), &Contours::color);
    t.bind(schema::number("width", "pixels", "Width of the lines.").with_limits({0.0, kWidest, true}), &Contours::width);
    t.check([](Scene&, const json::Node& node, Contours& contours) -> Outcome {
      if (contours.levels.size() > static_cast<std::size_t>(kMaxContours))
        return json::error_at(*node.find("levels"), "\"levels\" holds " + std::to_string(contours.levels.size()) + " levels; at most " +
                                                        std::to_string(kMaxContours) + " were expected");
      for (std::size_t i = 1; i < contours.levels.size(); ++i)
        if (!(contours.levels[i] > contours.levels[i - 1]))
          return json::error_at(node.find("levels")->items[i], "\"levels\" has " + to_text(contours.levels[i]) + " after " +
                                                                   to_text(contours.levels[i - 1]) + "; rising numbers were expected");
      return Done{};
    });
    return t;
  }();
  return table;
}

Outcome read_contours(Scene& scene, const json::Node& item, Slice& slice) {
  const json::Node* node = item.find("contours");
  if (node == nullptr) return Done{};
  CATENA_CHECK(json::expect_object(*node, "contours"));
  int given_count = 0;
  for (const char* key : {"levels", "count", "spacing"}) given_count += node->find(key) != nullptr;
  slice.contours.emplace().where = *node;
  CATENA_CHECK(json::check_known_keys(*node, schema::key_names(contours_table().keys())));
  if (given_count != 1)
    return json::error_at(*node,
                          "\"contours\" has none or several of \"levels\", \"count\" and \"spacing\"; exactly one of them was expected");
  return contours_table().read_own_keys(scene, *node, *slice.contours);
}

const Table<Slice::FlowTexture>& flow_texture_table() {
  using FlowTexture = Slice::FlowTexture;
  static const auto table = [] {
    Table<FlowTexture> t;
    bind_field(t, schema::reference("field", Role::vector_field, "Vector field of the streaks.").required(), &FlowTexture::field);
    t.bind(schema::number("length", "world", "Length of a streak.").positive().with_default("1/25 of the plane's longer edge"),
           &FlowTexture::length);
    t.bind(schema::number("strength", "", "Contrast of the streaks.").within(0, 1), &FlowTexture::strength);
    t.bind(schema::boolean("animated", "The streaks move downstream."), &FlowTexture::is_animated);
    return t;
  }();
  return table;
}

Outcome read_flow_texture(Scene& scene, const json::Node& item, Slice& slice) {
  const json::Node* node = item.find("lic");
  if (node == nullptr) return Done{};
  CATENA_CHECK(json::expect_object(*node, "lic"));
  slice.flow_texture.emplace().where = *node;
  return flow_texture_table().read(scene, *node, *slice.flow_texture);
}

Outcome read_colors(Scene& scene, const json::Node& item, Slice& slice) {
  CATENA_TRY(ColorScale scale, read_color_scale(scene.path, item));
  slice.color_by.where = item;
  slice.color_by.colors = std::move(scale.colors);
  slice.color_by.named = std::move(scale.named);
  return Done{};
}

const Table<Slice>& slice_table() {
  static const auto table = [] {
    Table<Slice> t;
    bind_field(
        t,
        schema::reference("field", Role::any_field,
                          "Scalar field that the slice shows, or a vector field, of which it shows the magnitude.")
            .required(),
        [](auto& slice) -> auto& { return slice.color_by.field; });
    t.group(
        plane_keys(),
        [](Scene& scene, const json::Node& item, Slice& slice) {
          return read_plane(scene, item, "slice", slice.point, slice.normal, slice.widget);
        },
        [](const Scene& scene, const Slice& slice) { return plane_members(scene, slice.point, slice.normal, slice.widget); });
    t.group(schema::concatenate(color_scale_keys(), {threshold_key()}), read_colors,
            [](const Scene&, const Slice& slice) { return color_scale_members(slice.color_by.colors, slice.color_by.named); });
    t.bind(opacity_key("Opacity of the slice."), &Slice::opacity);
    t.custom(schema::object("contours", contours_table().keys(), "Contour lines, with exactly one of `levels`, `count` and `spacing`."),
             read_contours, [](const Scene& scene, const Slice& slice) {
               return slice.contours ? contours_table().write(scene, *slice.contours) : std::string();
             });
    t.custom(schema::object("lic", flow_texture_table().keys(), "Line integral convolution: streaks along the flow in the plane."),
             read_flow_texture, [](const Scene& scene, const Slice& slice) {
               return slice.flow_texture ? flow_texture_table().write(scene, *slice.flow_texture) : std::string();
             });
    t.bind(schema::boolean("shade", "Lighting as on surfaces; false: the colours of the values are shown unchanged."), &Slice::lit);
    t.bind(clip_key(), &Slice::clipped);
    t.companion(visible_key());
    return t;
  }();
  return table;
}

Outcome read_slices(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    Slice slice;
    slice.where = item;
    CATENA_CHECK(slice_table().read(scene, item, slice));
    const Entity e = scene.entities.create();
    scene.entities.emplace<Slice>(e, std::move(slice));
    return read_visible(scene, e, item);
  });
}

}  // namespace

std::string to_json(const Scene& scene, const Slice& slice) { return slice_table().write(scene, slice); }

static Part slices_part() {
  return {make_list_component("slices",
                              "Planes through a field, coloured by the field's values. A plane is given by `axis` and `at`, by `point` and "
                              "`normal`, or by `widget`.",
                              slice_table()),
          read_slices};
}

static Outcome load_slices(Scene& scene) {
  return load_visible<Slice>(scene, [&](Entity, const Slice& slice) -> Outcome {
    CATENA_CHECK(resolve_rendered_field(scene, slice.color_by.field, slice.where));
    return Done{};
  });
}

Drawable slices() { return make_drawable<Slice>(slices_part, "slices", "slice", "slices", "slice", load_slices); }

}  // namespace catena::scene
