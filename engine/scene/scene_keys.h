/// Keys that several components of a scene have, and how the types of this room are read and written. Inside this room only.
#pragma once
#include "engine/scene/color_maps.h"
#include "engine/scene/read_parts.h"
#include "engine/schema/table.h"

namespace catena::scene {

using schema::Key;
using schema::Keys;
using schema::Role;
template <class T>
using Table = schema::Table<T, Scene>;

/// Binds a key that names a field to the entity of it; absent and not required: none.
template <class T, class C, class Access>
void bind_field(schema::Table<T, C>& table, const Key& key, Access access) {
  table.hand(
      key,
      [key, access](C& scene, const json::Node& object, T& out) -> Outcome {
        if (!key.is_required && object.find(key.name) == nullptr) return Done{};
        CATENA_TRY(std::invoke(access, out), read_field_name(scene, object, key.name));
        return Done{};
      },
      [access](const Scene& scene, const T& in) {
        const Entity field = std::invoke(access, in);
        return field ? schema::write_value(scene.world.get<Name>(field).value) : std::string();
      });
}

/// "clip" and "visible" of what is drawn. The second is read by read_visible (hidden.h), which knows the entity.
Key clip_key();
Key visible_key();
Key opacity_key(const std::string& help);
/// "color", "range" and "transfer" where values become colours (read_transfer.h).
Keys color_scale_keys(std::string_view map = kDefaultLineMap, const std::string& range = "that of the values");
/// Those, and a volume's opacities.
Keys transfer_keys();

/// The keys of a list's item under `name`.
template <class T>
schema::Component list_of(const std::string& name, const std::string& help, const Table<T>& table, int most = 0) {
  return {name, help, schema::Component::Shape::list, table.keys(), most};
}

}  // namespace catena::scene
