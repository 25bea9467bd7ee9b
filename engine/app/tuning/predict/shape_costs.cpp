// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "engine/app/tuning/predict/cost.h"
#include "engine/base/clock.h"
#include "engine/io/curves/load_curves.h"
#include "engine/io/curves/load_points.h"
#include "engine/io/mesh/load_mesh.h"

namespace catena::app {
namespace {

/// Adds the row of a loaded shape file: its size, and the time to load the file.
template <class Shape, class Load>
Outcome add_file(const std::string& name, const Shape& shape, const std::string& work, bool measure, const Load& load, CostTable& table) {
  CostRow row{"load", name, work, {double(shape.bytes()), {}}, {}};
  const auto once = [&]() -> Result<ResourceCost> {
    const std::int64_t start = now_ns();
    CATENA_TRY(const auto again, load());
    return ResourceCost{double(again->bytes()), ms_since(start)};
  };
  CATENA_TRY(const ResourceCost first, once());
  row.expected.ms = first.ms;
  if (measure) {
    CATENA_TRY(row.measured, once());
  }
  table.push_back(std::move(row));
  return Done{};
}

/// Adds a row for the primitives of one kind that a frame renders, if there are any.
void add_shape(const char* name, std::size_t count, std::size_t parts, const char* what, std::size_t bytes, CostTable& table) {
  if (count > 0) table.push_back({"shape", name, fmt::format("{} of {} {}", count, parts, what), {double(bytes), {}}, {}});
}

}  // namespace

Outcome add_shape_costs(const scene::Scene& scene, const render::FramePacket& packet, bool measure, CostTable& table) {
  Outcome outcome = Done{};
  const auto keep = [&](const Outcome& one) {
    if (outcome) outcome = one;
  };
  scene.entities.each<scene::MeshSource>([&](scene::Entity e, const scene::MeshSource& source) {
    if (source.loaded)
      keep(add_file(
          scene.entities.get<scene::Name>(e).value, *source.loaded, fmt::format("{} triangles", source.loaded->triangles().size()), measure,
          [&] { return mesh::load_mesh(source.path, source.placement); }, table));
  });
  scene.entities.each<scene::CurvesSource>([&](scene::Entity, const scene::CurvesSource& source) {
    if (source.loaded && !source.vortex_cores)
      keep(add_file(
          source.loaded->name, *source.loaded,
          fmt::format("{} lines of {} points", source.loaded->line_count(), source.loaded->points.size()), measure,
          [&] { return curves::load_curves(source.path); }, table));
  });
  scene.entities.each<scene::PointsSource>([&](scene::Entity, const scene::PointsSource& source) {
    if (source.loaded)
      keep(add_file(
          source.loaded->name, *source.loaded, fmt::format("{} points", source.loaded->points.size()), measure,
          [&] { return curves::load_points(source.path); }, table));
  });

  std::size_t places = 0, bytes = 0;
  for (const render::TubeItem& tube : packet.tubes)
    places += tube.points.size(), bytes += tube.points.size() * sizeof(Vec3) + tube.colors.size() * sizeof(Color);
  add_shape("tubes", packet.tubes.size(), places, "points", bytes, table);
  std::size_t triangles = 0;
  bytes = 0;
  for (const render::MeshItem& mesh : packet.meshes) {
    const render::MeshGeometry& g = *mesh.geometry;
    triangles += g.triangles.size() / 3;
    bytes += (g.vertices.size() + g.normals.size()) * sizeof(Vec3) + g.triangles.size() * sizeof(std::uint32_t) +
             g.colors.size() * sizeof(Color);
  }
  add_shape("meshes", packet.meshes.size(), triangles, "triangles", bytes, table);
  std::size_t arrows = 0;
  for (const render::GlyphItem& item : packet.glyphs) arrows += item.glyphs.size();
  add_shape("glyphs", packet.glyphs.size(), arrows, "arrows", arrows * sizeof(render::Glyph), table);
  std::size_t balls = 0;
  for (const render::SpheresItem& item : packet.spheres) balls += item.spheres->offsets.size();
  add_shape("points", packet.spheres.size(), balls, "spheres", balls * (sizeof(glm::vec3) + sizeof(float) + sizeof(Color)), table);
  return outcome;
}

}  // namespace catena::app
