/// The list of all constraints. A new one is one file with one ConstraintType and one line in registry.cpp.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/json.h"
#include "engine/flow/curve.h"
#include "engine/mesh/mesh.h"
#include "haptics/chain/constraint.h"

namespace catena::haptics {

/// What a constraint may ask for while it is built (off the tick). Errors come back with the node's file and line.
struct BuildContext {
  std::function<Result<field::AnyField>(const json::Node& where, const std::string& name)> field;
  /// The one curve object of (field, flow, seed): the same that is drawn.
  std::function<Result<flow::CurvePtr>(const json::Node& where, const std::string& field_name, const flow::Flow& flow, const Vec3& seed)>
      curve;
  /// The one mesh object of that name: the same that is drawn.
  std::function<Result<mesh::MeshPtr>(const json::Node& where, const std::string& name)> mesh;
};

struct Key {
  std::string_view name;
  /// JSON Schema: number, string, boolean, array; "parameter": a number or a map over a field; "rotation"; the name of a part of the
  /// scene: "scalar_field", "vector_field", "mesh".
  std::string_view type;
  bool required;
  std::string_view help;
  std::string_view schema = {};  ///< more JSON Schema of the value, such as a range: `"exclusiveMinimum": 0`
  bool stated = false;           ///< a new link states it though it need not: without it the link means little
};

inline constexpr std::string_view kVec3Schema = R"("items": {"type": "number"}, "minItems": 3, "maxItems": 3)";
inline constexpr std::string_view kPositiveSchema = R"("exclusiveMinimum": 0)";
inline constexpr std::string_view kNotNegativeSchema = R"("minimum": 0)";
inline constexpr std::string_view kFreeSchema = R"("enum": ["none", "above", "below"])";

struct ConstraintType {
  std::string_view type;   ///< the word in the scene file
  std::string_view paper;  ///< equations and sections it comes from
  std::vector<Key> keys;   ///< its own keys, beside common_keys()
  Result<std::shared_ptr<const Constraint>> (*build)(const json::Node& link, const BuildContext& context);
  bool releases_itself = false;  ///< has its own rule for `release` (unless the link has `snap`); others are wrapped by snap.h
};

const std::vector<ConstraintType>& registry();
const ConstraintType* find_constraint(std::string_view type);
/// The keys that every link takes: name, type, stiffness, on, enabled, indicate, align, snap, release.
const std::vector<Key>& common_keys();
/// The JSON Schema of a chain, printed from the registry and the ready-made modes (modes.h).
std::string chain_schema();

/// Builds one link's constraint: looks the type up, refuses unknown keys, calls its build, wraps it where it snaps or releases.
Result<std::shared_ptr<const Constraint>> build_constraint(const json::Node& link, const BuildContext& context);

}  // namespace catena::haptics
