// SPDX-License-Identifier: MIT
// Rows of grids in haptics: any voxel size, shape and position, and any magnitude of values.
#include "tests/acceptance/chain_fixture.h"
#include "tests/engine/geometry/flow/lambda_field.h"
#include "tests/limits/flow_fixture.h"
#include "tests/limits/limits_table.h"
#include "tests/limits/probe_path.h"

namespace catena::extremes {
namespace grid_haptics_limits_test {

using acceptance::ChainRig;
using acceptance::HapticProgram;
using acceptance::make_program;
using catena::LinkStatus;

constexpr const char* kLine = R"("type": "streamline", "field": "v", "follow": "selected")";
constexpr const char* kOnline = R"("type": "streamline", "field": "v", "follow": "online")";
constexpr const char* kSurface = R"("type": "isosurface", "field": "s", "level": 0.9)";

/// A link on grids with voxel edge `h` and centre `origin` (in voxels). Values depend on the node's index only, so that all grids have the
/// same floats.
std::shared_ptr<const HapticProgram> on_grids(const std::string& link, double h, const Vec3& origin) {
  constexpr int n = 33;
  const Vec3 middle(0.5 * (n - 1));
  const auto mapping = field::Mapping::from_linear(Mat3(h), h * (origin - middle));
  haptics::tests::Fields fields;
  std::vector<float> scalars, vectors;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const Vec3 p = 0.125 * (Vec3(x, y, z) - middle);
        scalars.push_back(static_cast<float>(norm(p)));
        for (const double v : {-p.y, p.x, 0.2}) vectors.push_back(static_cast<float>(v));
      }
  fields.named["s"].scalar = field::make_scalar_grid("s", mapping, {n, n, n}, scalars);
  fields.named["v"].vector = field::make_vector_grid("v", mapping, {n, n, n}, vectors);
  const Vec3 seed = h * (origin + 8.0 * Vec3(0.8, 0.1, -0.5));
  const std::string with_seed = link == kSurface ? "" : fmt::format(R"(, "seed": [{}, {}, {}])", seed.x, seed.y, seed.z);
  const auto constraint = haptics::tests::build(R"({"name": "a", )" + link + with_seed + "}", fields);
  auto program = std::make_shared<HapticProgram>(*make_program(std::vector{constraint}));
  program->meters_per_unit = 0.05 / (8 * h);
  return program;
}

struct World {
  double h;
  Vec3 origin;
};

/// Distance of the proxies on these grids from those on voxels of 0.125 at the origin, under the same hand.
std::string same_proxies(const std::vector<std::string>& links, const std::vector<World>& worlds, double bound) {
  constexpr int kTicks = 1500;
  const auto probe = [](int i) { return probe_at(i) - Vec3(0, 0, 0.5 - 1e-3 * i); };
  double off = 0;
  long long same = 0, asked = 0;
  for (const std::string& link : links) {
    ChainRig plain(on_grids(link, 0.125, Vec3(0.0)));
    std::vector<std::pair<Vec3, LinkStatus>> right;
    for (int i = 0; i < kTicks; ++i) {
      plain.step_to(probe(i));
      right.push_back({plain.proxy(), plain.status()});
    }
    for (const World& world : worlds) {
      ChainRig rig(on_grids(link, world.h, world.origin));
      for (int i = 0; i < kTicks; ++i, ++asked) {
        rig.step_to(world.h * (world.origin + 8.0 * probe(i)));
        const auto& [place, status] = right[static_cast<std::size_t>(i)];
        const double d = norm(0.125 * ((1 / world.h) * rig.proxy() - world.origin) - place) / 4;
        off = d <= off ? off : d;
        same += rig.status() == status;
      }
    }
  }
  return Findings().at_most("distance of the proxies from those at the origin", off, bound, "L").all("the same status", same, asked);
}

std::string voxels_of_any_size() {
  std::vector<World> worlds;
  for (const double h : {1e-100, 1e-30, 1e-9, 1e-3, 1e3, 1e9, 1e30, 1e100}) worlds.push_back({h, Vec3(0.0)});
  return same_proxies({kLine, kOnline, kSurface}, worlds, 1e-9);
}

const std::vector<World> kFar{
    {0.125, {1e7, 0, 0}}, {0.125, {1e7, -1e7, 1e7}}, {0.1, {1e7, 1e7, -1e7}}, {1e-9, {0, 0, 1e7}}, {1e9, {-1e7, 3e6, 0}}};

std::string voxels_a_thousand_times_as_long() {
  // s = x + z / 1000 at voxels of 1/1024, 1/1024 and 1 (ratio 1:1024), exact at every node: a plane in closed form
  const Vec3 edges(0x1p-10, 0x1p-10, 1);
  Mat3 linear(0.0);
  for (int a = 0; a < 3; ++a) linear[a][a] = edges[a];
  const auto grid = haptics::tests::sample_scalar_grid(field::Mapping::from_linear(linear, Vec3(0.0)), {33, 33, 33},
                                                       [](const Vec3& p) { return p.x * 1024 + p.z; });
  haptics::tests::Rig rig(haptics::tests::isosurface(grid, 32));
  const Vec3 normal = direction(Vec3(1024, 0, 1));
  double off = 0;
  long long ok = 0;
  constexpr int kTicks = 2000;
  for (int i = 0; i < kTicks; ++i) {
    const double u = i / double(kTicks);
    const Vec3 on(0x1p-10 * (26 - 20 * u), 0x1p-10 * (16 + 8 * std::sin(9 * u)), 6 + 20 * u),
        probe = on + (0.004 * std::sin(20 * u)) * normal;
    rig.tick(probe);
    off = std::max(off, norm(rig.state.proxy - on));
    ok += rig.state.status == LinkStatus::ok;
  }
  return Findings()
      .all("OK", ok, kTicks)
      .at_most("distance of the proxies from the closest point", off, 1e-9, "of the domain's shortest edge, 0.03");
}

/// Sampled spheres with values scaled exactly by s.
std::string values_of_any_size() {
  constexpr int n = 33;
  const auto mapping = field::Mapping::from_linear(Mat3(0.125), Vec3(-2.0));
  const auto proxies = [&](double s) {
    const auto grid = haptics::tests::sample_scalar_grid(mapping, {n, n, n}, [&](const Vec3& p) { return s * std::floor(64 * norm(p)); });
    haptics::tests::Rig rig(haptics::tests::isosurface(grid, s * 51.5));
    std::vector<Vec3> out;
    for (int i = 0; i < 1000; ++i) out.push_back(rig.tick(probe_at(i)).proxy);
    return out;
  };
  const auto plain = proxies(1);
  double off = 0;
  // 2^-149 is the smallest float: all values are denormal
  for (const double s : {0x1p-149, 0x1p-140, 0x1p-100, 0x1p100, 0x1p119}) {
    const auto scaled = proxies(s);
    for (std::size_t i = 0; i < plain.size(); ++i) off = std::max(off, norm(scaled[i] - plain[i]) / 4);
  }
  return Findings().at_most("distance of the proxies from those for values near 1", off, 1e-9, "L");
}

// ---- grids with few or no valid values ----

const double kNan = std::nan("");
const auto kVoxels = field::Mapping::from_linear(Mat3(0.25), Vec3(-2.0));
constexpr field::Index3 kSize{17, 17, 17};

bool even(const Vec3& p) { return static_cast<int>(4 * (p.x + p.y + p.z + 6) + 0.5) % 2 == 0; }

/// A hand moves, jumps and rests on the surface of a grid.
std::string on_surface(const std::function<double(const Vec3&)>& value, double level) {
  haptics::tests::Rig rig(haptics::tests::isosurface(haptics::tests::sample_scalar_grid(kVoxels, kSize, value), level));
  haptics::tests::Random random(3);
  long long bounded = 0, nothing = 0, still = 0, rests = 0, ticks = 0;
  Vec3 probe(0.1, 0.2, 0.3);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 before = rig.state.proxy;
    const LinkStatus status = rig.state.status;
    const bool rest = i % 30 > 20;
    if (!rest) probe = i % 30 == 0 ? random.box(1.8) : probe + random.box(0.01);
    rig.tick(probe);
    ++ticks;
    bounded += is_finite(rig.state.proxy) && rig.state.evaluations <= haptics::kMaxEvaluations && rig.state.work() <= haptics::kMaxWork;
    nothing += (rig.state.status == LinkStatus::no_surface || (rig.state.status == LinkStatus::budget && i > 0)) &&
               haptics::bitwise_equal(rig.state.proxy, probe);
    if (i % 30 < 28 || status == LinkStatus::budget) continue;
    ++rests;
    still += haptics::bitwise_equal(before, rig.state.proxy);
  }
  Findings found;
  found.all("finite and within the work of a tick", bounded, ticks).all("at rest under a probe at rest", still, rests);
  return found.add(nothing == ticks ? "the probe passes unchanged: NO_SURFACE, or BUDGET during the search"
                   : nothing == 0   ? "held always"
                                    : "held at times");
}

std::string lines_of(const std::function<Vec3(const Vec3&)>& value) {
  const auto grid = test::sample_vector_grid(kVoxels, kSize, value);
  const auto traced = flow::trace({grid.get()}, {0.1, 0.2, 0.3});
  haptics::tests::Rig rig = make_online_rig(grid, {0.1, 0.2, 0.3});
  rig.tick({0.3, 0.2, 0.1});
  return Findings()
      .add("traced: " + (traced ? stop_names(**traced) : traced.error().message))
      .add(fmt::format("online: {}, {}", to_string(rig.state.status), to_string(rig.state.reason)));
}

}  // namespace grid_haptics_limits_test

Group world_rows() {
  using namespace grid_haptics_limits_test;
  const std::string same = "distance of the proxies from those at the origin at most 1e-09 L; the same status in every case";
  const std::string bounded = "finite and within the work of a tick in every case; at rest under a probe at rest in every case; ";
  const std::string passes = "the probe passes unchanged: NO_SURFACE, or BUDGET during the search";
  return {
      "Fields under the probe",
      {
          {"VoxelsOfAnySize",
           "Streamlines (selected and online) and an isosurface of grids with voxels of 1e-100 to 1e100, compared with voxels of 0.125",
           same, voxels_of_any_size},
          {"SurfaceFarFromTheOrigin", "Isosurface of a grid 1e7 voxels from the origin, along one axis and along all", same,
           [] { return same_proxies({kSurface}, kFar, 1e-9); }},
          {"OnlineLineFarFromTheOrigin", "Online streamline of such a grid",
           "distance of the proxies from those at the origin at most 1e-08 L; the same status in every case",
           [] { return same_proxies({kOnline}, kFar, 1e-8); },
           "At most 1e-09 L. Every step rounds the proxy to world coordinates, and the errors add up along the line"},
          {"SelectedLineFarFromTheOrigin", "Selected streamline of such a grid", same, [] { return same_proxies({kLine}, kFar, 1e-9); }},
          {"VoxelsAThousandTimesAsLong", "Isosurface of a grid with voxel edges of 1:1:1024",
           "OK in every case; distance of the proxies from the closest point at most 1e-09 of the domain's shortest edge, 0.03",
           voxels_a_thousand_times_as_long},
          {"ValuesOfAnySize", "Isosurface of a grid with values from denormal floats (2^-149) to 2^127",
           "distance of the proxies from those for values near 1 at most 1e-09 L", values_of_any_size},
          {"OnACheckerboard", "Probe moves, jumps and rests on a checkerboard of 1 and -1, level 1/4", bounded + "held always",
           [] { return on_surface([](const Vec3& p) { return even(p) ? 1.0 : -1.0; }, 0.25); }},
          {"OnAConstant", "The same on a constant grid, at its value", bounded + passes,
           [] { return on_surface([](const Vec3&) { return 2.5; }, 2.5); }},
          {"WithoutAWholeCell", "The same on a grid with NaN in every second voxel", bounded + passes,
           [] { return on_surface([](const Vec3& p) { return even(p) ? kNan : p.x; }, 0.25); }},
          proved_elsewhere("Random NaN or infinite voxels in the grid of an isosurface", "all output is finite",
                           "IsosurfaceSemantics.InvalidVoxelsNeverReachTheOutput"),
          proved_elsewhere("Isosurface of a grid with one layer", "it is a curve", "IsosurfaceSemantics.TheSurfaceOfASliceIsACurve"),
          {"LinesOfNothing", "Streamlines of a grid of zeros",
           "traced: seed (0.1, 0.2, 0.3): field 'test' is zero at the seed, so that no line passes through it; online: CRITICAL, ZERO",
           [] { return lines_of([](const Vec3&) { return Vec3(0.0); }); }},
          {"LinesWithoutAWholeCell", "Streamlines of a grid with NaN in every second voxel",
           "traced: seed (0.1, 0.2, 0.3) is outside the domain of field 'test' (a box from (-2, -2, -2) to (2, 2, 2) without masked and "
           "non-finite cells); online: BOUNDARY, NOT_FINITE",
           [] { return lines_of([](const Vec3& p) { return even(p) ? Vec3(kNan) : Vec3(1.0); }); }},
          proved_elsewhere("Streamline of an analytic field with velocities of 1e-300 to 1e300", "the same proxies to 1e-9",
                           "FieldScaleAndBadValues.StreamlineProxiesAreInvariantUnderScalingOfTheField"),
          proved_elsewhere("Isosurface of an analytic field with values of 1e-300 to 1e300", "the same proxies to 1e-9",
                           "FieldScaleAndBadValues.SurfaceProxiesAreInvariantUnderScalingOfTheField"),
          proved_elsewhere("Sphere links with radii of 1e-300 to 1e300, and probes as far away", "the closest point, to round-off",
                           "Sphere.FarAndTinyProbesAndRadii"),
          proved_elsewhere("Meshes of any size", "the same as of size 1", "Mesh.ScaledMeshesGiveScaledProxies"),
      }};
}

}  // namespace catena::extremes
