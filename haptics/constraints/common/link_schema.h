/// The field that a link names under a key, of the kind that it needs. `who` is the link in the message: "friction". Off the tick.
#pragma once
#include "engine/schema/key.h"
#include "haptics/chain/parameter.h"
#include "haptics/chain/program.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

/// The scalar field under `key`; an error names the key's line.
Result<field::ScalarFieldPtr> require_scalar_field(const json::Node& link, std::string_view key, std::string_view who,
                                                   const BuildContext& context);
/// The vector field under `key`; an error names the key's line.
Result<field::VectorFieldPtr> require_vector_field(const json::Node& link, std::string_view key, std::string_view who,
                                                   const BuildContext& context);
/// The link's `level`: a value that the field attains. `key` is the one that names the field.
Result<double> require_level(const json::Node& link, std::string_view key, const field::ScalarField& field);

/// Reads a Parameter of a link: a number, or an object {"field": NAME, "map": [[value, output], ...], "of": "value" |
/// "gradient" | "magnitude", "normalise": true, "outside": output}. The model is in haptics/chain/parameter.h.

/// The key's value, or `fallback` where it is absent. Every output must lie in `range`.
Result<Parameter> get_parameter(const json::Node& link, std::string_view key, const Parameter& fallback, json::NumberRange range,
                                const BuildContext& context);
/// The same of a key that must be there.
Result<Parameter> require_parameter(const json::Node& link, std::string_view key, json::NumberRange range, const BuildContext& context);

/// What every link may say beside its constraint: its switch ("on"), the cue when it is left ("indicate"), the tool's axis ("align"). The
/// structs and their models are in haptics/chain/program.h.
schema::Key switch_key();
/// "indicate".
schema::Key release_cue_key();
/// "align".
schema::Key align_key();

/// The "on" of a link or a mode; without it, always on.
Result<ActivationSwitch> read_switch(const json::Node& holder);
/// The "indicate" of a link; without it, no cue.
Result<ReleaseCue> read_release_cue(const json::Node& link);
/// The constraint is asked for an axis: a point has none, and friction and forces have no primitive at all.
Result<Align> read_align(const json::Node& link, const Coupling& coupling, const Constraint& constraint);

}  // namespace catena::haptics
