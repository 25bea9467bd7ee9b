// SPDX-License-Identifier: MIT
/// Reads "glyphs": arrows of a vector field on a slice, a plane, an isosurface or a mesh, or in a box.
#include "engine/base/text.h"
#include "engine/scene/reader_bindings.h"
#include "engine/scene/visibility.h"

namespace catena::scene {
namespace {

using On = GlyphSet::Support;

/// Keys of "on", in the order of GlyphSet::Support.
constexpr std::string_view kOn[] = {"box", "plane", "slice", "isosurface", "mesh"};

const Table<field::Box>& glyph_box_table() {
  static const auto table = [] {
    Table<field::Box> t;
    t.bind(schema::vec3("min", "world", "Minimum corner of the box.").required(), &field::Box::lo);
    t.bind(schema::vec3("max", "world", "Maximum corner of the box.").required(), &field::Box::hi);
    t.check([](Scene&, const json::Node& node, field::Box& box) -> Outcome {
      if (box.lo.x <= box.hi.x && box.lo.y <= box.hi.y && box.lo.z <= box.hi.z) return Done{};
      return json::error_at(*node.find("max"), "\"max\" lies below \"min\"; a corner above it was expected");
    });
    return t;
  }();
  return table;
}

Key on_key() {
  const auto index = [](std::string_view key, const std::string& of) {
    return schema::integer(std::string(key), "",
                           "Index, counted from 0, of the item of `" + of + "` on which the glyphs lie and which they follow.", 0, 1000000)
        .with_range_text("an index")
        .without_default();
  };
  return schema::object("on",
                        {schema::object(std::string(kOn[0]), glyph_box_table().keys(),
                                        "Box with edges along the world axes, in which the glyphs lie."),
                         schema::object(std::string(kOn[1]), plane_keys(), "Plane on which the glyphs lie."), index(kOn[2], "slices"),
                         index(kOn[3], "isosurfaces"),
                         schema::reference(std::string(kOn[4]), Role::mesh, "Name of the mesh on which the glyphs lie.")},
                        "Geometry on or in which the glyphs lie: exactly one of these keys.")
      .with_default("the domain of the field, as a box");
}

Outcome read_on(Scene& scene, const json::Node& item, GlyphSet& set) {
  const json::Node* on = item.find("on");
  if (on == nullptr) return Done{};
  CATENA_CHECK(json::expect_object(*on, "on"));
  CATENA_CHECK(json::check_known_keys(*on, std::vector<std::string_view>(std::begin(kOn), std::end(kOn))));
  if (on->members.size() != 1)
    return json::error_at(*on, "\"on\" names " + std::to_string(on->members.size()) + " things; one of " +
                                   join_words(std::vector<std::string_view>(std::begin(kOn), std::end(kOn))) + " was expected");
  const auto& [key, node] = on->members.front();
  set.support = static_cast<On>(std::find(std::begin(kOn), std::end(kOn), key) - std::begin(kOn));
  const std::string referrer = "glyphs";
  switch (set.support) {
    case On::box:
      CATENA_CHECK(json::expect_object(node, key));
      return glyph_box_table().read(scene, node, set.box.emplace());
    case On::plane:
      CATENA_CHECK(json::expect_object(node, key));
      CATENA_CHECK(json::check_known_keys(node, schema::key_names(plane_keys())));
      return read_plane(scene, node, "set of glyphs", set.point, set.normal, set.widget);
    case On::slice: {
      CATENA_TRY(set.support_entity, read_index<Slice>(scene, *on, key, "slices", referrer));
      return Done{};
    }
    case On::isosurface: {
      CATENA_TRY(set.support_entity, read_index<Isosurface>(scene, *on, key, "isosurfaces", referrer));
      return Done{};
    }
    case On::mesh: {
      CATENA_TRY(set.support_entity, read_named<MeshSource>(scene, *on, key, "mesh", "meshes"));
      return Done{};
    }
  }
  return Done{};
}

template <class T>
std::string index_of(const Scene& scene, Entity entity) {
  int index = 0, found = 0;
  scene.entities.each<T>([&](Entity e, const T&) {
    if (e == entity) found = index;
    ++index;
  });
  return schema::write_value(found);
}

std::string write_on(const Scene& scene, const GlyphSet& set) {
  const auto with = [&](const std::string& value) {
    return "{\"" + std::string(kOn[static_cast<int>(set.support)]) + "\": " + value + "}";
  };
  switch (set.support) {
    case On::box:
      return set.box ? with(glyph_box_table().write(scene, *set.box)) : std::string();
    case On::plane: {
      std::string text;
      for (const auto& [key, value] : plane_members(scene, set.point, set.normal, set.widget))
        text += (text.empty() ? "{\"" : ", \"") + key + "\": " + value;
      return with(text + "}");
    }
    case On::slice:
      return with(index_of<Slice>(scene, set.support_entity));
    case On::isosurface:
      return with(index_of<Isosurface>(scene, set.support_entity));
    case On::mesh:
      return with(schema::write_value(scene.entities.get<Name>(set.support_entity).value));
  }
  return {};
}

const Table<GlyphSet>& glyphs_table() {
  static const auto table = [] {
    Table<GlyphSet> t;
    bind_field(t, schema::reference("field", Role::vector_field, "Vector field that the glyphs show.").required(), &GlyphSet::field);
    t.custom(on_key(), read_on, write_on);
    t.bind(schema::number("spacing", "world", "Distance between neighbouring glyphs.")
               .positive()
               .with_default("1/24 of the domain's diagonal, 1/16 in a box"),
           &GlyphSet::spacing);
    t.bind(
        schema::choice("scale", {"magnitude", "constant"}, "Length of a glyph: proportional to the magnitude of the vector, or constant."),
        &GlyphSet::constant_length);
    t.bind(schema::number("length", "world", "Length of a glyph at the reference speed; with `scale` `constant`, of every glyph.")
               .positive()
               .with_default("the spacing"),
           &GlyphSet::length);
    t.bind(schema::number("reference_speed", "value", "Speed at which a glyph has the length `length`.")
               .positive()
               .with_default("the maximum speed of the glyphs"),
           &GlyphSet::reference_speed);
    t.bind(schema::number("min_speed", "value", "Speed at or below which no glyph is drawn.").non_negative(), &GlyphSet::min_speed);
    t.bind(schema::number("radius", "world", "Shaft radius of a glyph that has the length `length`.")
               .positive()
               .with_default("0.06 times `length`"),
           &GlyphSet::radius);
    t.bind(schema::choice("anchor", {"center", "tail", "head"}, "Part of a glyph that lies at its sample point."), &GlyphSet::anchor);
    t.bind(schema::line_kind_key(), &GlyphSet::is_line_field);
    t.bind(schema::color("color", "Colour of all glyphs if there is no `color_by`."), &GlyphSet::color);
    bind_color_by(t, ColorTarget::glyphs, &GlyphSet::color_by);
    t.bind(clip_key(), &GlyphSet::clipped);
    t.companion(visible_key());
    t.check([](Scene&, const json::Node& item, GlyphSet& set) -> Outcome {
      if (!set.is_line_field || set.anchor == GlyphSet::Anchor::center) return Done{};
      return json::error_at(*item.find("anchor"), "a line has neither head nor tail; \"center\" was expected with the kind \"line\"");
    });
    return t;
  }();
  return table;
}

Outcome read_glyphs(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    GlyphSet set;
    set.where = item;
    CATENA_CHECK(glyphs_table().read(scene, item, set));
    const Entity e = scene.entities.create();
    scene.entities.emplace<GlyphSet>(e, std::move(set));
    return read_visible(scene, e, item);
  });
}

}  // namespace

std::string to_json(const Scene& scene, const GlyphSet& set) { return glyphs_table().write(scene, set); }

static Part glyphs_part() {
  return {make_list_component("glyphs", "Arrows of a vector field, evenly spaced on a surface or in a box.", glyphs_table()), read_glyphs};
}

/// Loads the vector fields of the glyphs, the fields that color the glyphs, and the surfaces, visible or not, on which the glyphs lie.
static Outcome load_glyphs(Scene& scene) {
  return load_visible<GlyphSet>(scene, [&](Entity, const GlyphSet& set) -> Outcome {
    CATENA_CHECK(resolve_field(scene, set.field, set.where));
    CATENA_CHECK(load_color_field(scene, set.color_by));
    if (set.support == On::mesh) CATENA_CHECK(resolve_mesh(scene, set.support_entity));
    if (set.support == On::slice) {
      const Slice& slice = scene.entities.get<Slice>(set.support_entity);
      CATENA_CHECK(resolve_rendered_field(scene, slice.color_by.field, slice.where));
    }
    if (set.support == On::isosurface) {
      const Isosurface& surface = scene.entities.get<Isosurface>(set.support_entity);
      CATENA_CHECK(resolve_rendered_field(scene, surface.field, surface.where));
    }
    return Done{};
  });
}

Drawable glyphs() { return make_drawable<GlyphSet>(glyphs_part, "glyphs", "set of glyphs", "sets of glyphs", "glyphs", load_glyphs); }

}  // namespace catena::scene
