/// The field that a link names under a key, of the kind that it needs. `who` is the link in the message: "friction". Off the tick.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

Result<field::ScalarFieldPtr> require_scalar_field(const json::Node& link, std::string_view key, std::string_view who,
                                                   const BuildContext& context);
Result<field::VectorFieldPtr> require_vector_field(const json::Node& link, std::string_view key, std::string_view who,
                                                   const BuildContext& context);
/// The link's `level`: a value that the field attains. `key` is the one that names the field.
Result<double> require_level(const json::Node& link, std::string_view key, const field::ScalarField& field);

}  // namespace catena::haptics
