// SPDX-License-Identifier: MIT
/// Fields of a scene that are derived from others (DerivedSource): made when something needs them. Frame thread.
#pragma once
#include <string>

#include "engine/base/result.h"
#include "engine/scene/scene.h"

namespace catena::scene {

/// Makes a derived field from its sources, which are loaded if they are not. Error: FILE:LINE and what is not possible.
Result<field::AnyField> resolve_derived(Scene& scene, Entity field);
/// Returns whether a field is derived from another one, directly or not; label surfaces are derived from their maps.
bool is_derived_from(const Scene& scene, Entity field, Entity source);
/// Drops what was made of fields whose source has changed. Returns whether there was anything.
bool drop_derived(Scene& scene);
/// Returns what a field is made of: "flow.vti:velocity", "abc", "q_criterion of v", "labels of atlas", "sqrt(u * u)".
std::string source_text(const FieldSource& source);
/// Returns the unit of a derived field's values; empty: not known.
std::string derived_unit(const Scene& scene, const DerivedSource& derived);

}  // namespace catena::scene
