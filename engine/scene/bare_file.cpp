#include <algorithm>

#include "engine/base/text.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/scene.h"
#include "engine/scene/transfer.h"

namespace catena::scene {
namespace {

constexpr int kLattice = 5;           // seeds an axis
constexpr double kSlowShare = 0.05;   // of the fastest seed: not worth a line
constexpr double kLengthShare = 2.0;  // of L, in each direction
constexpr double kDrawnTolerance = 1e-7;
constexpr Rgb kLineColor{0.96f, 0.66f, 0.26f};

/// The grid asked for; else the only one; else the first scalar one, else the first vector one.
Result<field::AnyField> load_best(field::LoadRequest& request) {
  auto loaded = field::load(request);
  if (loaded || !request.grid.empty()) return loaded;
  const auto grids = field::describe(request.path);
  if (!grids) return loaded.error();
  const field::GridInfo* best = nullptr;
  for (const field::GridInfo& grid : *grids)
    if (grid.usable && grid.stats.active_voxels > 0 && (best == nullptr || (best->is_vector && !grid.is_vector))) best = &grid;
  if (best == nullptr) return loaded.error();
  request.grid = best->name;
  return field::load(request);
}

/// Points of a lattice inside the domain where the flow is not slow.
std::vector<Vec3> lattice_seeds(const field::VectorField& field) {
  struct Candidate {
    Vec3 p;
    double speed;
  };
  std::vector<Candidate> candidates;
  double fastest = 0;
  field::Cursor cursor;
  const field::Box& box = field.index_box();
  for (int k = 0; k < kLattice; ++k)
    for (int j = 0; j < kLattice; ++j)
      for (int i = 0; i < kLattice; ++i) {
        const Vec3 share = Vec3(i + 0.5, j + 0.5, k + 0.5) / static_cast<double>(kLattice);
        const Vec3 p = field.mapping().world_from_index(box.lo + share * (box.hi - box.lo));
        const field::VectorSample sample = field.sample(p, cursor);
        const double speed = norm(sample.value);
        if (!sample.inside || !(speed > 0) || !std::isfinite(speed)) continue;
        candidates.push_back({p, speed});
        fastest = std::max(fastest, speed);
      }
  std::vector<Vec3> seeds;
  for (const Candidate& c : candidates)
    if (c.speed >= kSlowShare * fastest) seeds.push_back(c.p);
  return seeds;
}

Result<Scene> scene_for_mesh(const std::string& path) {
  CATENA_TRY(mesh::MeshPtr mesh, mesh::load_mesh(path));
  Scene scene;
  scene.path = path;
  scene.cursor = scene.world.create();
  scene.world.emplace<Cursor>(scene.cursor);
  MeshSource source;
  source.path = path;
  source.loaded = std::move(mesh);
  source.where.file = std::make_shared<const std::string>(path);
  SurfaceMesh surface;
  surface.mesh = scene.world.create();
  surface.where = source.where;
  scene.world.emplace<Name>(surface.mesh, {"mesh"});
  scene.world.emplace<MeshSource>(surface.mesh, std::move(source));
  scene.world.emplace<SurfaceMesh>(scene.world.create(), std::move(surface));
  return scene;
}

}  // namespace

Result<Scene> scene_for_file(const std::string& path, const std::string& grid, const NamedColors& colors) {
  const bool colored = !colors.map.empty() || colors.range;
  if (mesh::is_mesh_file(path)) {
    if (colored) return Error{one_line(path + ": a mesh has no values to colour; a colour map goes with a data file")};
    return scene_for_mesh(path);
  }
  if (path.ends_with(".raw"))
    return Error{one_line(path + ": a .raw file does not say its shape; a scene file that states it was expected")};
  field::LoadRequest request;
  request.path = path;
  request.grid = grid;
  CATENA_TRY(const field::AnyField loaded, load_best(request));

  Scene scene;
  scene.path = path;
  scene.cursor = scene.world.create();
  scene.world.emplace<Cursor>(scene.cursor);
  const Entity field = scene.world.create();
  scene.world.emplace<Name>(field, {grid.empty() ? loaded.get()->name() : grid});
  FieldSource source;
  source.file = request;
  source.loaded = source.drawn = loaded;
  source.where.file = std::make_shared<const std::string>(path);
  const json::Node where = source.where;
  scene.world.emplace<FieldSource>(field, std::move(source));

  const Entity drawn = scene.world.create();
  if (loaded.scalar) {
    Volume volume;
    volume.field = field;
    volume.where = where;
    volume.shade = true;
    volume.transfer.named.range = colors.range;
    complete_transfer(volume.transfer, *loaded.scalar->grid());
    if (!colors.map.empty())
      volume.transfer.colors = named_map(colors.map, volume.transfer.colors.front().value, volume.transfer.colors.back().value);
    scene.world.emplace<Volume>(drawn, std::move(volume));
    return scene;
  }
  StreamlineSet set;
  set.field = field;
  set.where = where;
  set.seeds.points = lattice_seeds(*loaded.vector);
  set.color = kLineColor;
  if (colored) {
    set.color_by.emplace();
    set.color_by->named = colors;
  }
  set.length = kLengthShare * loaded.vector->length();
  set.tolerance = kDrawnTolerance;
  if (!set.seeds.points.empty()) scene.world.emplace<StreamlineSet>(drawn, std::move(set));
  return scene;
}

}  // namespace catena::scene
