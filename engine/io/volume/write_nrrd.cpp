// SPDX-License-Identifier: MIT
// Writes NRRD 5: a text header, a blank line, raw floats. world = space origin + sum of space directions * index. The components of
// vectors are along the world's axes, which the identity as "measurement frame" states.
#include <fmt/format.h>

#include <bit>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/base/vtk_xml_writer.h"
#include "engine/io/volume/write_box.h"

namespace catena::field {

static_assert(std::endian::native == std::endian::little, "the header declares little-endian numbers");

Outcome write_nrrd(const std::string& path, const VoxelBox& box) {
  CATENA_TRY(OutputFile out, OutputFile::open(path));
  const bool vector = box.components == 3;
  const auto words = [](const Vec3& v) { return fmt::format("({},{},{})", to_text(v.x), to_text(v.y), to_text(v.z)); };
  const Mat3& steps = box.mapping.world_from_index_linear;
  std::string header = "NRRD0005\n# complete format specification: https://teem.sourceforge.net/nrrd/format.html\n";
  header += fmt::format("content: {}\ntype: float\ndimension: {}\n", one_line(box.name), vector ? 4 : 3);
  header += box.units.is_patient_space ? "space: right-anterior-superior\n" : "space dimension: 3\n";
  header += fmt::format("sizes: {}{} {} {}\n", vector ? "3 " : "", box.size.x, box.size.y, box.size.z);
  header += fmt::format("space directions: {}{} {} {}\n", vector ? "none " : "", words(steps[0]), words(steps[1]), words(steps[2]));
  header += fmt::format("kinds: {}domain domain domain\n", vector ? "vector " : "");
  if (is_unit_name(box.units.length)) header += fmt::format("space units: \"{0}\" \"{0}\" \"{0}\"\n", box.units.length);
  header += fmt::format("endian: little\nencoding: raw\nspace origin: {}\n", words(box.mapping.origin));
  if (vector) header += "measurement frame: (1,0,0) (0,1,0) (0,0,1)\n";
  out.write(header + "\n");
  std::vector<float> values(box.layer_voxels() * static_cast<std::size_t>(box.components));
  for (int z = 0; z < box.size.z && !out.failed(); ++z) {
    box.read_values_or_nan(z, values);
    write_bytes(out, values.data(), values.size() * sizeof(float));
  }
  return out.commit();
}

}  // namespace catena::field
