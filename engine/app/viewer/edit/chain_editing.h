/// The chain as the panel shows and edits it: pure logic, no interface. Edits are JSON text for scene::Document. Frame thread.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/document.h"
#include "haptics/constraints/registry.h"

namespace catena::app {

/// An item of the scene's chain, and its links of the program (a ready-made mode has several).
struct ChainRow {
  std::size_t index = 0;
  std::string name, type;
  bool enabled = true;
  json::Node node;
  std::vector<std::size_t> links;  ///< into HapticState::links; empty: the program does not have it

  std::string pointer() const { return "/chain/" + std::to_string(index); }
  std::string pointer(std::string_view key) const { return pointer() + "/" + std::string(key); }
};

std::vector<ChainRow> make_chain_rows(const scene::Scene& scene, const std::vector<std::string>& link_names);

/// The keys of a type in the registry's order, with stiffness, snap and release; empty for an unknown type.
schema::Keys link_type_keys(std::string_view type);

/// All types of links and ready-made modes.
std::vector<std::string> link_types();

/// A link with sane keys, as JSON text: the field of a surface that is drawn, or else the first field or mesh of the scene that fits
/// (loaded if need be); the level of the surface that is drawn, or else one that the field has at the probe; places at the probe; lengths
/// as parts of `length` (that of all that is there). An error where the scene has no such field.
/// `given`: keys that are known already, with their JSON text; those that the type does not have are left out.
Result<std::string> make_link_json(scene::Scene& scene, std::string_view type, const Vec3& probe, double length,
                                   const std::vector<std::pair<std::string, std::string>>& given = {});
/// What a key that lacks begins with, JSON text; empty: nothing is known to be sane.
std::string default_key_value(scene::Scene& scene, const schema::Key& key, const json::Node& link, const Vec3& probe, double length);

/// A key that the link lacks, with what it needs beside it; empty: nothing is known to be sane.
std::vector<scene::Document::Edit> make_add_key_edits(scene::Scene& scene, const ChainRow& row, const schema::Key& key, const Vec3& probe,
                                                      double length);

/// The link's key names another field now; where the link lies on a level of it, the level is that of the surface that is drawn, or one
/// that the field has.
std::vector<scene::Document::Edit> make_change_field_edits(scene::Scene& scene, const ChainRow& row, const schema::Key& key,
                                                           const std::string& name, const Vec3& probe);

/// Pointers to the levels that go along with the link's own, so that what is felt stays what is seen: of the drawn surface that the link
/// lies on, and of the other links that lie on it. Empty where no such surface is drawn.
std::vector<std::string> find_coupled_levels(const scene::Scene& scene, const ChainRow& row);

/// Two neighbours change places, as one step. The comments within the two links go.
std::vector<scene::Document::Edit> make_swap_edits(const ChainRow& a, const ChainRow& b);

/// Names of the scene's fields of a kind (those that are not loaded count as either), and of its meshes.
std::vector<std::string> list_field_names(const scene::Scene& scene, bool vectors);
std::vector<std::string> list_mesh_names(const scene::Scene& scene);
std::vector<std::string> list_curve_names(const scene::Scene& scene);
std::vector<std::string> list_point_set_names(const scene::Scene& scene);

}  // namespace catena::app
