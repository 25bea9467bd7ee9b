// SPDX-License-Identifier: MIT
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <sstream>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/io/volume/transform.h"

namespace catena::field {
namespace {

constexpr std::size_t kMaxBytes = 1 << 16;

/// Returns the numbers of a text; nullopt if a word is none.
std::optional<std::vector<double>> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto number = parse_double(word);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

/// Matrix of rows.
Mat3 matrix_of(std::span<const double> rows) {
  Mat3 m(0.0);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) m[c][r] = rows[static_cast<std::size_t>(3 * r + c)];
  return m;
}

Mat3 rotation_about(int axis, double angle) {
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  Mat3 m(1.0);
  m[a][a] = m[b][b] = std::cos(angle);
  m[a][b] = std::sin(angle);
  m[b][a] = -std::sin(angle);
  return m;
}

/// Rotation of a versor, the vector part of a unit quaternion.
std::optional<Mat3> versor_rotation(std::span<const double> v) {
  const double rest = 1 - v[0] * v[0] - v[1] * v[1] - v[2] * v[2];
  if (!(rest >= -1e-9)) return std::nullopt;
  return glm::mat3_cast(Quat(std::sqrt(std::max(rest, 0.0)), v[0], v[1], v[2]));
}

/// A transform of ITK: y = matrix (x - center) + center + translation.
struct CenteredMap {
  Mat3 matrix{1.0};
  Vec3 translation{0.0};
};

/// Returns the matrix and translation of a type of transform; nullopt for another type, or other counts of parameters.
std::optional<CenteredMap> centered_map(const std::string& type, std::span<const double> p, std::span<const double> fixed) {
  const auto vec = [&](std::size_t i) { return Vec3(p[i], p[i + 1], p[i + 2]); };
  if ((type == "AffineTransform" || type == "MatrixOffsetTransformBase") && p.size() == 12) return CenteredMap{matrix_of(p), vec(9)};
  if (type == "TranslationTransform" && p.size() == 3) return CenteredMap{Mat3(1.0), vec(0)};
  if (type == "Euler3DTransform" && p.size() == 6) {
    const Mat3 x = rotation_about(0, p[0]), y = rotation_about(1, p[1]), z = rotation_about(2, p[2]);
    const bool zyx = fixed.size() > 3 && fixed[3] != 0;
    return CenteredMap{zyx ? z * y * x : z * x * y, vec(3)};
  }
  const bool similarity = type == "Similarity3DTransform" && p.size() == 7;
  if (!similarity && !(type == "VersorRigid3DTransform" && p.size() == 6)) return std::nullopt;
  const auto rotation = versor_rotation(p.first(3));
  if (!rotation) return std::nullopt;
  return CenteredMap{similarity ? p[6] * *rotation : *rotation, vec(3)};
}

}  // namespace

Result<AffineMap> read_matrix_file(const std::string& path) {
  CATENA_TRY(const std::string text, read_text_file(path, "a matrix of 4 x 4 numbers", kMaxBytes));
  const auto n = numbers_of(text);
  if (!n || n->size() != 16 || (*n)[12] != 0 || (*n)[13] != 0 || (*n)[14] != 0 || (*n)[15] != 1)
    return Error{path + ": this is no matrix of FSL; 4 rows of 4 numbers, the last one 0 0 0 1, were expected"};
  const std::array<double, 9> rows{(*n)[0], (*n)[1], (*n)[2], (*n)[4], (*n)[5], (*n)[6], (*n)[8], (*n)[9], (*n)[10]};
  return AffineMap{matrix_of(rows), {(*n)[3], (*n)[7], (*n)[11]}};
}

Result<AffineMap> read_itk_transform(const std::string& path) {
  CATENA_TRY(const std::string text, read_text_file(path, "a transform file of ITK", kMaxBytes));
  if (!text.starts_with("#Insight Transform File"))
    return Error{path + ": this is no transform of ITK; text that begins with \"#Insight Transform File\" was expected"};
  std::map<std::string, std::string> entries;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    const std::size_t colon = line.find(':');
    if (line.starts_with('#') || colon == std::string::npos) continue;
    if (!entries.emplace(line.substr(0, colon), line.substr(colon + 1)).second)
      return Error{path + ": the file holds several transforms; a single affine one was expected"};
  }
  std::string type;
  std::istringstream(entries["Transform"]) >> type;
  const auto parameters = numbers_of(entries["Parameters"]), fixed = numbers_of(entries["FixedParameters"]);
  const std::string name = type.substr(0, type.find('_'));
  const bool is_3d = type.find("_2_2") == std::string::npos;
  const auto map = parameters && fixed && is_3d ? centered_map(name, *parameters, *fixed) : std::nullopt;
  if (!map)
    return Error{
        one_line(path + ": the transform " + in_quotes(type) +
                 " cannot be applied; an affine, rigid, similarity or translation transform in 3D with its parameters was expected")};
  Vec3 center(0.0);
  if (fixed->size() >= 3) center = {(*fixed)[0], (*fixed)[1], (*fixed)[2]};
  const AffineMap fixed_to_moving{map->matrix, center + map->translation - map->matrix * center};
  const AffineMap flip{Mat3(Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)), Vec3(0.0)};
  const AffineMap moved = flip.after(fixed_to_moving.inverse()).after(flip);
  if (!is_finite(moved.offset) || !is_finite(moved.linear[0] + moved.linear[1] + moved.linear[2]))
    return Error{path + ": the matrix cannot be inverted; a transform between two images was expected"};
  return moved;
}

}  // namespace catena::field
