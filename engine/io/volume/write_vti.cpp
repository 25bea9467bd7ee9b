// SPDX-License-Identifier: MIT
// Writes VTK's XML image data. world = origin + direction (spacing * index): the columns of `direction` are the unit axes.
#include <fmt/format.h>

#include "engine/base/numbers.h"
#include "engine/base/vtk_xml_writer.h"
#include "engine/io/volume/write_box.h"

namespace catena::field {

Outcome write_vti(const std::string& path, const VoxelBox& box) {
  const Mat3& steps = box.mapping.world_from_index_linear;
  Vec3 spacing;
  Mat3 direction;
  for (int a = 0; a < 3; ++a) {
    spacing[a] = norm(steps[a]);
    direction[a] = steps[a] / spacing[a];
  }
  constexpr double kSquare = 1e-5;  // deviation from orthogonal axes left by single precision; such axes are written unchanged
  for (int a = 0; a < 3; ++a)
    if (std::fabs(dot(direction[a], direction[(a + 1) % 3])) > kSquare)
      return Error{path + ": the axes of the grid are sheared, and a .vti stores orthogonal axes only; .nrrd or .nii was expected"};

  CATENA_TRY(OutputFile out, OutputFile::open(path));
  const auto words = [](const Vec3& v) { return fmt::format("{} {} {}", to_text(v.x), to_text(v.y), to_text(v.z)); };
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", box.size.x - 1, box.size.y - 1, box.size.z - 1);
  const Mat3 rows = glm::transpose(direction);
  VtkXmlWriter file(out, "ImageData",
                    fmt::format("WholeExtent=\"{}\" Origin=\"{}\" Spacing=\"{}\" Direction=\"{} {} {}\"", extent, words(box.mapping.origin),
                                words(spacing), words(rows[0]), words(rows[1]), words(rows[2])),
                    fmt::format("Extent=\"{}\"", extent));
  const std::uint64_t layer = box.layer_voxels(), voxels = layer * static_cast<std::uint64_t>(box.size.z);
  const auto components = static_cast<std::size_t>(box.components);
  std::vector<AppendedArray> arrays{{"Float32", box.name, box.components, voxels * components * sizeof(float), [&](OutputFile& to) {
                                       std::vector<float> values(layer * components);
                                       for (int z = 0; z < box.size.z && !to.failed(); ++z) {
                                         box.read_values(z, values);
                                         write_bytes(to, values.data(), values.size() * sizeof(float));
                                       }
                                     }}};
  // one byte per cell; an axis with one voxel has one cell
  constexpr std::uint8_t kHiddenCell = 32;
  const auto cells_along = [](int n) { return std::max(n - 1, 1); };
  const std::uint64_t cell_count = static_cast<std::uint64_t>(cells_along(box.size.x)) *
                                   static_cast<std::uint64_t>(cells_along(box.size.y)) *
                                   static_cast<std::uint64_t>(cells_along(box.size.z));
  if (box.has_mask)
    arrays.push_back({"UInt8", "vtkGhostType", 1, voxels, [&](OutputFile& to) {
                        constexpr std::uint8_t kHiddenPoint = 2;
                        std::vector<std::uint8_t> valid(layer);
                        for (int z = 0; z < box.size.z && !to.failed(); ++z) {
                          box.read_valid(z, valid);
                          for (std::uint8_t& v : valid) v = v != 0 ? 0 : kHiddenPoint;
                          write_bytes(to, valid.data(), valid.size());
                        }
                      }});
  file.add_section("PointData", fmt::format("{}=\"{}\"", box.components == 3 ? "Vectors" : "Scalars", escape_xml(box.name)),
                   std::move(arrays));
  if (box.has_cell_mask)
    file.add_section("CellData", {}, {{"UInt8", "vtkGhostType", 1, cell_count, [&](OutputFile& to) {
                                         std::vector<std::uint8_t> cells(layer);
                                         for (int z = 0; z < cells_along(box.size.z) && !to.failed(); ++z) {
                                           box.read_cells(z, cells);
                                           for (std::uint8_t& c : cells) c = c != 0 ? 0 : kHiddenCell;
                                           for (int y = 0; y < cells_along(box.size.y); ++y)
                                             write_bytes(to, &cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(box.size.x)],
                                                         static_cast<std::size_t>(cells_along(box.size.x)));
                                         }
                                       }}});
  file.finish();
  return out.commit();
}

}  // namespace catena::field
