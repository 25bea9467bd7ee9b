/// The list of all constraints. A new one is one file with one ConstraintType and one line in registry.cpp.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/json.h"
#include "engine/geometry/curves/point_set.h"
#include "engine/geometry/flow/curve.h"
#include "engine/geometry/mesh/mesh.h"
#include "engine/schema/key.h"
#include "haptics/chain/constraint.h"

namespace catena::haptics {

/// What a constraint may ask for while it is built (off the tick). Errors come back with the node's file and line.
struct BuildContext {
  std::function<Result<field::AnyField>(const json::Node& where, const std::string& name)> field;  ///< the field of that name, loaded
  /// The one curve object of (field, flow, seed): the same that is drawn.
  std::function<Result<flow::CurvePtr>(const json::Node& where, const std::string& field_name, const flow::Flow& flow, const Vec3& seed)>
      curve;
  /// The one mesh object of that name: the same that is drawn.
  std::function<Result<mesh::MeshPtr>(const json::Node& where, const std::string& name)> mesh;
  /// The same of curves from a file.
  std::function<Result<curves::CurveSetPtr>(const json::Node& where, const std::string& name)> curves;
  /// The same of points from a table.
  std::function<Result<curves::PointSetPtr>(const json::Node& where, const std::string& name)> points;
  double proxy_tolerance = 1e-8;  ///< of L: an iteration ends at the closest point when its step is shorter
};

/// A type of constraint, as scenes name it and documents describe it.
struct ConstraintType {
  std::string type;   ///< the word in the scene file
  std::string help;   ///< one sentence for docs/scene.md
  std::string paper;  ///< equations and sections it comes from
  schema::Keys keys;  ///< its own keys, beside common_keys()
  /// Makes the constraint of a link whose keys have been checked. Off the tick; an error names the link's line.
  Result<std::shared_ptr<const Constraint>> (*build)(const json::Node& link, const BuildContext& context);
  bool has_own_release = false;  ///< has its own rule for `release` (unless the link has `snap`); others are wrapped by snap.h
  bool has_axis = true;          ///< a normal or a tangent, which "align" may turn the tool onto; false for a place
  std::string scene_section{};   ///< the part of a scene whose items a link of this type lies on, "isosurfaces"; empty: none
  std::string plugin{};          ///< the file of the plug-in that brought it (haptics/plugin/plugin.h), as loading it sets it; empty: none
};

/// All types, in the order of the documents. Any thread once programs have added theirs.
const std::vector<ConstraintType>& constraint_types();
/// The type of that word; null: none.
const ConstraintType* find_constraint_type(std::string_view type);
/// One more type, of a program that brings its own constraint. At start-up, before anything reads a scene.
void register_constraint(ConstraintType type);

/// The keys that every link takes: name, type, stiffness, on, enabled, indicate, align, snap, release.
const schema::Keys& common_keys();
/// What the scene's "chain" may say: all types and the ready-made modes (modes.h).
schema::Section chain_component();

// keys that several types have
/// A key that names a scalar field, required.
schema::Key scalar_field_key(const std::string& name);
/// A key that names a vector field, required.
schema::Key vector_field_key(const std::string& name);
/// A value of the field, or the isolevel widget that states it.
schema::Key level_key(const std::string& help);
/// A length of zero or more, in world units, that may follow a field.
schema::Key length_key(const std::string& name, const std::string& help);
/// "free"; `above` says where that side is.
schema::Key free_key(const std::string& above);
/// "law" of modulated friction.
schema::Key law_key(const std::string& help);

/// Builds one link's constraint: looks the type up, refuses unknown keys, calls its build, wraps it where it snaps or releases.
Result<std::shared_ptr<const Constraint>> build_constraint(const json::Node& link, const BuildContext& context);

}  // namespace catena::haptics
