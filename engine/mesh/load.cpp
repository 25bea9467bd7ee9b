#include "engine/mesh/load.h"

#include "engine/base/text.h"

namespace catena::mesh {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{4} << 30;

bool ends_with(std::string_view path, std::string_view lower_case) {
  if (path.size() < lower_case.size()) return false;
  path.remove_prefix(path.size() - lower_case.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    const char c = path[i] >= 'A' && path[i] <= 'Z' ? static_cast<char>(path[i] - 'A' + 'a') : path[i];
    if (c != lower_case[i]) return false;
  }
  return true;
}

/// The text is gone when the mesh is made.
Result<Soup> read_soup(const std::string& path) {
  CATENA_TRY(const std::string bytes, read_text(path, "a triangle mesh (.stl or .obj)", kMostBytes));
  return ends_with(path, ".stl") ? parse_stl(bytes, path) : parse_obj(bytes, path);
}

}  // namespace

bool is_mesh_file(std::string_view path) { return ends_with(path, ".stl") || ends_with(path, ".obj"); }

Result<MeshPtr> load_mesh(const std::string& path, const Placement& placement) {
  const auto failed = [&](const std::string& what) { return Error{one_line(path + ": " + what)}; };
  if (!is_mesh_file(path)) return failed("has an unknown kind; a .stl or .obj file was expected");
  CATENA_TRY(Soup soup, read_soup(path));
  for (Vec3& v : soup.vertices) {
    v = v * placement.scale + placement.offset;
    if (!is_finite(v)) return failed("a scaled vertex is not finite; a smaller scale was expected");
  }
  return make_mesh(std::move(soup), path);
}

}  // namespace catena::mesh
