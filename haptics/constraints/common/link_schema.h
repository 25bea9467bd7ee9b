// SPDX-License-Identifier: MIT
/// Readers of the scene keys that several link types share: fields, levels, parameters, switches, release cues and axes. Off the tick.
#pragma once
#include "engine/base/export.h"
#include "engine/schema/key.h"
#include "haptics/chain/parameter.h"
#include "haptics/chain/program.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

/// Returns the scalar field that the link names under `key`; an Error names the key's line. `link_type` names the link type in the message
/// ("friction").
CATENA_EXPORT Result<field::ScalarFieldPtr> require_scalar_field(const json::Node& link, std::string_view key, std::string_view link_type,
                                                                 const BuildContext& context);
/// Returns the vector field that the link names under `key`; otherwise as require_scalar_field.
CATENA_EXPORT Result<field::VectorFieldPtr> require_vector_field(const json::Node& link, std::string_view key, std::string_view link_type,
                                                                 const BuildContext& context);
/// Returns the link's `level`; an Error where the field does not attain that value. `key` is the key that names the field.
CATENA_EXPORT Result<double> require_level(const json::Node& link, std::string_view key, const field::ScalarField& field);

/// Parameter values: a number, or an object {"field": NAME, "map": [[value, output], ...], "quantity": "value" | "gradient" | "magnitude",
/// "normalise": true, "outside": output}. The model is in haptics/chain/parameter.h.

/// Returns the Parameter under `key`, or `fallback` if the key is absent. An Error where an output lies outside `range`.
CATENA_EXPORT Result<Parameter> get_parameter(const json::Node& link, std::string_view key, const Parameter& fallback,
                                              json::NumberRange range, const BuildContext& context);
/// Returns the Parameter under a required `key`; an Error where it is absent or an output lies outside `range`.
CATENA_EXPORT Result<Parameter> require_parameter(const json::Node& link, std::string_view key, json::NumberRange range,
                                                  const BuildContext& context);

/// Keys that every link accepts besides those of its constraint. The structs that they fill and their models are in
/// haptics/chain/program.h.
///
/// Schema of "active_when", the link's switch.
CATENA_EXPORT schema::Key switch_key();
/// Schema of "release_cue", the release cue.
CATENA_EXPORT schema::Key release_cue_key();
/// Schema of "align", the alignment of the tool's axis.
CATENA_EXPORT schema::Key align_key();

/// Reads "active_when" of a link or a mode; without it, always on.
CATENA_EXPORT Result<ActivationSwitch> read_switch(const json::Node& holder);
/// Reads "release_cue" of a link; without it, no cue.
CATENA_EXPORT Result<ReleaseCue> read_release_cue(const json::Node& link);
/// Reads "align" of a link. An Error where the constraint has no axis: points have none, friction and forces have no primitive at all.
CATENA_EXPORT Result<Align> read_align(const json::Node& link, const Coupling& coupling, const Constraint& constraint);

}  // namespace catena::haptics
