// SPDX-License-Identifier: MIT
/// Model of the chain panel: rows to show, and edits of the chain as JSON text for scene::Document. Independent of the GUI. Frame thread.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/document.h"
#include "haptics/constraints/registry.h"

namespace catena::app {

/// An item of the scene's chain and its links in the program (a mode preset has several).
struct ChainRow {
  std::size_t index = 0;
  std::string name, type;
  bool enabled = true;
  json::Node node;
  std::vector<std::size_t> links;  ///< Indices into HapticState::links; empty: the program does not contain the item.

  /// JSON pointer of the item, and of one of its keys.
  std::string pointer() const { return "/chain/" + std::to_string(index); }
  std::string pointer(std::string_view key) const { return pointer() + "/" + std::string(key); }
};

/// Returns one row per item of the chain. `link_names`: names of the program's links, in its order.
std::vector<ChainRow> make_chain_rows(const scene::Scene& scene, const std::vector<std::string>& link_names);

/// Returns the keys of a link type in the order of the registry, then the common numeric keys (stiffness, snap, release); empty for an
/// unknown type.
schema::Keys link_type_keys(std::string_view type);

/// Returns all link types and mode presets.
std::vector<std::string> link_types();

/// Returns a new link with working defaults as JSON text. Field: that of a visible isosurface, or else the first field or mesh of the scene
/// that fits (loaded if necessary). Level: that of the visible isosurface, or else the field's value at the probe, or the middle of its
/// range. Positions: at the probe. Lengths: fractions of `length` (the diagonal of the whole scene). `known_keys`: keys with known values
/// as JSON text; those that the type does not have are ignored. An Error if the scene has no such field.
Result<std::string> make_link_json(scene::Scene& scene, std::string_view type, const Vec3& probe, double length,
                                   const std::vector<std::pair<std::string, std::string>>& known_keys = {});
/// Returns the default value of a missing key as JSON text; empty if there is none.
std::string default_key_value(scene::Scene& scene, const schema::Key& key, const json::Node& link, const Vec3& probe, double length);

/// Returns the edits that add a missing key, together with keys that it requires; empty if there is no default.
std::vector<scene::Document::Edit> make_add_key_edits(scene::Scene& scene, const ChainRow& row, const schema::Key& key, const Vec3& probe,
                                                      double length);

/// Returns the edits that set the key to another field. If the link lies on a level of the field, the level becomes that of the visible
/// isosurface, or else one that the field has.
std::vector<scene::Document::Edit> make_change_field_edits(scene::Scene& scene, const ChainRow& row, const schema::Key& key,
                                                           const std::string& name, const Vec3& probe);

/// Returns pointers to the levels that change together with the link's own, so that the haptic surface stays the visible one: those of the
/// isosurface that the link lies on, and of the other links on it. Empty if there is no such isosurface.
std::vector<std::string> find_coupled_levels(const scene::Scene& scene, const ChainRow& row);

/// Returns the edits that swap two neighbors in one step. Comments within the two links are lost.
std::vector<scene::Document::Edit> make_swap_edits(const ChainRow& a, const ChainRow& b);

/// Return the names of the scene's fields of a kind (fields that are not loaded count as either), meshes, curves and point sets.
std::vector<std::string> list_field_names(const scene::Scene& scene, bool vectors);
std::vector<std::string> list_mesh_names(const scene::Scene& scene);
std::vector<std::string> list_curve_names(const scene::Scene& scene);
std::vector<std::string> list_point_set_names(const scene::Scene& scene);

}  // namespace catena::app
