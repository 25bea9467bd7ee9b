// SPDX-License-Identifier: MIT
/// Registry of all constraint types. A new built-in type is one file with one ConstraintType and one line in registry.cpp.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/json.h"
#include "engine/geometry/curves/point_set.h"
#include "engine/geometry/flow/curve.h"
#include "engine/geometry/mesh/mesh.h"
#include "engine/schema/key.h"
#include "haptics/chain/constraint.h"

namespace catena::haptics {

/// Path line that a link asks for.
struct PathlineSpec {
  Vec3 seed{0.0};                                ///< position at which the particle is released, world units
  std::optional<std::array<double, 2>> times{};  ///< release and end of the path; empty: all times of the field
  bool is_cubic_in_time = false;                 ///< interpolation between time steps
};

/// Scene data that a constraint may look up while it is built (off the tick). Errors name the file and line of the node `where`.
struct CATENA_EXPORT BuildContext {
  /// Returns the loaded field of that name.
  std::function<Result<field::AnyField>(const json::Node& where, const std::string& name)> field;
  /// Returns the traced curve of (field, flow, seed): the same object that is rendered.
  std::function<Result<flow::CurvePtr>(const json::Node& where, const std::string& field_name, const flow::Flow& flow, const Vec3& seed)>
      curve;
  /// Returns the path line of a particle in a field that changes with time: the same object that is rendered. Null: there are none.
  std::function<Result<flow::CurvePtr>(const json::Node& where, const std::string& field_name, const PathlineSpec& spec)> pathline;
  /// Returns the mesh of that name: the same object that is rendered.
  std::function<Result<mesh::MeshPtr>(const json::Node& where, const std::string& name)> mesh;
  /// Returns the curve set (curves from a file) of that name: the same object that is rendered.
  std::function<Result<curves::CurveSetPtr>(const json::Node& where, const std::string& name)> curves;
  /// Returns the point set (points from a table) of that name: the same object that is rendered.
  std::function<Result<curves::PointSetPtr>(const json::Node& where, const std::string& name)> points;
  double proxy_tolerance = 1e-8;  ///< fraction of L: a closest-point iteration has converged when its step is shorter
};

/// A constraint type: its name and keys in scenes, its documentation, and its factory.
struct ConstraintType {
  std::string type;   ///< value of "type" in the scene file
  std::string help;   ///< one sentence for docs/reference/scene.md
  std::string paper;  ///< equations and sections of the paper that it implements
  schema::Keys keys;  ///< keys of the type, besides common_keys()
  /// Builds the constraint of a link whose keys have been checked. Off the tick; an Error names the link's line.
  Result<std::shared_ptr<const Constraint>> (*build)(const json::Node& link, const BuildContext& context);
  bool has_own_release = false;  ///< applies its own `release` rule (unless the link has `snap`); other types are wrapped by snap.h
  bool has_axis = true;          ///< has a normal or a tangent, onto which "align" may turn the tool; false for a point
  std::string scene_section{};   ///< section of a scene whose elements a link of this type lies on, "isosurfaces"; empty: none
  std::string plugin{};  ///< file of the plug-in that registered it (haptics/plugin/plugin.h), set while it is loaded; empty: built in
};

/// Returns all types, in the order of the documentation. Any thread, provided that all types are registered.
CATENA_EXPORT const std::vector<ConstraintType>& constraint_types();
/// Returns the type of that name; null: none.
CATENA_EXPORT const ConstraintType* find_constraint_type(std::string_view type);
/// Adds a type, of a program that brings its own constraint. At start-up, before any scene is read.
CATENA_EXPORT void register_constraint(ConstraintType type);

/// Returns the keys that every link accepts: name, type, stiffness, snap, release, active_when, enabled, release_cue, align.
CATENA_EXPORT const schema::Keys& common_keys();
/// Returns the schema of the scene's "chain": all types and the mode presets (presets/mode_presets.h).
CATENA_EXPORT schema::Section chain_component();

// keys that several types have
/// Returns a required key that names a scalar field.
CATENA_EXPORT schema::Key scalar_field_key(const std::string& name);
/// Returns a required key that names a vector field.
CATENA_EXPORT schema::Key vector_field_key(const std::string& name);
/// Returns the key `level`: a value of the field, or the isolevel widget that sets it.
CATENA_EXPORT schema::Key level_key(const std::string& help);
/// Returns a key for a length >= 0, in world units, that may follow a field.
CATENA_EXPORT schema::Key length_key(const std::string& name, const std::string& help);
/// Returns the key `free`; `above` is the help text that names the side above.
CATENA_EXPORT schema::Key free_key(const std::string& above);
/// Returns the key `law` of modulated friction.
CATENA_EXPORT schema::Key law_key(const std::string& help);

/// Builds one link's constraint: looks up the type, rejects unknown keys, calls its build, wraps it where it snaps or releases. Off the
/// tick; an Error names the line in the scene.
CATENA_EXPORT Result<std::shared_ptr<const Constraint>> build_constraint(const json::Node& link, const BuildContext& context);

}  // namespace catena::haptics
