/// Reads a Parameter of a link: a number, or an object {"field": NAME, "map": [[value, output], ...], "of": "value" |
/// "gradient" | "magnitude", "normalise": true, "outside": output}. The model is in haptics/chain/parameter.h.
#pragma once
#include "haptics/chain/parameter.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

/// The key's value, or `fallback` where it is absent. Every output must lie in `range`.
Result<Parameter> get_parameter(const json::Node& link, std::string_view key, const Parameter& fallback, json::Range range,
                                const BuildContext& context);
Result<Parameter> require_parameter(const json::Node& link, std::string_view key, json::Range range, const BuildContext& context);

}  // namespace catena::haptics
