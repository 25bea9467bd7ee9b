// SPDX-License-Identifier: MIT
#include "engine/io/mesh/load_mesh.h"

#include "engine/base/text.h"
#include "engine/io/formats.h"

namespace catena::mesh {

Result<MeshPtr> load_mesh(const std::string& path, const MeshTransform& placement, int step) {
  const auto failed = [&](const std::string& what) { return Error{one_line(path + ": " + what)}; };
  const io::Format* format = io::find_reader(path, io::DataKind::mesh);
  if (format == nullptr) return failed("has an unknown file type; " + io::describe_expected(io::DataKind::mesh) + " was expected");
  CATENA_TRY(TriangleSoup soup, format->read_mesh(path, step));
  for (Vec3& v : soup.vertices) {
    v = v * placement.scale + placement.offset;
    if (!is_finite(v)) return failed("a scaled vertex is not finite; a smaller scale was expected");
  }
  return make_mesh(std::move(soup), path);
}

}  // namespace catena::mesh
