// SPDX-License-Identifier: MIT
#include "engine/io/mesh/load_mesh.h"

#include "engine/base/text.h"

namespace catena::mesh {
namespace {

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{4} << 30;

/// Registry of formats, one line each.
struct Format {
  std::string_view ending;
  Result<TriangleSoup> (*parse)(std::string_view bytes, const std::string& name);  ///< nullptr: the reader program parses it
};
constexpr Format kFormats[] = {{".stl", parse_stl}, {".obj", parse_obj}, {".ply", nullptr}, {".gii", nullptr}, {".vtp", nullptr},
                               {".vtk", nullptr},   {".vtu", nullptr},   {".vtm", nullptr}, {".pvd", nullptr}, {".series", nullptr}};

const Format* format_of(std::string_view path) {
  for (const Format& format : kFormats)
    if (has_extension(path, format.ending)) return &format;
  return nullptr;
}

/// Reads the triangles; the text is freed before the mesh is built.
Result<TriangleSoup> read_soup(const std::string& path, int step) {
  if (format_of(path)->parse == nullptr) return read_surface(path, step);
  CATENA_TRY(const std::string bytes, read_text_file(path, "a triangle mesh (" + join_alternatives(mesh_endings()) + ")", kMaxBytes));
  return format_of(path)->parse(bytes, path);
}

}  // namespace

bool is_mesh_file(std::string_view path) { return format_of(path) != nullptr; }

const std::vector<std::string_view>& mesh_endings() {
  static const std::vector<std::string_view> endings = [] {
    std::vector<std::string_view> all;
    for (const Format& format : kFormats) all.push_back(format.ending);
    return all;
  }();
  return endings;
}

Result<MeshPtr> load_mesh(const std::string& path, const MeshTransform& placement, int step) {
  const auto failed = [&](const std::string& what) { return Error{one_line(path + ": " + what)}; };
  if (!is_mesh_file(path)) return failed("has an unknown kind; a " + join_alternatives(mesh_endings()) + " file was expected");
  CATENA_TRY(TriangleSoup soup, read_soup(path, step));
  for (Vec3& v : soup.vertices) {
    v = v * placement.scale + placement.offset;
    if (!is_finite(v)) return failed("a scaled vertex is not finite; a smaller scale was expected");
  }
  return make_mesh(std::move(soup), path);
}

}  // namespace catena::mesh
