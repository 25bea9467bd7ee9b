/// "glyphs": arrows of a vector field on a slice, a plane, an isosurface or a mesh, or in a box.
#include "engine/base/text.h"
#include "engine/scene/hidden.h"
#include "engine/scene/read_named.h"

namespace catena::scene {
namespace {

using On = GlyphSet::On;

/// In the order of GlyphSet::On.
constexpr std::string_view kOn[] = {"box", "plane", "slice", "isosurface", "mesh"};

const Table<field::Box>& glyph_box_table() {
  static const auto table = [] {
    Table<field::Box> t;
    t.bind(schema::vec3("lo", "world", "Its lowest corner.").required(), &field::Box::lo);
    t.bind(schema::vec3("hi", "world", "Its highest corner.").required(), &field::Box::hi);
    t.check([](Scene&, const json::Node& node, field::Box& box) -> Outcome {
      if (box.lo.x <= box.hi.x && box.lo.y <= box.hi.y && box.lo.z <= box.hi.z) return Done{};
      return json::error_at(*node.find("hi"), "\"hi\" lies below \"lo\"; a corner above it was expected");
    });
    return t;
  }();
  return table;
}

Key on_key() {
  const auto index = [](std::string_view key, const std::string& of) {
    return schema::integer(std::string(key), "", "This item of `" + of + "`, counted from 0; they follow it.", 0, 1000000)
        .ranged("an index")
        .without_default();
  };
  return schema::object("on",
                        {schema::object(std::string(kOn[0]), glyph_box_table().keys(), "In a box with edges along the world's axes."),
                         schema::object(std::string(kOn[1]), plane_keys(), "On a plane of their own."), index(kOn[2], "slices"),
                         index(kOn[3], "isosurfaces"), schema::named(std::string(kOn[4]), Role::mesh, "On a mesh, by its name.")},
                        "Where they stand: one of these.")
      .by_default("in the field's domain");
}

Outcome read_on(Scene& scene, const json::Node& item, GlyphSet& set) {
  const json::Node* on = item.find("on");
  if (on == nullptr) return Done{};
  CATENA_CHECK(json::expect_object(*on, "on"));
  CATENA_CHECK(json::only_keys(*on, std::vector<std::string_view>(std::begin(kOn), std::end(kOn))));
  if (on->members.size() != 1)
    return json::error_at(*on, "\"on\" names " + std::to_string(on->members.size()) + " things; one of " +
                                   joined(std::vector<std::string_view>(std::begin(kOn), std::end(kOn))) + " was expected");
  const auto& [key, node] = on->members.front();
  set.on = static_cast<On>(std::find(std::begin(kOn), std::end(kOn), key) - std::begin(kOn));
  const std::string whose = "glyphs";
  switch (set.on) {
    case On::box:
      CATENA_CHECK(json::expect_object(node, key));
      return glyph_box_table().read(scene, node, set.box.emplace());
    case On::plane:
      CATENA_CHECK(json::expect_object(node, key));
      CATENA_CHECK(json::only_keys(node, schema::names_of(plane_keys())));
      return read_plane(scene, node, "set of glyphs", set.point, set.normal, set.widget);
    case On::slice: {
      CATENA_TRY(set.base, read_index<Slice>(scene, *on, key, "slices", whose));
      return Done{};
    }
    case On::isosurface: {
      CATENA_TRY(set.base, read_index<Isosurface>(scene, *on, key, "isosurfaces", whose));
      return Done{};
    }
    case On::mesh: {
      CATENA_TRY(set.base, read_named<MeshSource>(scene, *on, key, "mesh", "meshes"));
      return Done{};
    }
  }
  return Done{};
}

template <class T>
std::string index_of(const Scene& scene, Entity wanted) {
  int index = 0, found = 0;
  scene.world.each<T>([&](Entity e, const T&) {
    if (e == wanted) found = index;
    ++index;
  });
  return schema::write_value(found);
}

std::string write_on(const Scene& scene, const GlyphSet& set) {
  const auto with = [&](const std::string& value) { return "{\"" + std::string(kOn[static_cast<int>(set.on)]) + "\": " + value + "}"; };
  switch (set.on) {
    case On::box:
      return set.box ? with(glyph_box_table().write(scene, *set.box)) : std::string();
    case On::plane: {
      std::string text;
      for (const auto& [key, value] : plane_members(scene, set.point, set.normal, set.widget))
        text += (text.empty() ? "{\"" : ", \"") + key + "\": " + value;
      return with(text + "}");
    }
    case On::slice:
      return with(index_of<Slice>(scene, set.base));
    case On::isosurface:
      return with(index_of<Isosurface>(scene, set.base));
    case On::mesh:
      return with(schema::write_value(scene.world.get<Name>(set.base).value));
  }
  return {};
}

const Table<GlyphSet>& glyphs_table() {
  static const auto table = [] {
    Table<GlyphSet> t;
    bind_field(t, schema::named("field", Role::vector_field, "A vector field.").required(), &GlyphSet::field);
    t.hand(on_key(), read_on, write_on);
    t.bind(schema::number("spacing", "world", "Of neighbours.").positive().by_default("1/24 of the domain's diagonal, 1/16 in a box"),
           &GlyphSet::spacing);
    t.bind(schema::word("scale", {"magnitude", "constant"}, "Whether they are as long as the vectors."), &GlyphSet::constant);
    t.bind(schema::number("length", "world", "Of the longest.").positive().by_default("the spacing"), &GlyphSet::length);
    t.bind(schema::number("full_speed", "value", "The speed that is as long as that.").positive().by_default("the greatest that is drawn"),
           &GlyphSet::full_speed);
    t.bind(schema::number("min_speed", "value", "Speeds up to this have none.").not_negative(), &GlyphSet::min_speed);
    t.bind(schema::number("radius", "world", "Of the longest one's shaft.").positive().by_default("0.06 of its length"), &GlyphSet::radius);
    t.bind(schema::word("at", {"center", "tail", "head"}, "What of it lies at its place."), &GlyphSet::at);
    t.bind(schema::line_kind_key(), &GlyphSet::line);
    t.bind(schema::color("color", "Of all, without `color_by`."), &GlyphSet::color);
    bind_color_by(t, ColorSubjects::glyphs, &GlyphSet::color_by);
    t.bind(clip_key(), &GlyphSet::clipped);
    t.beside(visible_key());
    t.check([](Scene&, const json::Node& item, GlyphSet& set) -> Outcome {
      if (!set.line || set.at == GlyphSet::At::center) return Done{};
      return json::error_at(*item.find("at"), "a line has neither head nor tail; \"center\" was expected beside the kind \"line\"");
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
    const Entity e = scene.world.create();
    scene.world.emplace<GlyphSet>(e, std::move(set));
    return read_visible(scene, e, item);
  });
}

}  // namespace

std::string text_of(const Scene& scene, const GlyphSet& set) { return glyphs_table().write(scene, set); }

Part glyphs_part() {
  return {list_of("glyphs", "Arrows of a vector field, evenly placed on a surface or in a box.", glyphs_table()), read_glyphs};
}

}  // namespace catena::scene
