// SPDX-License-Identifier: MIT
/// Examples of every constraint type, and the fields that they name, for the conformance and the endurance tests.
/// A new type needs a row in examples().
#pragma once
#include <fmt/format.h>

#include "engine/io/curves/load_points.h"
#include "tests/engine/geometry/flow/lambda_field.h"
#include "tests/haptics/constraints/mesh_fixture.h"
#include "tests/support/curve_files.h"

namespace catena::haptics::tests {

using catena::test::make_curve_set;
using catena::test::Polylines;
using catena::test::sample_vector_grid;

/// A polyline of many corners, near and far from each other.
inline std::string zigzag(int points) {
  Random random(5);
  std::string text = "\"points\": [";
  Vec3 p(0.0);
  for (int i = 0; i < points; ++i) {
    p = p * 0.99 + random.box(0.2);
    text += (i ? ", " : "") + to_json(p);
  }
  return text + "]";
}

/// Wandering lines with random starts in the box -1..1.
inline Polylines random_fibers(int lines, int points, double step) {
  Random random(17);
  Polylines all(static_cast<std::size_t>(lines));
  for (auto& line : all) {
    line.push_back(random.box(1));
    Vec3 way = direction(random.box(1));
    for (int i = 1; i < points; ++i) {
      way = direction(way + random.box(0.4) - line.back() * 0.1);
      line.push_back(line.back() + way * step);
    }
  }
  return all;
}

inline curves::PointSetPtr point_cloud(int count) {
  Random random(23);
  std::string table = "x,y,z\n";
  for (int i = 0; i < count; ++i) {
    const Vec3 p = random.box(1);
    table += fmt::format("{},{},{}\n", p.x, p.y, p.z);
  }
  auto set = curves::parse_points(table, "made.csv");
  return set ? std::make_shared<const curves::PointSet>(std::move(*set)) : nullptr;
}

/// JSON keys of the examples by type, without name and type. The fields are in fields().
inline std::map<std::string, std::vector<std::string>> examples() {
  return {
      {"point", {R"("position": [0.3, -0.2, 0.1])", R"("position": [0, 0, 0], "release": 0.4)"}},
      {"plane",
       {R"("point": [0.1, 0, 0], "normal": [1, 2, 3])", R"("point": [0.1, 0, 0], "normal": [1, 2, 3], "free": "above", "release": 0.3)",
        R"("point": [0, 0, 0], "normal": [0, 0, -1], "free": "below")", R"("point": [0, 0, 0], "normal": [0, 1, 0], "release": 0.1)"}},
      {"line",
       {R"("point": [0.1, 0, 0.2], "direction": [1, -2, 3])", R"("point": [0, 0, 0], "direction": [0, 1e-200, 0], "release": 0.3)"}},
      {"segment",
       {R"("from": [-0.5, 0.1, 0], "to": [0.7, 0.3, 0.2])", R"("from": [0, 0, 0], "to": [0.5, 0, 0], "release": 0.3)",
        R"("from": [0, 0, 0], "to": [5e-324, 0, 0])", R"("from": [-1e300, 0, 0], "to": [1e300, 1, 0])"}},
      {"polyline",
       {R"("points": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.5]])",
        R"("points": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.5]], "closed": true, "release": 0.4)",
        R"("points": [[0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 0, 0], [0.5, 0, 1e-200]], "closed": true)", zigzag(30000)}},
      {"sphere",
       {R"("center": [0.1, 0, 0], "radius": 0.8)", R"("center": [0, 0, 0], "radius": 1, "free": "above", "release": 0.2)",
        R"("center": [0, 0, 0], "radius": 1, "free": "below")", R"("center": [0, 0, 0], "radius": 0.01, "free": "above")",
        R"("center": [0, 0, 0], "radius": 0.5, "release": 0.3)"}},
      {"box",
       {R"("center": [0.1, 0, 0], "size": [1, 0.8, 0.6])",
        R"("center": [0, 0, 0], "size": [1, 1, 1], "rotation": {"axis": [1, 2, 3], "angle_deg": 40}, "free": "above", "release": 0.2)",
        R"("center": [0, 0, 0], "size": [2, 1, 1.5], "free": "below")",
        R"("center": [0, 0, 0], "size": [1, 1, 0.001], "rotation": [1, 0, 0, 0, 0.6, -0.8, 0, 0.8, 0.6], "free": "above")",
        R"("center": [0, 0, 0], "size": [1, 1, 0.5], "release": 0.1)"}},
      {"isosurface",
       {R"("field": "sphere", "level": 1)",
        R"("field": "sphere", "level": 1, "free": "above")",
        R"("field": "torus", "level": 0.4, "free": "below", "release": 0.2)",
        R"("field": "torus", "level": 0.3)",
        R"("field": "gaussian", "level": 0.5, "release": 0.3)",
        R"("field": "tanh", "level": 0.9, "free": "below")",
        R"("field": "marschner-lobb", "level": 0.5)",
        R"("field": "constant", "level": 1)",
        R"("field": "sphere_grid", "level": 1)",
        R"("field": "sphere_grid", "level": 0.05)",
        R"("field": "torus_grid", "level": 0.4, "free": "above", "release": 0.2)",
        R"("field": "boxes_grid", "level": 0.9, "free": "below")",
        R"("field": "noise_grid", "level": 0.1)",
        R"("field": "noise_grid", "level": 0.1, "free": "above", "release": 0.1)",
        R"("field": "broken_grid", "level": 0.5)",
        R"("field": "broken_grid", "level": 0.5, "free": "above")",
        R"("field": "cubic_sphere", "level": 1)",
        R"("field": "cubic_noise", "level": 0.1, "free": "above", "release": 0.1)",
        R"("field": "cubic_noise", "level": 0.1)",
        R"("field": "cubic_broken", "level": 0.5)",
        R"("field": "cubic_broken", "level": 0.5, "free": "above")"}},
      {"mesh",
       {R"("mesh": "box")", R"("mesh": "box", "free": "above")", R"("mesh": "box", "free": "below", "release": 0.2)",
        R"("mesh": "sheet", "free": "above", "release": 0.3)", R"("mesh": "sheet", "release": 0.1)", R"("mesh": "book", "free": "above")",
        R"("mesh": "book")", R"("mesh": "sphere", "free": "above")", R"("mesh": "sphere")", R"("mesh": "plate", "free": "above")",
        R"("mesh": "plate", "free": "below")"}},
      {"curves",
       {R"("curves": "fibres")", R"("curves": "fibres", "release": 0.3)", R"("curves": "fibres", "line": 7)",
        R"("curves": "fibres", "line": 120, "release": 0.2)", R"("curves": "two")"}},
      {"points", {R"("points": "cloud")", R"("points": "cloud", "release": 0.3)", R"("points": "one")"}},
      {"viscosity",
       {R"("time": 0.05)", R"("time": 0)", R"("coefficient": 2)", R"("time": {"field": "gaussian", "map": [[0, 0], [1, 1]]})"}},
      {"gradient_force",
       {R"("field": "gaussian", "displacement": 0.1, "direction": "up_gradient")",
        R"("field": "sphere", "displacement": 0.1, "direction": "down_gradient")",
        R"("field": "broken_grid", "displacement": 0.1, "direction": "up_gradient")",
        R"("field": "constant", "displacement": 0.1, "direction": "down_gradient")",
        R"("field": "sphere_grid", "displacement": {"field": "sphere_grid", "map": [[0, 0], [1, 0.2]]}, "direction": "down_gradient")"}},
      {"vortex_core",
       {R"("field": "helix")", R"("field": "rankine", "radius": 0.2)", R"("field": "lamb-oseen", "search_radius": 1)", R"("field": "hill")",
        R"("field": "saddle")", R"("field": "circle_grid", "radius": 0.1)", R"("field": "noise_vectors")",
        R"("field": "broken_circle", "radius": 0.05)"}},
      {"pathline", {R"("field": "circle", "seed": [0.5, 0, 0])", R"("field": "hill", "seed": [0.5, 0, 0], "clock": "proxy")"}},
      {"streamline",
       {R"("field": "circle", "seed": [0.5, 0, 0])", R"("field": "saddle", "seed": [0.5, 0.2, 0.1])", R"("field": "circle")",
        R"("field": "hill", "seed": [0.5, 0, 0], "follow": "online")", R"("field": "circle", "seed": [0.5, 0, 0], "method": "linear")",
        R"("field": "circle", "seed": [0.5, 0, 0], "method": "rk4")", R"("field": "circle_grid", "seed": [0.5, 0, 0])",
        R"("field": "circle_grid", "seed": [0.5, 0, 0], "follow": "online")", R"("field": "circle", "seed": [0.5, 0, 0], "release": 0.5)",
        R"("field": "cubic_circle", "seed": [0.5, 0, 0])", R"("field": "cubic_circle", "seed": [0.5, 0, 0], "follow": "online")",
        R"("field": "cubic_vectors", "follow": "online")"}},
      {"drag",
       {R"("threshold": 0.05)", R"("threshold": 0)", R"("threshold": {"field": "sphere_grid", "map": [[0, 0.01], [2, 0.2]]})",
        R"("threshold": 0.02, "surface": "sphere", "level": 1)", R"("threshold": 0.02, "surface": "broken_grid", "level": 0.5)",
        R"("threshold": 0.1, "surface": "constant", "level": 1)"}},
      {"friction",
       {R"("field": "circle", "threshold": 0.05)", R"("field": "hill")", R"("field": "saddle", "threshold": 0.3)",
        R"("field": "circle_grid", "kind": "line")", R"("field": "circle", "threshold": 0, "surface": "sphere")",
        R"("field": "hill", "surface": "sphere", "level": 1)", R"("field": "broken_vectors", "threshold": 0.1)",
        R"("field": "broken_vectors", "kind": "line", "surface": "broken_grid")",
        R"("field": "circle_grid", "surface": "noise_grid", "level": 0.1)"}},
      {"modulated_friction",
       {R"("field": "circle", "surface": "sphere", "tau_min": 0.01, "tau_max": 0.2)",
        R"("field": "saddle", "surface": "sphere", "tau_min": 0.3, "tau_max": 0.01, "law": "as_published")",
        R"("field": "hill", "surface": "torus_grid", "level": 0.4)", R"("field": "broken_vectors", "surface": "broken_grid")",
        R"("field": "broken_vectors", "kind": "line", "surface": "broken_grid", "level": 0.5)"}},
      {"texture",
       {R"("threshold": 0.05, "wavelength": 0.1)", R"("threshold": 0.05, "wavelength": 1e-12, "amplitude": 1)",
        R"("threshold": 0.02, "wavelength": 0.2, "surface": "torus", "level": 0.4)"}},
  };
}

inline const Fields& fields() {
  static const Fields all = [] {
    Fields made;
    for (const char* name : {"sphere", "torus", "gaussian", "tanh", "marschner-lobb", "constant"})
      made.named[name].scalar = analytic_field(name);
    for (const char* name : {"circle", "saddle", "hill", "helix", "rankine", "lamb-oseen"})
      made.named[name].vector = field::make_analytic(name)->vector;
    made.named["sphere_grid"].scalar = sampled_field("sphere", 25);
    made.named["torus_grid"].scalar = sampled_field("torus", 33);
    made.named["circle_grid"].vector = field::sample_on_grid(*made.named["circle"].vector, 24, -2, 2);
    const Mat3 boxes(Vec3(0.1, 0.02, 0), Vec3(-0.05, 0.25, 0), Vec3(0, 0.03, 0.4));
    made.named["boxes_grid"].scalar =
        sample_scalar_grid(field::Mapping::from_linear(boxes, Vec3(-1.2, -1.8, -2)), {30, 15, 10}, [](const Vec3& p) { return norm(p); });
    Random random(99);
    made.named["noise_grid"].scalar = cube_grid(21, [&](const Vec3&) { return random.uniform(-1, 1); });
    made.named["broken_grid"].scalar = cube_grid(21, [&](const Vec3&) {
      const double v = random.uniform(0, 1);
      return v < 0.03 ? std::numeric_limits<double>::quiet_NaN() : v < 0.04 ? std::numeric_limits<double>::infinity() : v;
    });
    std::vector<float> vectors;
    for (int i = 0; i < 3 * 21 * 21 * 21; ++i) {
      const double v = random.uniform(-1, 1);
      vectors.push_back(std::fabs(v) < 0.01 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(v));
    }
    const auto nodes = field::Mapping::from_linear(Mat3(0.2), Vec3(-2.0));
    made.named["broken_vectors"].vector = field::make_vector_grid("made", nodes, {21, 21, 21}, vectors);
    made.named["noise_vectors"].vector = sample_vector_grid(nodes, {21, 21, 21}, [&](const Vec3&) { return random.box(1); });
    made.named["broken_circle"].vector = sample_vector_grid(nodes, {21, 21, 21}, [&](const Vec3& p) {
      return random.uniform(0, 1) < 0.03 ? Vec3(std::numeric_limits<double>::quiet_NaN()) : Vec3(-p.y, p.x, 0.1);
    });
    // the same voxels in cubic cells
    for (const auto& [cubic, linear] :
         {std::pair{"cubic_sphere", "sphere_grid"}, {"cubic_noise", "noise_grid"}, {"cubic_broken", "broken_grid"}})
      made.named[cubic].scalar = made.named[linear].scalar->grid()->as_cubic().value();
    for (const auto& [cubic, linear] : {std::pair{"cubic_circle", "circle_grid"}, {"cubic_vectors", "broken_vectors"}})
      made.named[cubic].vector = made.named[linear].vector->grid()->as_cubic().value();
    made.meshes["box"] = make_mesh_from(box_soup());
    made.meshes["sheet"] = make_mesh_from(sheet_soup(12, 1, [](double x, double y) { return 0.3 * x * x - 0.4 * y; }));
    made.meshes["sphere"] = make_mesh_from(sphere_soup(12));
    made.meshes["plate"] = make_mesh_from(box_soup({-1, -1, -5e-4}, {1, 1, 5e-4}));
    // three sheets at a common edge, one of them with inverted orientation
    mesh::TriangleSoup book;
    add_quad(book, {0, -1, 0}, {1, -1, 0.2}, {1, 1, 0.2}, {0, 1, 0});
    add_quad(book, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0.2}, {-1, -1, 0.2});
    add_quad(book, {0, -1, 0}, {0, -1, 1}, {0, 1, 1}, {0, 1, 0});
    made.meshes["book"] = make_mesh_from(std::move(book));
    made.points["cloud"] = point_cloud(2000);
    made.points["one"] = point_cloud(1);
    made.curves["fibres"] = make_curve_set(random_fibers(200, 60, 0.1));
    made.curves["two"] = make_curve_set({{{-1, 0, 0}, {1, 0, 0}}, {{0, 1e-12, -1}, {0, 0, 1}}});
    return made;
  }();
  return all;
}

inline ConstraintPtr build_example(const std::string& type, const std::string& body) {
  return build(R"({"name": "a", "type": ")" + type + "\", " + body + "}", fields());
}

struct Example {
  std::string type, body;
};
inline void PrintTo(const Example& e, std::ostream* out) { *out << e.type << " {" << e.body.substr(0, 300) << "}"; }

inline std::vector<Example> all_examples() {
  std::vector<Example> out;
  const auto table = examples();
  for (const ConstraintType& type : constraint_types()) {
    const auto it = table.find(std::string(type.type));
    if (it == table.end()) continue;
    for (const std::string& body : it->second) out.push_back({it->first, body});
  }
  // each example also with the key "snap"
  for (std::size_t i = 0, n = out.size(); i < n; ++i) {
    const bool has_release = out[i].body.find("\"release\"") != std::string::npos;
    out.push_back({out[i].type, out[i].body + (has_release ? R"(, "snap": 0.05)" : R"(, "snap": 0.1, "release": 0.3)")});
  }
  return out;
}

}  // namespace catena::haptics::tests
