#include "engine/scene/link_feature.h"

namespace catena::scene {

LinkFeature feature_of(const json::Node& link) {
  if (link.find("seed") != nullptr && link.find("field") != nullptr) return LinkFeature::curve;
  if (!field_of_level(link).empty()) return LinkFeature::level;
  return link.find("mesh") != nullptr ? LinkFeature::mesh : LinkFeature::none;
}

const char* level_field_key(const json::Node& link) { return link.find("surface") != nullptr ? "surface" : "field"; }

std::string field_of_level(const json::Node& link) {
  if (link.find("level") == nullptr) return {};
  const json::Node* field = link.find(level_field_key(link));
  return field != nullptr && field->kind == json::Kind::string ? field->string : std::string();
}

}  // namespace catena::scene
