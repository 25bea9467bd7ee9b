#include "haptics/constraints/rules/read_field.h"

#include <fmt/format.h>

namespace catena::haptics {
namespace {

Result<field::AnyField> require_field(const json::Node& link, std::string_view key, std::string_view who, bool vector,
                                      const BuildContext& context) {
  CATENA_TRY(const std::string name, json::require_string(link, key));
  CATENA_TRY(field::AnyField field, context.field(*link.find(key), name));
  if ((field.vector != nullptr) != vector)
    return json::error_at(*link.find(key), fmt::format("field \"{}\" is a {} field; {} needs a {} field", name,
                                                       vector ? "scalar" : "vector", who, vector ? "vector" : "scalar"));
  return field;
}

}  // namespace

Result<field::ScalarFieldPtr> require_scalar_field(const json::Node& link, std::string_view key, std::string_view who,
                                                   const BuildContext& context) {
  CATENA_TRY(const field::AnyField field, require_field(link, key, who, false, context));
  return field.scalar;
}

Result<field::VectorFieldPtr> require_vector_field(const json::Node& link, std::string_view key, std::string_view who,
                                                   const BuildContext& context) {
  CATENA_TRY(const field::AnyField field, require_field(link, key, who, true, context));
  return field.vector;
}

Result<double> require_level(const json::Node& link, std::string_view key, const field::ScalarField& field) {
  CATENA_TRY(const double level, json::require_number(link, "level"));
  const double least = field.min_value(), most = field.max_value();
  if (!(level >= least && level <= most))
    return json::error_at(*link.find("level"), fmt::format("level {} is not attained by field \"{}\"; expected a value within {} .. {}",
                                                           level, link.find(key)->string, least, most));
  return level;
}

}  // namespace catena::haptics
