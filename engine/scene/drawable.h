// SPDX-License-Identifier: MIT
/// Registry of the kinds of drawables: the lists of the scene file whose items the image shows. A kind is one row, defined in the file of
/// its reader, and one line in drawable.cpp; a row of render/extract/drawable.h puts its items into the image. Frame thread.
#pragma once
#include <algorithm>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/scene/visibility.h"
#include "engine/schema/key.h"

namespace catena::scene {

/// A top-level key of the scene file.
struct Part {
  schema::Section description;                 ///< For "chain", "modes" and "device" the modules that read the keys describe them
  Outcome (*read)(Scene&, const json::Node&);  ///< Nullptr: read_root reads it before the others
};

/// An item of a kind, and its node in the scene file.
using DrawableItem = std::pair<Entity, const json::Node*>;

/// A kind of drawable.
struct Drawable {
  Part (*part)();                                           ///< List in the scene file
  std::string_view name;                                    ///< Key of the list: "glyphs"
  std::string_view singular, plural;                        ///< Words for messages: "set of glyphs", "sets of glyphs"
  std::string_view bar_key;                                 ///< Key by which a scalar bar names an item; empty: none
  Outcome (*load)(Scene& scene);                            ///< Loads what the visible items need; nullptr: nothing
  std::vector<DrawableItem> (*items)(const EntityStore&);   ///< All items, in the order of the list
  bool (*owns)(const EntityStore&, Entity);                 ///< Returns whether an entity is an item of this kind
  bool (*has_colors)(const EntityStore&, Entity);           ///< Returns whether an item has colors that a scalar bar can show
  Entity (*color_field)(const EntityStore&, Entity);        ///< Field whose values give the colors; none: no field
  Result<double> (*domain_length)(Scene& scene, Entity e);  ///< Length of the domain of an item, which is loaded; 0: none
};

/// Adds a kind. Call it at startup, before any scene is read.
void register_drawable(const Drawable& kind);
/// Returns all kinds, in the order in which they are read and drawn.
const std::vector<Drawable>& drawables();
/// Returns the kind of an entity; nullptr: it is no drawable.
const Drawable* find_drawable(const EntityStore& entities, Entity e);

/// Functions of a kind that follow from its component: the colors are those of "color_by", and the domain is that of the component's field.
/// Overloads define the exceptions.

template <class T>
bool shows_values(const T& item) {
  if constexpr (requires { item.color_by.has_value(); })
    return item.color_by.has_value();
  else
    return false;
}
inline bool shows_values(const Volume&) { return true; }
inline bool shows_values(const Slice&) { return true; }
inline bool shows_values(const SurfaceMesh&) { return false; }

template <class T>
Entity field_of_colors(const T& item) {
  if (!shows_values(item)) return {};
  if constexpr (requires {
                  item.color_by->field;
                  item.field;
                })
    return item.color_by->source == ColorBy::Source::field ? item.color_by->field : item.field;
  else if constexpr (requires { item.color_by->field; })
    return item.color_by->field;
  else
    return {};
}
inline Entity field_of_colors(const Volume& volume) { return volume.field; }
inline Entity field_of_colors(const Slice& slice) { return slice.color_by.field; }
inline Entity field_of_colors(const SurfaceMesh&) { return {}; }

/// Returns the length of a field's domain; 0: no field. Error: it cannot be loaded.
Result<double> field_length(Scene& scene, Entity field, const json::Node& where);

template <class T>
Result<double> length_of_domain(Scene& scene, Entity, const T& item) {
  if constexpr (requires { item.field; })
    return field_length(scene, item.field, item.where);
  else
    return 0.0;
}
Result<double> length_of_domain(Scene& scene, Entity e, const Slice& slice);
Result<double> length_of_domain(Scene& scene, Entity e, const SurfaceMesh& surface);
Result<double> length_of_domain(Scene& scene, Entity e, const CurvesSource& curves);
Result<double> length_of_domain(Scene& scene, Entity e, const PointsSource& points);

/// Makes the row of a kind whose items have the component T with its node `where`.
template <class T>
Drawable make_drawable(Part (*part)(), std::string_view name, std::string_view singular, std::string_view plural,
                       std::string_view bar_key = {}, Outcome (*load)(Scene&) = nullptr) {
  return {part,
          name,
          singular,
          plural,
          bar_key,
          load,
          [](const EntityStore& world) {
            std::vector<DrawableItem> all;
            world.each<T>([&](Entity e, const T& item) { all.emplace_back(e, &item.where); });
            return all;
          },
          [](const EntityStore& world, Entity e) { return world.has<T>(e); },
          [](const EntityStore& world, Entity e) { return shows_values(world.get<T>(e)); },
          [](const EntityStore& world, Entity e) { return field_of_colors(world.get<T>(e)); },
          [](Scene& scene, Entity e) -> Result<double> {
            const T item = scene.entities.get<T>(e);
            return length_of_domain(scene, e, item);
          }};
}

}  // namespace catena::scene
