/// What of the scene a link of the chain lies on. Its keys say it, whatever its type: `seed` with `field` is a streamline, `level` with
/// `surface` or `field` a level of that field, `mesh` a mesh. A new constraint that has these keys is measured along, follows and is
/// followed like the others. Pure.
#pragma once
#include <string>

#include "engine/base/json.h"

namespace catena::scene {

enum class LinkFeature { none, curve, level, mesh };

LinkFeature feature_of(const json::Node& link);
/// Which key names the field of the link's level: "surface", or else "field".
const char* level_field_key(const json::Node& link);
/// The name of that field; empty: the link lies on no level.
std::string field_of_level(const json::Node& link);

}  // namespace catena::scene
