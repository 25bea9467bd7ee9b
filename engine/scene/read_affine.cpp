// SPDX-License-Identifier: MIT
/// Reads "transform" of a field: four rows of a matrix, or a file of ITK or FSL.
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/io/volume/transform.h"
#include "engine/scene/readers.h"

namespace catena::scene {
namespace {

Keys file_keys() {
  return {schema::file("itk",
                       "Transform file of ITK (`.tfm`, `.txt`): affine, rigid, similarity or translation. The field is the moving image."),
          schema::file("fsl", "Matrix of FSL's `flirt` (`.mat`), for which the field is the input image."),
          schema::file("reference", "Reference image of the matrix `fsl`; required with it.")};
}

Result<AffineMap> read_matrix(const json::Node& node) {
  CATENA_TRY(const auto rows, json::as_rows(node, "transform", 4));
  const std::vector<double> last{0, 0, 0, 1};
  if (rows.size() != 4 || rows[3] != last)
    return json::error_at(node, "\"transform\" has " + std::to_string(rows.size()) +
                                    " rows; four rows of four numbers, the last one [0, 0, 0, 1], were expected");
  AffineMap map;
  for (int r = 0; r < 3; ++r) {
    const std::vector<double>& row = rows[static_cast<std::size_t>(r)];
    for (int c = 0; c < 3; ++c) map.linear[c][r] = row[static_cast<std::size_t>(c)];
    map.offset[r] = row[3];
  }
  return map;
}

}  // namespace

Key transform_key() {
  return schema::any_of(
             "transform", {schema::table("", 4, "", "").with_size(4, 4), schema::object("", file_keys(), "")},
             "Affine map from the position that the file states to the one in the scene: four rows of a matrix, in world units, or "
             "a file, `{\"itk\": FILE}` or `{\"fsl\": FILE, \"reference\": IMAGE}`. Vectors are multiplied by the matrix; `crop` "
             "applies afterwards.")
      .with_default("none");
}

Outcome read_transform(const std::string& scene_path, const json::Node& node, std::optional<field::FieldTransform>& out) {
  const json::Node* given = node.find("transform");
  if (given == nullptr) return Done{};
  field::FieldTransform& transform = out.emplace();
  if (given->kind != json::Kind::object) {
    CATENA_TRY(transform.map, read_matrix(*given));
    return Done{};
  }
  CATENA_CHECK(json::check_known_keys(*given, schema::key_names(file_keys())));
  const json::Node *itk = given->find("itk"), *fsl = given->find("fsl"), *reference = given->find("reference");
  if ((itk == nullptr) == (fsl == nullptr) || (fsl == nullptr) != (reference == nullptr))
    return json::error_at(*given, "\"transform\" names no single file; \"itk\", or \"fsl\" with \"reference\", was expected");
  const std::string key = itk != nullptr ? "itk" : "fsl";
  CATENA_TRY(const std::string name, json::require_string(*given, key));
  const std::string path = resolve_path(scene_path, name);
  auto map = itk != nullptr ? field::read_itk_transform(path) : field::read_matrix_file(path);
  if (!map) return with_cause(json::error_at(*given->find(key), in_quotes(key) + ": " + map.error().message), map.error());
  transform.map = *map;
  if (reference == nullptr) return Done{};
  CATENA_TRY(const std::string image, json::require_string(*given, "reference"));
  transform.flirt_reference = resolve_path(scene_path, image);
  return Done{};
}

}  // namespace catena::scene
